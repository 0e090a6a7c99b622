# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The command contrib/import."""
from pathlib import Path

import numpy as np

from morula.command_line import output_directory, run_tool
from morula.files import write
from morula.refusal import Refused

from .options import parser, voxel_of
from .writing import prm, write_cells, write_off, write_wkt

MOST_BALLS = 40  # around a lumen


def main(words=None):
    """Exit code 0, or 1 for what makes no sense."""
    def tool():
        options = parser().parse_args(words)
        if not options.file.is_file():
            raise Refused("The file", options.file, "a label image or a table "
                          "that can be read", "Correct its name.")
        directory = output_directory(options, Path(options.file.stem .partition(".")[0]))
        if (directory / "scene.prm").exists() and not options.again:
            raise Refused("--output", directory, "a directory without a scene.prm",
                          "Choose another one, or replace that one with --again.")
        make_scene(options, directory)
        return 0
    return run_tool("import", tool)


def make_scene(options, directory):
    """Reads, judges, writes, and says what it found."""
    from .read import IMAGES
    found = (scene_of_image if options.file.suffix.lower() in IMAGES
             else scene_of_table)(options, directory)
    for line in found:
        print(f"import: {line}")
    write(directory / "report.txt", "".join(f"{line}\n" for line in found))


def scene_of_image(options, directory):
    from .labels import cells_of, whole
    from .read import read_image
    from .surface import surface_of, tissue_of
    image = read_image(options.file, options.channel, options.frame)
    words = image.words
    labels, names = whole(image, options.file)
    voxel = voxel_of(options.voxel, image.voxel, labels.ndim)
    words.append("A voxel is " + " x ".join(f"{edge:.6g}" for edge
                                            in voxel[::-1]) + " um (x, y, z).")
    cells = cells_of(labels, names, voxel, options.smallest, words)
    types = _types(options, cells, words)
    if types is not None:
        types = dict(zip(cells.names, types))
    mask, pad = tissue_of(cells, options.smallest_cavity, options.fill_gaps, words)
    parts = surface_of(cells, mask, pad, words)
    directory.mkdir(parents=True, exist_ok=True)
    kinds = [types[name] for name in cells.names] if types else None
    write_cells(directory / "cells.csv", cells.places[:, ::-1], cells.volumes,
                {"type": kinds})
    surface = "surface.off" if labels.ndim == 3 else "outline.wkt"
    (write_off if labels.ndim == 3 else write_wkt)(directory / surface, parts)
    words += _about_parts(parts, labels.ndim)
    keys = scene_keys(cells.places.shape[1], cells.length, surface, kinds)
    # patches half as long as a cell: those of a small cavity are curved
    keys["Tissue/Boundary points"] = round(
        sum(part.area for part in parts) / (0.5 * cells.length)
        ** (labels.ndim - 1))
    keys |= _lumen(parts, words)
    return _finish(options, directory, keys, cells.length, len(cells.volumes), cells.volumes, words)


def scene_of_table(options, directory):
    from .table import read_table
    words = []
    voxel = None if options.voxel is None else voxel_of(options.voxel, None, 3)
    table = read_table(options.file, options.frame, voxel, words)
    types = None
    if options.types:
        from .types import types_of_table
        if "id" not in table:
            raise Refused("--types", options.types, "nothing for a table " "without a column id")
        types = types_of_table(options.types, table["id"], words)
    elif "type" in table:
        from .types import checked
        types = checked(table["type"], "The table", options.file)
    axes = [axis for axis in "xyz" if axis in table]
    volumes = table["volume"].to_numpy()
    length = float(volumes.mean() ** (1 / len(axes)))
    directory.mkdir(parents=True, exist_ok=True)
    write_cells(directory / "cells.csv", table[axes].to_numpy(), volumes,
                {"type": types, **{name: list(table[name])
                                   for name in ("generation", "phase")
                                   if name in table}})
    words.append("A table has no surface: the program makes one around the "
                 "cells, in which narrow gaps and cavities are closed.")
    keys = scene_keys(len(axes), length, "always", types)
    return _finish(options, directory, keys, length, len(table), volumes, words)


def _types(options, cells, words):
    from .types import types_of_marker, types_of_table
    if options.types:
        return types_of_table(options.types, cells.names, words)
    if options.marker or options.marker_channel is not None:
        return types_of_marker(cells, options, words)
    return None


def scene_keys(dimension, length, surface, types):
    """The keys of a scene of cells of this mean length, um."""
    keys = {"Dimension": dimension, "Output directory": "",
            "Time/End time": 5, "Time/Step": 0.1,
            "Tissue/Shape": "points", "Tissue/Points file": "cells.csv",
            "Tissue/Points surface": surface,
            "Tissue/Cell spacing": f"{length:.4g}",
            "Tissue/Boundary points": 0,
            "Grid/Spacing": f"{2.02 * length:.4g}", "Grid/Points per cell": 2,
            "Proliferation/Law": "cell cycle",
            "Proliferation/Cell cycle/Duration": 1,
            "Proliferation/Cell cycle/G0 exit rate": 0.2,
            "Proliferation/Cell cycle/Size checkpoint": 0.8}
    if types:
        keys["Cell types/Names"] = ", ".join(sorted(set(types)))
    return keys


def _about_parts(parts, dim):
    bodies = [part for part in parts if part.volume > 0]
    cavities = [part for part in parts if part.volume < 0]
    words = [f"The tissue is {len(bodies)} bodies that do not touch."] if len(bodies) > 1 else []
    if cavities:
        words.append(f"It has {len(cavities)} " + ("cavity" if len(cavities) == 1 else "cavities")
                     + ", of " + ", ".join(f"{-part.volume:.4g}" for part in reversed(cavities))
                     + f" um^{dim}.")
    return words


def _lumen(parts, words):
    """The keys of the largest cavity, which keeps its volume."""
    from .surface import balls_around
    cavities = [part for part in parts if part.volume < 0]
    if not cavities:
        return {}
    lumen = cavities[-1]  # the most negative
    balls = balls_around(lumen, [part for part in parts if part is not lumen])
    if balls is None or len(balls) > MOST_BALLS:
        words.append("The wall around the largest cavity is too thin to tell "
                     "its surface from the outer one: no lumen is set.")
        return {}
    where = " || ".join(
        " + ".join(f"({axis} - {value:.6g})^2" for axis, value
                   in zip("XYZ", centre[::-1])) + f" < {radius:.6g}^2"
        for centre, radius in balls)
    words.append("The largest cavity is a lumen that keeps its volume (Lumen where, Lumen volume "
                 "= 1)." + (" The surfaces of the others are free." if len(cavities) > 1 else ""))
    return {"Boundary conditions/Lumen where": where, "Boundary conditions/Lumen volume": 1}


def _finish(options, directory, keys, length, n, volumes, words):
    dim = keys["Dimension"]
    keys["Output directory"] = f"output/{directory.resolve().name}"
    write(directory / "scene.prm", prm(keys, [
        f"From {options.file.name} by contrib/import; lengths in um, times in "
        "days.", "Growth and mechanics are examples: set your own."]))
    return [f"{n} cells in {dim}-D, together {np.sum(volumes):.5g} um^{dim}, "
            f"on average {length:.4g} um long.", *words,
            f"{directory / 'scene.prm'}, cells.csv"
            + (", " + keys["Tissue/Points surface"]
               if "." in keys["Tissue/Points surface"] else "")
            + f" are written; morula {directory / 'scene.prm'} runs the scene."]
