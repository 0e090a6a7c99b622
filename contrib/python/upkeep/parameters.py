# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Writes doc/parameters.md, the table of all keys, from `morula --parameters`.

    contrib/upkeep/parameters            writes it
    contrib/upkeep/parameters --check    exit code 1 if it is not up to date
"""
import argparse
import re
import sys
import tempfile
from pathlib import Path

from morula.program import Program

ROOT = Path(__file__).resolve().parents[3]
PAGE = ROOT / "doc/parameters.md"

HEAD = """# Keys of a scene

Every key of a `.prm` file. This page is written by `contrib/upkeep/parameters` from
`build/morula --parameters`, which prints the same as a scene to start from. In a
file, each part of a path but the last is a `subsection`; on the command line it is
`-s "Grid/Spacing=50"`. [theory.md](theory.md) says what the symbols mean,
[glossary.md](glossary.md) the words.

A section with NAME in its path exists for each name in the key `Names` of the section around it, and
`build/morula SCENE.prm --parameters` prints those of a scene. In `Cell types/NAME` stands besides, by its path, any key
of cells ([list](glossary.md#variables-of-expressions)), such as `Cell types/NAME/Material/Young's modulus`: its value
for cells of this type; empty: as for all.

`Method` decides the defaults of the keys that have two here; whatever the scene itself
sets wins, and `--explain` says what each of them is in the end.

Expressions are muParser's: functions of X, Y, Z (initial position, um) and, where the
meaning says so, t (day); components are separated by `;`. *um* is µm. Keys of cells
have [more variables](glossary.md#variables-of-expressions): of the present cell.
"""

# Sections that exist where a scene names something, each with one name.
SCENE = """
subsection Cell types
  set Names = NAME, OTHER
end
subsection Fields
  set Names = name
end
subsection Obstacles
  set Names = name
end
"""

# What a key says that a type of cells has because all cells have it.
OF_TYPE = "For cells of this type; empty: as for all"


def cell(text):
    """Text that may stand in a table."""
    return text.replace("|", "\\|").replace("<", "&lt;")


def allowed(key):
    if key.allowed:
        return cell(key.allowed.replace("gradient of name", "gradient of NAME"))
    is_expression = re.search("xpression(?!s of cells)|functions? of",
                              key.meaning)
    # Numbers say what is allowed.
    is_number = re.fullmatch(r"[\d.e-]+", key.default)
    return "an expression" if is_expression or is_number else "any text"


def page(keys):
    lines, section = [HEAD], None
    for key in keys:
        if (key.path.startswith("Cell types/OTHER/")
                or key.meaning.startswith(OF_TYPE)):
            continue
        path = key.path.replace("/name/", "/NAME/")
        place = path.rpartition("/")[0]
        if place != section:
            section = place
            lines.append(f"\n## {section or 'Outside all subsections'}\n\n"
                         "| key | default | unit | allowed | meaning |\n"
                         "| --- | --- | --- | --- | --- |\n")
        default = f"`{key.default}`" if key.default else "(empty)"
        if key.paper is not None:
            default += f"; `Method = paper`: `{key.paper}`"
        former = "".join(f" Formerly `{path}`." for path in key.former)
        lines.append(f"| `{path}` | {cell(default)} | {key.unit or '—'} | "
                     f"{allowed(key)} | {cell(key.meaning)}{former} |\n")
    return "".join(lines)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--check", action="store_true", help="write nothing")
    parser.add_argument("--morula", type=Path, default=ROOT / "build/morula",
                        help="the executable")
    options = parser.parse_args()
    if not options.morula.is_file():
        parser.error(f"{options.morula} is missing; contrib/build makes it")
    with tempfile.TemporaryDirectory() as scratch:
        scene = Path(scratch) / "scene.prm"
        scene.write_text(SCENE)
        text = page(Program(options.morula).keys_with(scene))
    if options.check:
        if not PAGE.is_file() or PAGE.read_text() != text:
            sys.exit("doc/parameters.md is not up to date: call "
                     "contrib/upkeep/parameters, and commit it.")
        return
    PAGE.write_text(text)
    print("written:", PAGE.relative_to(ROOT))
