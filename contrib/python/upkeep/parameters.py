# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Writes doc/parameters.md, the table of all keys, from `morula --parameters`.

    contrib/parameters            writes it
    contrib/parameters --check    exit code 1 if it is not up to date
"""
import argparse
import re
import sys
from pathlib import Path

from morula.keys import keys_of

ROOT = Path(__file__).resolve().parents[3]
PAGE = ROOT / "doc/parameters.md"

HEAD = """# Keys of a scene

Every key of a `.prm` file. This page is written by `contrib/parameters` from
`build/morula --parameters`, which prints the same as a scene to start from. In a
file, each part of a path but the last is a `subsection`; on the command line it is
`-s "Grid/Spacing=50"`. [theory.md](theory.md) says what the symbols mean,
[glossary.md](glossary.md) the words.

`Method` decides the defaults of the keys that have two here; whatever the scene itself
sets wins, and `--explain` says what each of them is in the end.

Expressions are muParser's: functions of X, Y, Z (initial position, um) and, where the
meaning says so, t (day); components are separated by `;`. *um* is µm. Keys of cells
have [more variables](glossary.md#variables-of-expressions): of the present cell.
"""

# Sections that exist only where the scene names types.
OF_TYPES = """
Each name is a section `Cell types/NAME` with these keys. `--parameters` does not show them, as
they exist only where a scene names types.

| key in `Cell types/NAME` | default | unit | meaning |
| --- | --- | --- | --- |
| `Where` | (empty) | — | Founders for which this expression of X, Y, Z is > 0 are of this type; of several types the last one counts, and the first type is that of all others. |
| `Daughter types` | (empty) | — | Types of the two daughters, separated by a comma, the one at -n_s first; empty: the mother's. |
| `Transitions/To OTHER` | `0` | 1/day | Rate at which cells of this type become OTHER, another of the names: an expression of their state, not negative. |
| `Growth/Law` | (empty) | — | `none`, or the law of all; empty: that of all. |
| `Proliferation/Law` | (empty) | — | `none`, or `cell cycle`; empty: as all. Cells that are past the onset of S divide, and then wait. |
| any key of cells, by its path, e.g. `Material/Young's modulus` or `Proliferation/Cell cycle/Duration` | (empty) | of that key | Its value for cells of this type; empty: as for all. Keys of cells are those that are evaluated for a cell again and again ([list](glossary.md#variables-of-expressions)). |
"""

# Sections that exist only where the scene names fields.
OF_FIELDS = """
Each name is a section `Fields/NAME` with these keys. `--parameters` does not show them, as they
exist only where a scene names fields.

| key in `Fields/NAME` | default | unit | meaning |
| --- | --- | --- | --- |
| `Time` | `steady` | — | `steady`: in each configuration the field has its steady state. `transient`: it changes with time. |
| `Diffusion` | (none) | um^2/day | Diffusion coefficient D, an expression of the cells' state; > 0. |
| `Production` | `0` | of the field, 1/day | What a cell makes of it per time and volume, an expression of the cell's state; not negative. |
| `Consumption` | `0` | 1/day | Rate k at which a cell uses it up, k times the field, an expression of the cell's state, which may read the field itself: `4e6/(0.5 + NAME)` saturates; not negative. |
| `Initial` | `0` | of the field | The field at t = 0, at which a steady field is sought first; not negative. An expression of X, Y, Z. |
| `Fixed where` | (empty) | — | At boundary points at which this expression of X, Y, Z is > 0 the field has Value; empty: nowhere. |
| `Value` | `0` | of the field | The field at the fixed boundary points, and outside of the others if there is a Transfer; not negative. An expression of X, Y, Z, t. |
| `Transfer` | (empty) | um/day | At boundary points that are not fixed -D dc/dn = Transfer (c - Value); not negative; empty: nothing passes there. An expression of X, Y, Z, t. |
| `Dilution` | `true` | — | Whether a transient field becomes less where cells grow, so that its amount stays. |
"""

# Sections that exist only where the scene names obstacles.
OF_OBSTACLES = """
Each name is a section `Obstacles/NAME` with these keys. `--parameters` does not show them, as
they exist only where a scene names obstacles.

| key in `Obstacles/NAME` | default | unit | meaning |
| --- | --- | --- | --- |
| `Shape` | (none) | — | `plane`, `sphere` (2-D: a disc), `cylinder` (3-D, without ends) or `box` (edges along the axes). |
| `Side` | `outside` | — | `outside`: the tissue is outside of the body, in front of the plane; `inside`: inside, as in a mould. |
| `Center` | `0, 0, 0` | um | Center of the body, or a point of the plane, at t = 0. |
| `Radius` | `0` | um | Of a sphere or cylinder; > 0. |
| `Normal` | (empty) | — | Of a plane; it points to the tissue if Side = outside. |
| `Size` | (empty) | um | Full edge lengths of a box. |
| `Axis` | (empty) | — | Of a cylinder. |
| `Stiffness` | `100` | E/h | Pressure on the tissue over its depth in the obstacle; > 0. E is that of the stiffest cell. |
| `Velocity` | `0; 0; 0` | um/day | Velocity of the obstacle: functions of t separated by ';'. |
"""


def cell(text):
    """Text that may stand in a table."""
    return text.replace("|", "\\|").replace("<", "&lt;")


def allowed(key):
    if key.allowed:
        return cell(key.allowed)
    is_expression = re.search("xpression(?!s of cells)|functions? of",
                              key.meaning)
    # Numbers say what is allowed.
    is_number = re.fullmatch(r"[\d.e-]+", key.default)
    return "an expression" if is_expression or is_number else "any text"


def page(keys):
    lines, section = [HEAD], None
    for key in keys:
        place = key.path.rpartition("/")[0]
        if place != section:
            section = place
            lines.append(f"\n## {section or 'Outside all subsections'}\n\n"
                         "| key | default | unit | allowed | meaning |\n"
                         "| --- | --- | --- | --- | --- |\n")
        default = f"`{key.default}`" if key.default else "(empty)"
        if key.consistent is not None:
            default += f"; `Method = consistent`: `{key.consistent}`"
        former = "".join(f" Formerly `{path}`." for path in key.former)
        lines.append(f"| `{key.path}` | {cell(default)} | {key.unit or '—'} | "
                     f"{allowed(key)} | {cell(key.meaning)}{former} |\n")
        if key.path == "Cell types/Names":
            lines.append(OF_TYPES)
        if key.path == "Fields/Names":
            lines.append(OF_FIELDS)
        if key.path == "Obstacles/Names":
            lines.append(OF_OBSTACLES)
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
    text = page(keys_of(options.morula.resolve()))
    if options.check:
        if not PAGE.is_file() or PAGE.read_text() != text:
            sys.exit("doc/parameters.md is not up to date: call "
                     "contrib/parameters, and commit it.")
        return
    PAGE.write_text(text)
    print("written:", PAGE.relative_to(ROOT))
