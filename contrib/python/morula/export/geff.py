# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tracks as GEFF, the graph exchange file format of trackers: a directory in the
format of Zarr 2, after version 1.0 of its specification
(liveimagetrackingtools.org/geff).

    from morula.export import geff
    lineage = geff.read_lineage("tracks.geff")
"""
import shutil
import tempfile
from pathlib import Path

import numpy as np

from morula.refusal import Refused

from .tracks import Property, Tracks, lineage_of

VERSION = "1.0"
UNITS = {"um": "micrometer", "kPa": "kilopascal", "um^3": "micrometer^3", "um^2": "micrometer^2"}


def write(tracks, file):
    """Writes Tracks as a directory, which takes the place of one from before.
    Throws Refused if something else is there."""
    import zarr
    file = Path(file)
    if file.exists() and not _is_geff(file):
        raise Refused("The file", file, "a new name, or that of tracks from "
                      "before", "Something else is there.")
    with tempfile.TemporaryDirectory(dir=file.parent, prefix=f".{file.name}.") as scratch:
        aside = Path(scratch) / "graph"
        # zarr 3 writes its own version unless told not to, zarr 2 knows no other
        version = ({} if zarr.__version__.startswith("2.") else {"zarr_format": 2})
        root = zarr.open_group(str(aside), mode="w", **version)
        nodes, edges = root.create_group("nodes"), root.create_group("edges")
        nodes["ids"] = np.arange(len(tracks), dtype=np.uint64)
        edges["ids"] = tracks.edges.astype(np.uint64)
        edges.create_group("props")
        there = nodes.create_group("props")
        for name, prop in tracks.properties.items():
            group = there.create_group(name)
            group["values"] = prop.values
            if prop.missing is not None:
                group["missing"] = prop.missing
        root.attrs["geff"] = about(tracks)
        if file.exists():
            shutil.rmtree(file)
        aside.rename(file)


def _is_geff(file):
    marks = file / ".zattrs"
    return marks.is_file() and '"geff"' in marks.read_text(encoding="utf-8")


def about(tracks):
    """What the file says of itself."""
    space = "zyx"[3 - tracks.dimension:]
    found = {
        "geff_version": VERSION, "directed": True,
        "axes": [_axis("t", "time", "day", tracks),
                 *(_axis(name, "space", "micrometer", tracks)
                   for name in space)],
        "node_props_metadata": {
            name: _property(name, prop)
            for name, prop in tracks.properties.items()},
        "edge_props_metadata": {},
        "track_node_props": {"lineage": "lineage",
                             **({"tracklet": "cell"} if tracks.divides_in_two
                                else {})},
        "display_hints": {"display_horizontal": "x", "display_vertical": "y",
                          "display_time": "t",
                          **({"display_depth": "z"} if "z" in space else {})},
        "extra": {"morula": {"types": list(tracks.type_names),
                             "dimension": tracks.dimension, **tracks.words}}}
    if "radius" in tracks.properties:
        found["sphere"] = "radius"
    return found


def _axis(name, kind, unit, tracks):
    values = tracks.properties[name].values
    return {"name": name, "type": kind, "unit": unit,
            "min": float(values.min()), "max": float(values.max())}


def _property(name, prop):
    found = {"identifier": name, "dtype": prop.values.dtype.name, "varlength": False}
    if prop.unit:
        found["unit"] = UNITS.get(prop.unit, prop.unit)
    if prop.meaning:
        found["description"] = prop.meaning
    return found


def read(file):
    """Tracks that were written by this module. Throws Refused for others."""
    import zarr
    if not _is_geff(Path(file)):
        raise Refused("The file", file, "tracks as GEFF, in Zarr 2", "morula export writes them.")
    root = zarr.open_group(str(file), mode="r")
    said = root.attrs["geff"]
    ours = said.get("extra", {}).get("morula")
    if ours is None:
        raise Refused("The file", file, "tracks of morula export", "Those of other programs have "
                      "no lineage with exact times.")
    properties = {}
    for name, known in said["node_props_metadata"].items():
        group = root[f"nodes/props/{name}"]
        properties[name] = Property(group["values"][:], known.get("unit", ""),
                                    known.get("description", ""), group["missing"][:] if "missing"
                                    in group else None)
    return Tracks(ours["dimension"], root["edges/ids"][:].astype(np.int64), properties,
                  tuple(ours["types"]), {"run": ours["run"]})


def read_lineage(file):
    """The Lineage of such a file."""
    return lineage_of(read(file))
