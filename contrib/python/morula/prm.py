# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Parameter files as text: key by key, not judged."""
from pathlib import Path

MAX_INCLUDES = 20


def parse(text, folder=Path("."), sections=(), depth=0):
    """The keys of a .prm text by full path ("Grid/Spacing"), later ones over
    earlier ones, files that it includes in their place. Whether a line is
    right is the program's business; here, wrong ones are left out."""
    keys, sections = {}, list(sections)
    for line in logical_lines(text):
        word, _, rest = line.partition(" ")
        word, rest = word.lower(), rest.strip()
        if word == "subsection":
            sections.append(rest)
        elif word == "end" and sections:
            sections.pop()
        elif word == "set" and "=" in rest:
            name, value = rest.split("=", 1)
            keys["/".join([*sections, name.strip()])] = value.strip()
        elif word == "include" and depth < MAX_INCLUDES:
            file = Path(rest) if Path(rest).exists() else folder / rest
            if file.is_file():
                keys.update(parse(file.read_text(), file.parent, sections, depth + 1))
    return keys


def logical_lines(text):
    """Lines joined where one ends with a backslash, without comments."""
    joined = text.replace("\\\n", "").replace("\t", " ")
    for line in joined.splitlines():
        line = line.split("#")[0].strip()
        if line:
            yield line
