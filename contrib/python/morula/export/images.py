# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Label images of states, as OME-TIFF with their place in space, or for NumPy."""
import numpy as np

from morula.files import replaced
from morula.shapes.regions import regions_of_state

from .rasters import box_of, filled, raster_around


def write(run, numbers, file, voxel):
    """Writes these states of a Run as images with voxels of these edges (x, y,
    z; um), all in one box; yields (file, words about it)."""
    boxes, largest = [], 0
    for number in numbers:
        bodies = regions_of_state(run, number).bodies
        boxes.append(box_of(bodies, run.dimension))
        largest = max(largest, int(run.cells(number)["id"].max()) + 1)
    raster = raster_around(boxes, voxel[:run.dimension], largest)
    for number in numbers:
        cells = run.cells(number)
        if len(numbers) > 1:  # regions of all states would not fit into memory
            bodies = regions_of_state(run, number).bodies
        image = filled(raster, bodies, cells["id"].to_numpy() + 1)
        target = file if len(numbers) == 1 else file.with_name(
            f"{file.stem}-{number:04}{file.suffix}")
        (_write_npy if file.suffix.lower() == ".npy" else _write_tiff)(target, image, raster)
        lost = len(cells) - len(np.unique(image[image > 0]))
        yield target, (f"day {run.times[number]:g}, {' x '.join(map(str, image.shape[::-1]))} "
                       "voxels, corner at " + ", ".join(f"{x:g}" for x in raster.low[::-1]) + " um"
                       + (f"; {lost} cells are smaller than a voxel and have none" if lost else ""))


def _write_npy(file, image, _):
    # of a name, NumPy would take another one unless it ends in .npy
    with replaced(file) as aside, aside.open("wb") as stream:
        np.save(stream, image)


def _write_tiff(file, image, raster):
    import tifffile
    axes = "ZYX"[3 - image.ndim:]
    planes = image.shape[0] if image.ndim == 3 else 1
    about = {"axes": axes, "Name": file.stem}
    for axis, edge in zip(axes, raster.voxel):
        about |= {f"PhysicalSize{axis}": float(edge), f"PhysicalSize{axis}Unit": "µm"}
    # where the middle of the first voxel of each plane is
    middle = dict(zip(axes, raster.low + 0.5 * raster.voxel))
    about["Plane"] = {f"Position{axis}": [float(place + (i * raster.voxel[0] if axis == "Z" else 0))
                                          for i in range(planes)] for axis, place in middle.items()}
    about["Plane"] |= {f"Position{axis}Unit": ["µm"] * planes for axis in axes}
    with replaced(file) as aside:
        tifffile.imwrite(aside, image, ome=True, photometric="minisblack",
                         compression="zlib", metadata=about)
