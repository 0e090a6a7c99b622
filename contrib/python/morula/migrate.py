# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Rewrites scenes that use former names of keys.

    contrib/migrate SCENE.prm...           rewrites the files
    contrib/migrate --check SCENE.prm...   only says what it would do; exit
                                           code 1 if there is anything

Comments and layout stay. Included files are scenes of their own: name them, too.
"""
import argparse
import re
import sys
from pathlib import Path

from .files import write
from .keys import RENAMES

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


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("scenes", nargs="+", type=Path, metavar="SCENE.prm")
    parser.add_argument("--check", action="store_true",
                        help="change nothing")
    options = parser.parse_args()
    n_changes = 0
    for scene in options.scenes:
        try:
            text, done = migrate(scene.read_text(), RENAMES)
            if done and not options.check:
                write(scene, text)
        except (OSError, UnicodeDecodeError) as error:
            sys.exit(f"migrate: {scene}: {error}")
        for former, path in done:
            print(f"{scene}: {former} -> {path}")
        n_changes += len(done)
    if not n_changes:
        print("No key has a former name.")
    return 1 if options.check and n_changes else 0
