# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Writes the tables of doc/parameters.md from `morula --parameters=json`. What
stands above its first section stays.

    contrib/upkeep/parameters            writes them
    contrib/upkeep/parameters --check    exit code 1 if they are not up to date
"""
import re
import tempfile
from pathlib import Path

from morula.program import Program
from morula.tables import markdown

from . import ROOT, parser

PAGE = ROOT / "doc/parameters.md"

# Sections that exist where a scene names something, each with one name.
SCENE = "".join(f"subsection {section}\n  set Names = {names}\nend\n" for section, names
                in (("Cell types", "NAME, OTHER"), ("Fields", "name"), ("Cell numbers", "number"),
                    ("Obstacles", "name"), ("Lumens", "name")))

# Keys that a type of cells has because all cells have them.
OF_TYPE = "For cells of this type; empty: the value of the general key"


def allowed(key):
    if key.allowed:
        return key.allowed.replace("gradient of name", "gradient of NAME")
    is_expression = re.search("xpression(?!s of cells)|functions? of", key.meaning)
    # Numbers say what is allowed.
    is_number = re.fullmatch(r"[\d.e-]+", key.default)
    return "an expression" if is_expression or is_number else "any text"


def row(path, key):
    default = f"`{key.default}`" if key.default else "(empty)"
    if key.paper is not None:
        default += f"; `Method = paper`: `{key.paper}`"
    former = "".join(f" Formerly `{path}`." for path in key.former)
    return [f"`{path}`", default, key.unit or "—", allowed(key), key.meaning + former]


def sections(keys):
    rows = {}
    for key in keys:
        if not key.path.startswith("Cell types/OTHER/") and not (key.meaning.startswith(OF_TYPE)):
            path = re.sub("/(name|number)/", "/NAME/", key.path)
            rows.setdefault(path.rpartition("/")[0], []).append(row(path, key))
    header = ["key", "default", "unit", "allowed", "meaning"]
    return "".join(f"\n## {section or 'Outside all subsections'}\n\n{markdown(header, table)}\n"
                   for section, table in rows.items()).replace("<", "&lt;")


def main():
    tool = parser(__doc__)
    tool.add_argument("--check", action="store_true", help="write nothing")
    tool.add_argument("--morula", default=ROOT / "build/morula", help="the executable")
    options = tool.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        scene = Path(scratch) / "scene.prm"
        scene.write_text(SCENE)
        tables = sections(Program(options.morula).keys_with(scene))
    before = PAGE.read_text(encoding="utf-8")
    text = before.partition("\n## ")[0] + tables
    if options.check:
        return (0 if text == before else "doc/parameters.md is not up to date: call "
                "contrib/upkeep/parameters, and commit it.")
    PAGE.write_text(text, encoding="utf-8")
