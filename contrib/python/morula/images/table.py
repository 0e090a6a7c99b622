# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tables of trackers: a row a cell and time."""
import io
import re
import warnings

import numpy as np
from scipy import spatial

from morula.refusal import Refused

from .read import IN_UM

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


def read_table(file, frame, voxel, words):
    """A data frame with x, y and perhaps z (um), volume (um^dim), and id, type,
    generation and phase where the table has them. Names may have any case and
    a unit behind them, entries may be separated by semicolons, tabs or blanks,
    and numbers may be those of Fortran or have decimal commas. Throws Refused."""
    table = _as_text(file)
    names, factors = {}, {}
    for column in table:
        plain, unit = _without_unit(column)
        for name, known in NAMES.items():
            if plain in known and name not in names:
                names[name] = column
                factors[name] = _factor(file, column, name, unit, voxel)
    if "x" not in names or "y" not in names:
        raise Refused("The table", file, "columns x and y in um",
                      "It has " + ", ".join(map(str, table)) + ".")
    table = table[list(names.values())].set_axis(list(names), axis=1)
    numbers = [name for name in table if name not in TEXTS]
    written = table
    table = table.assign(**{name: _as_numbers(table[name])
                            for name in numbers})
    wrong = table[numbers].isna().any(axis=1)
    if wrong.any():
        for name in numbers:  # units may stand in a line of their own
            for entry in written.loc[wrong, name].dropna():
                factors[name] *= _factor(file, names[name], name,
                                         _without_unit(entry)[1], voxel)
        words.append(f"{wrong.sum()} lines hold no numbers, such as further "
                     "lines of names: they are left out.")
        table = table[~wrong]
    for name in numbers:
        table[name] *= factors[name]
    table = _of_frame(file, table, frame, words)
    return _with_volumes(file, table.reset_index(drop=True), voxel, words)


def _as_text(file):
    """The table with its entries as text, in any encoding and with any
    separator."""
    import pandas
    try:
        content = file.read_bytes()
        if content.startswith((b"\xff\xfe", b"\xfe\xff")):
            text = content.decode("utf-16")
        else:
            try:
                text = content.decode("utf-8-sig")
            except UnicodeDecodeError:
                text = content.decode("latin-1")
        # spreadsheets fill rows up to the width of the sheet
        lines = [line.rstrip(" \t,;") for line in text.splitlines()
                 if line.strip(' \t",;')
                 and not line.lstrip().startswith("#")
                 and not line.lower().startswith("sep=")]
        known = {name for names in NAMES.values() for name in names}
        separator = max((",", ";", "\t", r"\s+"), key=lambda one: len(
            known & {_without_unit(name)[0]
                     for name in re.split(one, (lines or [""])[0].strip())}))
        with warnings.catch_warnings():
            # a row with more entries than names, as decimal commas make it
            warnings.simplefilter("error", pandas.errors.ParserWarning)
            table = pandas.read_csv(
                io.StringIO("\n".join(lines)), sep=separator, engine="python",
                dtype=str, index_col=False, skipinitialspace=True, comment="#")
        return table.apply(lambda column: column.str.strip())
    except (OSError, ValueError, pandas.errors.ParserWarning) as error:
        raise Refused("The table", file, "a CSV file with a line of names",
                      f"{error}.") from None


def _without_unit(column):
    """The name of a column in small letters, and the unit in brackets."""
    plain = str(column).strip().strip('"').lower()
    found = re.fullmatch(r"(.*?)\s*[(\[](.*)[)\]]", plain)
    return found.groups() if found else (plain, "")


def _factor(file, column, name, unit, voxel):
    """What a column's numbers are multiplied by to be in um (um^3, um^2)."""
    if unit == "" or name in ("frame", *TEXTS):
        return 1.0
    length, power = re.fullmatch(r"(.*?)\^?([23²³]?)", unit).groups()
    if length in IN_UM and (power != "") == (name == "volume"):
        return IN_UM[length] ** {"": 1, "2": 2, "²": 2}.get(power, 3)
    if voxel is not None and name in "xyz":
        return 1.0
    raise Refused("The table", file, "coordinates in um, volumes in um^3 "
                  "(2-D: um^2)", f"Its column {column} is in {unit}: convert "
                  "it, or give the size of a voxel (--voxel X,Y,Z).")


def _as_numbers(column):
    """Not finite, or no number: NaN."""
    import pandas
    text = column.str.replace("[dD]", "e", regex=True)
    if not text.str.contains(".", regex=False).any():
        text = text.str.replace(",", ".", regex=False)
    numbers = pandas.to_numeric(text, errors="coerce")
    return numbers.where(np.isfinite(numbers))


def _of_frame(file, table, frame, words):
    if "frame" not in table:
        return table
    frames = np.unique(table["frame"])
    if frame is None and len(frames) > 1:
        raise Refused("--frame", "", f"a number from 0 to {len(frames) - 1}",
                      f"The table has {len(frames)} times: say which one.")
    if not 0 <= (frame or 0) < len(frames):
        raise Refused("--frame", frame, f"a number from 0 to {len(frames) - 1}")
    words.append(f"Of {len(frames)} times it is that of {frames[frame or 0]:g}.")
    return table[table["frame"] == frames[frame or 0]].drop(columns="frame")


def _with_volumes(file, table, voxel, words):
    axes = [axis for axis in "xyz" if axis in table]
    if len(axes) == 3 and table["z"].nunique() == 1:
        axes.remove("z")
        table = table.drop(columns="z")
        words.append("All z are the same: the tissue is two-dimensional.")
    if voxel is not None:
        table[axes] *= voxel[::-1][:len(axes)]
    if len(table) < 2:
        raise Refused("The table", file, "at least 2 cells", f"It has {len(table)}.")
    places, dim = table[axes].to_numpy(), len(axes)
    nearest = spatial.cKDTree(places).query(places, 2)[0][:, 1]
    length = float(np.median(nearest))
    double = nearest < OVERLAP * length if length > 0 else nearest >= 0
    if double.any():
        raise Refused("The table", file, "one cell at each place", f"{double.sum()} rows have the "
                      "place of another one: is it one of several times without a column frame?")
    if "volume" in table:
        pass
    elif "radius" in table or "diameter" in table:
        radius = (table["radius"] if "radius" in table else 0.5 * table["diameter"])
        table["volume"] = ball * radius ** dim
        words.append("Volumes are those of balls with the radii of the table; "
                     "cells side by side fill more.")
    else:
        table["volume"] = length ** dim
        words.append("The table has no volumes: all cells get that of a cube with the median "
                     f"distance to the nearest cell, {length:.4g} um.")
    if not (table["volume"] > 0).all():
        raise Refused("The table", file, "volumes > 0")
    return table
