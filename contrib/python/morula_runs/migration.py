# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Scenes with former names of keys, rewritten."""
import re

WORD = re.compile(r"(\s*)(set|subsection|end)\b\s*([^#]*)", re.IGNORECASE)


def statements(text):
    """Each statement with all its lines, where one ends with a backslash."""
    lines = []
    for line in text.splitlines(keepends=True):
        lines.append(line)
        if not line.split("#")[0].rstrip().endswith("\\"):
            yield "".join(lines)
            lines = []
    if lines:
        yield "".join(lines)


def block(path, value):
    """A key in its subsections, as lines."""
    *sections, name = path.split("/")
    lines = [f"{'  ' * i}subsection {section}"
             for i, section in enumerate(sections)]
    lines.append(f"{'  ' * len(sections)}set {name} = {value}")
    lines += [f"{'  ' * i}end" for i in reversed(range(len(sections)))]
    return "".join(line + "\n" for line in lines)


def migrate(text, renames):
    """(the text with today's names, pairs of former path and path).

    Comments and layout stay. A key that has moved to another subsection is
    taken out of its place and put at the end. Included files are not followed.
    """
    done, kept, moved, sections = [], [], [], []
    for statement in statements(text):
        match = WORD.match(statement)
        word = match[2].lower() if match else ""
        if word == "subsection":
            sections.append(match[3].strip())
        elif word == "end" and sections:
            sections.pop()
        elif word == "set" and "=" in match[3]:
            name, value = (part.strip() for part in match[3].split("=", 1))
            former = "/".join([*sections, name])
            path = renames.get(former, former)
            if path != former:
                done.append((former, path))
                *places, today = path.split("/")
                if places != sections:
                    moved.append(block(path, value))
                    continue
                begin = statement.index(name, match.start(3))
                statement = (statement[:begin] + today
                             + statement[begin + len(name):])
        kept.append(statement)
    if moved and kept and not kept[-1].endswith("\n"):
        kept[-1] += "\n"
    return "".join(kept + moved), done
