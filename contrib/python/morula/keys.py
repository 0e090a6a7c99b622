# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The keys that a program knows, from what `morula --parameters` prints."""
import re
from dataclasses import dataclass

from .execute import call

# Former path of a key -> its path today, e.g. "Grid/Mesh size": "Grid/Spacing".
# No key has been renamed yet. The program must know the former name, too, by
# ParameterHandler::declare_alias where the key is declared (both names in one
# subsection): the test programs/keys.py compares.
RENAMES = {}


@dataclass(frozen=True)
class Key:
    """path: full, separated by '/'. allowed: a noun phrase, or empty for
    expressions and texts. former: paths that it had. paper: its default
    with Method = paper, or None where that is the same."""

    path: str
    default: str
    unit: str
    allowed: str
    meaning: str
    former: tuple
    paper: str = None


def parse_keys(text):
    """All keys of the output of `morula --parameters`, in order."""
    keys, sections, comment, former, paper = [], [], [], [], None
    mark = "# With Method = paper:"
    for line in map(str.strip, text.splitlines()):
        if line.startswith("# Formerly: "):
            former.append(line[len("# Formerly: "):])
        elif line.startswith(mark):
            paper = line[len(mark):].strip()
        elif line.startswith("#"):
            comment.append(line[1:].strip())
        elif line.startswith("subsection "):
            sections.append(line[len("subsection "):])
        elif line == "end":
            sections.pop()
        elif line.startswith("set "):
            name, _, default = line[len("set "):].partition("=")
            match = re.fullmatch(
                r"(?s)(.*?)(?: Units: ([^.]*)\.)?(?: Allowed: (.*)\.)?",
                " ".join(comment))
            keys.append(Key("/".join([*sections, name.strip()]),
                            default.strip(), match[2] or "", match[3] or "",
                            match[1], tuple(former), paper))
            comment, former, paper = [], [], None
    return keys


def defaults_with(keys, method):
    """Path -> default of the keys for a value of the key Method."""
    return {key.path: key.paper if method == "paper"
            and key.paper is not None else key.default for key in keys}


def keys_of(morula):
    """The keys of an executable."""
    return parse_keys(call([morula, "--parameters"]).stdout)
