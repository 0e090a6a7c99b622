# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tables of trackers: a row a cell and time."""
import csv
import re

import numpy as np
from scipy import spatial

from morula.refusal import Refused

from .read import IN_UM, chosen
from .volumes import clipped_volumes, volumes_within

# Names that trackers give to a column, in small letters, '_' for blanks; the first that is there
# counts.
AXIS = "{0} position_{0} pos_{0} centroid_{0} {0}_um {0}_px location_center_{0} center_{0}"
NAMES = {name: known.split() for name, known in {
    **{axis: AXIS.format(axis) for axis in "xyz"},
    "frame": "frame t time timepoint time_point position_t time_index imagenumber",
    "id": "id label track_id trackid cell_id spot_id objectnumber",
    "volume": "volume volume_um3 area_um3 areashape_volume area_3d area area_um2 areashape_area",
    "radius": "radius radius_um",
    "diameter": "diameter equivalent_diameter equivalent_diameter_area estimated_diameter "
                "areashape_equivalentdiameter",
    "type": "type class cell_type", "generation": "generation", "phase": "phase",
    "unit": "unit"}.items()}
TEXTS = ("id", "type", "generation", "phase", "unit", "frame")  # taken as they are
OVERLAP = 1e-3  # cells nearer to each other than so many lengths are one
FEW = 8  # cells, of which no hull has regions


def read_table(file, frame, voxel, surface, words):
    """A data frame with x, y and perhaps z (um), volume (um^dim), and id, type, generation and
    phase where the table has them. Names may have any case and a unit behind them, entries may be
    separated by semicolons, tabs or blanks, and numbers may be those of Fortran or have decimal
    commas. Throws Refused."""
    table = as_text(file)
    names = names_of(table)
    if "x" not in names or "y" not in names:
        raise Refused("The table", file, "columns x and y in um",
                      "It has " + ", ".join(map(str, table)) + ".")
    units = {name: _without_unit(column)[1] for name, column in names.items()}
    table = table[list(names.values())].set_axis(list(names), axis=1)
    numbers = [name for name in table if name not in TEXTS]
    written = table
    table = table.assign(**{name: _as_numbers(table[name]) for name in numbers})
    _leave_out(file, written, table[numbers].isna(), units, words)
    table = table[table[numbers].notna().all(axis=1)]
    if "unit" in table:  # of Imaris, beside the places
        units |= {axis: table["unit"].iloc[0].lower() for axis in "xyz" if axis in table}
    table = _of_frame(file, table, frame, words).reset_index(drop=True)
    axes = [axis for axis in "xyz" if axis in table]
    if len(axes) == 3 and table["z"].nunique() == 1:
        axes.remove("z")
        table = table.drop(columns="z")
        words.append("All z are the same: the tissue is two-dimensional.")
    for name in [name for name in numbers if name in table]:
        factor = _factor(file, names[name], name, units[name], voxel, len(axes))
        if factor is None:
            words.append(f"{names[name]} is no volume and is not used.")
            table = table.drop(columns=name)
        else:
            table[name] *= factor
    if voxel is None and not any(units.values()):
        words.append("Its lengths are taken for um, as no column has a unit; --voxel scales those "
                     "in pixels.")
    return _with_volumes(file, table, axes, surface, words)


def as_text(file):
    """The entries as text, in any encoding and with any separator; the index is the line's number,
    the columns are those of the first line that names places, behind a preamble."""
    import pandas
    content = file.read_bytes()
    wide = content.startswith((b"\xff\xfe", b"\xfe\xff")) or content[1:2] == b"\0"
    for encoding in ("utf-16" if wide else "utf-8-sig", "latin-1"):
        try:
            text = content.decode(encoding)
            break
        except UnicodeDecodeError:
            pass
    # spreadsheets fill rows up to the width of the sheet
    lines = [(number, line.rstrip(" \t,;")) for number, line in enumerate(text.splitlines(), 1)
             if line.strip(' \t",;')]
    known = {name for names in NAMES.values() for name in names} | {"centroid_0", "axis_0"}
    head, split, first = max(((line, one, number) for number, line in lines[:50] for one
                              in (",", ";", "\t", " ")), default=("", ",", 0),
                             key=lambda row: len(known & {_without_unit(name)[0] for name
                                                          in _split(row[0].lstrip("# "), row[1])}))
    head = _split(head.lstrip("# "), split)
    rows = {number: _split(line.partition("#")[0], split) for number, line in lines
            if number > first and line.partition("#")[0].strip()}
    if "\0" in text or not rows:
        raise Refused("The table", file, "a text with a line of names and a line a cell",
                      "It is no text." if "\0" in text else "It has no rows below its names."
                      if lines else "It is empty.")
    for number, row in rows.items():
        if len(row) > len(head):
            raise Refused("The table", file, "as many entries in a row as names",
                          f"Line {number} has {len(row)} for {len(head)}: are commas both "
                          "separators and decimal signs? Separate by semicolons.")
    table = pandas.DataFrame([row + [""] * (len(head) - len(row)) for row in rows.values()],
                             index=list(rows), columns=head)
    return table.loc[:, ~table.columns.duplicated()]


def _split(line, separator):
    return line.split() if separator == " " else [entry.strip() for entry in next(
        csv.reader([line], delimiter=separator, skipinitialspace=True))]


def _without_unit(column):
    """The name of a column in small letters, and the unit in brackets or behind '_'."""
    plain = str(column).strip().strip('"').lower()
    name, unit = (re.fullmatch(r"(.*?)\s*[(\[](.*)[)\]]", plain) or re.fullmatch(
        r"(.*_(um[23]?|px))", plain) or re.fullmatch("(.*)()", plain, re.S)).groups()
    return re.sub(r"[\s.-]+", "_", name), unit


