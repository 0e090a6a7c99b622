# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The command morula import."""
import re
import shutil
from pathlib import Path

import numpy as np

from morula.command_line import output_directory, run_tool
from morula.files import write
from morula.program import Program
from morula.refusal import Refused

from .options import parser, voxel_of
from .writing import prm, refuse_signs, write_cells, write_off, write_wkt

MOST_BALLS = 40  # around a lumen
TENSION = 0.05   # kPa, times the length of a cell: it keeps the wall of a lumen even


def main(words=None):
    """Exit code 0, or 1 for what makes no sense."""
    def tool():
        options = parser().parse_args(words)
        if not options.file.exists():
            raise Refused("The file", options.file, "a label image or a table "
                          "that can be read", "Correct its name.")
        name = re.sub(r"(\.ome|_seg)?(\.[A-Za-z][A-Za-z0-9]*)?$", "", options.file.name)
        directory = output_directory(options, Path(name or "tissue"))
        refuse_signs("--output", directory, "Choose another one: --output NAME.")
        if (directory / "scene.prm").exists() and not options.again:
            raise Refused("--output", directory, "a directory without a scene.prm",
                          "Choose another one, or replace that one with --again.")
        make_scene(options, directory)
        return 0
    return run_tool("import", tool)


def make_scene(options, directory):
    """Reads, judges, writes, and says what it found."""
    from .read import is_image
    found = (scene_of_image if is_image(options.file) else scene_of_table)(options, directory)
    for line in found:
        print(f"import: {line}")
    write(directory / "report.txt", "".join(f"{line}\n" for line in found))


def scene_of_image(options, directory):
    from .labels import cells_of, refuse_times, whole
    from .read import read_image
    from .surface import surface_of, tissue_of
    if options.surface:
        raise Refused("--surface", options.surface, "nothing for an image, which has its own")
    image = read_image(options.file, options, options.channel)
    words = image.words
    labels, names = whole(image, options.file)
    if labels.ndim == 3 and not options.axes:
        refuse_times(labels)
    voxel = voxel_of(options.voxel, image.voxel, labels.ndim)
    words.append(f"A voxel is {' x '.join(f'{edge:.6g}' for edge in voxel[::-1])} um (x, y, z).")
    cells = cells_of(labels, names, voxel, options.smallest, words)
    types = _types(options, cells, words)
    if types is not None:
        types = dict(zip(cells.names, types))
    mask, pad = tissue_of(cells, options.smallest_cavity, options.fill_gaps, words, options.file)
    parts = surface_of(cells, mask, pad, words)
    directory.mkdir(parents=True, exist_ok=True)
    kinds = [types[name] for name in cells.names] if types else None
    write_cells(directory / "cells.csv", cells.places[:, ::-1], cells.volumes, {"type": kinds})
    surface = "surface.off" if labels.ndim == 3 else "outline.wkt"
    (write_off if labels.ndim == 3 else write_wkt)(directory / surface, parts)
    words += _about_parts(parts, labels.ndim)
    keys = scene_keys(cells.places.shape[1], cells.length, surface, kinds)
    # patches half as long as a cell: those of a small cavity are curved
    keys["Tissue/Boundary points"] = round(
        sum(part.area for part in parts) / (0.5 * cells.length) ** (labels.ndim - 1))
    keys |= _lumen(parts, cells.length, words)
    return _finish(options, directory, keys, cells.length, len(cells.volumes), cells.volumes, words)


def scene_of_table(options, directory):
    from .table import read_table
    words = []
    voxel = None if options.voxel is None else voxel_of(options.voxel, None, 3, 2)
    table = read_table(options.file, options.frame, voxel, options.surface, words)
    types = None
    if options.types:
        from .types import types_of_table
        if "id" not in table:
            raise Refused("--types", options.types, "nothing for a table " "without a column id")
        types = types_of_table(options.types, table["id"], words)
    elif "type" in table:
        from .types import named
        types = named(table["type"], words)
    axes = [axis for axis in "xyz" if axis in table]
    volumes = table["volume"].to_numpy()
    length = float(volumes.mean() ** (1 / len(axes)))
    directory.mkdir(parents=True, exist_ok=True)
    write_cells(directory / "cells.csv", table[axes].to_numpy(), volumes, {"type": types, **{
        name: list(table[name]) for name in ("generation", "phase") if name in table}})
    surface = "always"
    if options.surface:
        surface = f"surface{options.surface.suffix.lower()}"
        shutil.copyfile(options.surface, directory / surface)
    else:
        words.append("A table has no surface: the program makes one around the cells, in which "
                     "narrow gaps and cavities are closed.")
    keys = scene_keys(len(axes), length, surface, types)
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


def _lumen(parts, length, words):
    """The keys of the largest cavity, which keeps its volume; cells divide slowly around it."""
    from .surface import balls_around
    cavities = [part for part in parts if part.volume < 0]
    if not cavities:
        return {}
    lumen = cavities[-1]  # the most negative
    balls = balls_around(lumen, [part for part in parts if part is not lumen])
    if balls is None or len(balls) > MOST_BALLS:
        words.append("The wall around the largest cavity is too thin to tell its surface from the "
                     "outer one: no lumen is set.")
        return {}
    where = " || ".join(
        " + ".join(f"({axis} - {value:.6g})^2" for axis, value
                   in zip("XYZ", centre[::-1])) + f" < {radius:.6g}^2"
        for centre, radius in balls)
    words.append("The largest cavity is a lumen that keeps its volume (Lumen where, Lumen volume "
                 "= 1)." + (" The surfaces of the others are free." if len(cavities) > 1 else ""))
    return {"Proliferation/Cell cycle/G0 exit rate": 0.1,
            "Boundary conditions/Lumen where": where, "Boundary conditions/Lumen volume": 1,
            "Boundary conditions/Surface tension": f"{TENSION * length:.3g}"}


def _tune(options, file, keys, comments, words):
    """Writes the scene with the widest grid of which the program does not warn."""
    widest, said = float(keys["Grid/Spacing"]), ""
    for share in (1, 0.85, 0.7, 0.6, 1):
        keys["Grid/Spacing"] = f"{share * widest:.4g}"
        write(file, prm(keys, comments))
        try:
            warnings = Program(options.morula).explain(file)["warnings"]
        except Refused as refusal:
            words.append(f"The scene was not tried: {refusal}")
            return
        if not warnings:
            return
        said = said or warnings[0]
    words.append("The scene runs, but with a warning at every grid spacing: "
                 + said.removeprefix("Warning: "))


def _finish(options, directory, keys, length, n, volumes, words):
    dim = keys["Dimension"]
    place = directory.resolve()
    keys["Output directory"] = "output/" + str(place.relative_to(
        Path.cwd() if place.is_relative_to(Path.cwd()) else place.anchor))
    _tune(options, directory / "scene.prm", keys, [
        f"From {options.file.name} by morula import; lengths in um, times in "
        "days.", "Growth and mechanics are examples: set your own."], words)
    surface = keys["Tissue/Points surface"]
    return [f"{n} cells in {dim}-D, together {np.sum(volumes):.5g} um^{dim}, on average "
            f"{length:.4g} um long.", *words, f"{directory / 'scene.prm'}, cells.csv"
            + (", " + surface if "." in surface else "")
            + f" are written; morula {directory / 'scene.prm'} runs the scene."]
