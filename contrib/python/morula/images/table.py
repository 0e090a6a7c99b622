# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tables of trackers: a row a cell and time."""
import numpy as np
from scipy import spatial

from morula.refusal import Refused

# Names that trackers give to a column, in small letters.
NAMES = {"x": ("x", "position_x", "pos_x", "position x", "centroid_x",
               "centroid-2", "x_um"),
         "y": ("y", "position_y", "pos_y", "position y", "centroid_y",
               "centroid-1", "y_um"),
         "z": ("z", "position_z", "pos_z", "position z", "centroid_z",
               "centroid-0", "z_um"),
         "frame": ("frame", "t", "time", "timepoint", "time_point", "position_t",
                   "time index"),
         "id": ("id", "label", "track_id", "trackid", "cell_id", "spot id"),
         "volume": ("volume", "area_um3", "volume_um3"),
         "radius": ("radius", "radius_um"), "diameter": ("diameter",),
         "type": ("type", "class", "cell_type")}
OVERLAP = 1e-3  # cells nearer to each other than so many lengths are one


def read_table(file, frame, voxel, words):
    """A data frame with x, y and perhaps z (um), volume (um^dim), and id, type
    where the table has them. Throws Refused."""
    import pandas
    try:
        table = pandas.read_csv(file, sep=None, engine="python", comment="#")
    except (OSError, ValueError) as error:
        raise Refused("The table", file, "a CSV file with a line of names", f"{error}.") from None
    names = {}
    for column in table:
        for name, known in NAMES.items():
            if str(column).strip().lower() in known and name not in names:
                names[name] = column
    if "x" not in names or "y" not in names:
        raise Refused("The table", file, "columns x and y in um",
                      "It has " + ", ".join(map(str, table)) + ".")
    table = table[list(names.values())].set_axis(list(names), axis=1)
    numbers = [name for name in table if name not in ("id", "type")]
    table[numbers] = table[numbers].apply(pandas.to_numeric, errors="coerce")
    wrong = table[numbers].isna().any(axis=1)
    if wrong.any():
        words.append(f"{wrong.sum()} lines hold no numbers, such as further "
                     "lines of names: they are left out.")
        table = table[~wrong]
    table = _of_frame(file, table, frame, words)
    return _with_volumes(file, table.reset_index(drop=True), voxel, words)


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
        raise Refused("The table", file, "one cell at each place",
                      f"{double.sum()} rows have the place of another one: is "
                      "it a table of several times without a column frame?")
    ball = np.pi * (4 / 3 if dim == 3 else 1)
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