def names_of(table):
    """Which column has what. Arrays have the axes z, y, x: centroid-0 is y in 2-D."""
    plain = {_without_unit(column)[0]: column for column in reversed(list(table))}
    for kind in ("centroid_", "axis_"):  # of arrays, numbered
        of_array = [plain[name] for name in sorted(plain) if re.fullmatch(kind + "[012]", name)]
        plain = {**dict(zip("xyz", reversed(of_array))), **plain}
    return {name: plain[next(one for one in known if one in plain)]
            for name, known in NAMES.items() if any(one in plain for one in known)}


def _factor(file, column, name, unit, voxel, dim):
    """What a column's numbers are multiplied by to be in um (um^dim); None: they are no volumes."""
    power = dim if name == "volume" else 1
    length, exponent = re.fullmatch(r"(.*?)\^?([23²³]?)", unit).groups()
    exponent = {"": 1, "2": 2, "²": 2}.get(exponent, 3)
    if length in IN_UM and (name == "volume" or exponent == 1):
        return IN_UM[length] ** exponent if exponent >= power else None
    if voxel is not None and len(voxel) < dim:
        raise Refused("--voxel", "", "three numbers, as the table has x, y, z")
    if voxel is not None:
        x, y, z = [*voxel[::-1], 1.0][:3]
        edges = {"x": x, "y": y, "z": z, "volume": x * y * (z if dim == 3 else 1)}
        return edges.get(name, np.sqrt(x * y))  # radii are measured in the plane
    if unit == "":
        return 1.0
    raise Refused("The table", file, "coordinates in um, volumes in um^3 "
                  "(2-D: um^2)", f"Its column {column} is in {unit}: convert "
                  "it, or give the size of a voxel (--voxel X,Y,Z).")


def _as_numbers(column):
    """Not finite, or no number: NaN. Of '.' and ',' in one number the last is the decimal sign."""
    import pandas
    text = column.str.replace("[dD]", "e", regex=True)
    both = text.str.contains(r"\..*,|,.*\.", regex=True)
    text = text.mask(both & (text.str.rfind(",") > text.str.rfind(".")), text.str.replace(
        ".", "", regex=False)).mask(both & (text.str.rfind(",") < text.str.rfind(".")),
                                    text.str.replace(",", "", regex=False))
    numbers = pandas.to_numeric(text.str.replace(",", ".", regex=False), errors="coerce")
    return numbers.where(np.isfinite(numbers))


def _leave_out(file, written, missing, units, words):
    """Says why rows are left out; lines of units, of which no entry is a number, are read."""
    whole = missing.all(axis=1)
    for name in missing:
        for entry in written.loc[whole, name]:
            units[name] = _without_unit(entry)[1] or units[name]
    if whole.any():
        words.append(f"{whole.sum()} lines hold no numbers, such as further lines of names: they "
                     "are left out.")
    partly = missing.any(axis=1) & ~whole
    about = ""
    if partly.any():
        line = partly.idxmax()
        name = missing.loc[line].idxmax()
        about = (f"{partly.sum()} rows lack a number, such as line {line}, whose {name} is "
                 f"'{written.loc[line, name]}'")
        words.append(about + ": they are left out.")
    if missing.any(axis=1).all():
        raise Refused("The table", file, "a row of numbers for each cell", about and about + ".")


def _of_frame(file, table, frame, words):
    if "frame" not in table:
        return table
    numbers = _as_numbers(table["frame"])
    times = table["frame"] if numbers.isna().any() else numbers
    frames = np.unique(times)
    time = (frame if frame in list(frames)  # a number of the table's own
            else frames[chosen("--frame", frame, len(frames))])
    words.append(f"Of {len(frames)} times it is that of {time}.")
    return table[times == time].drop(columns="frame")


def _with_volumes(file, table, axes, surface, words):
    if len(table) < 2:
        raise Refused("The table", file, "at least 2 cells", f"It has {len(table)}.")
    places, dim = table[axes].to_numpy(), len(axes)
    nearest = spatial.cKDTree(places).query(places, 2)[0][:, 1]
    length = float(np.median(nearest))
    double = nearest < OVERLAP * length if length > 0 else nearest >= 0
    if double.any():
        raise Refused("The table", file, "one cell at each place", f"{double.sum()} rows have the "
                      "place of another one: is it one of several times without a column frame?")
    if "volume" not in table and ("radius" in table or "diameter" in table):
        radius = table["radius"] if "radius" in table else 0.5 * table["diameter"]
        table["volume"] = np.pi * (4 / 3 if dim == 3 else 1) * radius ** dim
        words.append("Volumes are those of balls with the radii of the table; cells side by side "
                     "fill more.")
    elif "volume" not in table and surface:
        table["volume"] = volumes_within(places, surface)
        words.append("The table has no volumes: cells get those of their Voronoi regions within "
                     f"the surface, together {table['volume'].sum():.5g} um^{dim}.")
    elif "volume" not in table and len(table) < FEW:
        table["volume"] = length ** dim
        words.append("The table has no volumes: all cells get that of a cube with the median "
                     f"distance to the nearest cell, {length:.4g} um.")
    elif "volume" not in table:
        table["volume"], far = clipped_volumes(places)
        words.append("The table has no volumes: cells get those of their Voronoi regions, cut off "
                     f"{far:.3g} um outside of the outer places, together "
                     f"{table['volume'].sum():.5g} um^{dim}.")
    if not (table["volume"] > 0).all():
        raise Refused("The table", file, "volumes > 0", f"It has {table['volume'].min():g}.")
    return table
