# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Labels of cells: what is wrong with them, and what is measured of them."""
from dataclasses import dataclass

import numpy as np
from scipy import ndimage
from skimage import measure

from morula.refusal import Refused

FEWEST = 2
MOST_RATIO = 100  # of the edges of a voxel
MOST_VOXELS = 4e8  # 20 bytes each


def whole(image, file):
    """The image as labels, whole numbers >= 0; a mask becomes one label for each
    connected part. Throws Refused for what cannot be labels."""
    array = image.array
    if array.dtype.kind == "f":
        if not np.isfinite(array).all() or (array != np.rint(array)).any():
            raise Refused("The image", file, "labels: a whole number for each "
                          "voxel", "It has fractions, so it is an intensity or "
                          "a probability: segment it first.")
        image.words.append("Its numbers are floating-point, but whole.")
    elif array.dtype.kind not in "biu":
        raise Refused("The image", file, "labels: a whole number for each "
                      "voxel", f"Its numbers are of the type {array.dtype}.")
    if array.dtype.kind in "if" and (array < 0).any():
        image.words.append("Labels below 0 are taken for no cell.")
        array = np.maximum(array, 0)
    values = np.unique(array[array > 0])
    if not len(values):
        raise Refused("The image", file, "labels of cells", "All of it is 0, which is no cell.")
    if len(values) == 1:
        parts = measure.label(array > 0, connectivity=1)
        if parts.max() < FEWEST:
            raise Refused("The image", file, "a label of its own for each cell",
                          "It is a mask with a single part: segment it into cells, or fill its "
                          "surface with a lattice (Tissue/Shape = mesh).")
        image.words.append(f"It is a mask, with one number: its {parts.max()} parts that are not "
                           "connected count as cells. Cells that touch are one then.")
        return parts, np.arange(parts.max() + 1)
    labels = np.where(array > 0, np.searchsorted(values, array) + 1, 0)
    return labels, np.array([0, *map(int, values)], dtype=object)


def refuse_times(labels):
    """Asks what the first axis is if most labels are in nearly all of its planes, or in one, or
    begin in a later one with much of their size where others were: in space they have tips."""
    sizes = np.array([np.bincount(plane.ravel(), minlength=labels.max() + 1) for plane in labels])
    lives, first = np.median((sizes[:, 1:] > 0).sum(0)), (sizes > 0).argmax(0)
    later = np.flatnonzero(first)
    onto = np.array([np.bincount(after[before > 0], minlength=len(first))
                     for before, after in zip(labels, labels[1:])])
    daughters = onto[first[later] - 1, later] > 0.4 * sizes[:, later].max(0)
    if len(labels) > 2 and (lives >= 0.9 * len(labels) or lives == 1
                            or daughters.sum() > 0.8 * len(later)):
        raise Refused("--axes", "", "tyx or zyx", f"The {len(labels)} planes may be times: labels "
                      "follow each other as cells that live and divide do. If so, say --axes tyx "
                      "and --frame; if they are places, --axes zyx.")


def refuse_sizes(shape, voxel, pad, file):
    """Refuses edges that cannot be right, and images that would not fit into memory."""
    size = (np.array(shape) + 2 * pad).prod(dtype=float)
    if max(voxel) > MOST_RATIO * min(voxel) or size > MOST_VOXELS:
        raise Refused("The image", file, f"edges of voxels that differ by less than {MOST_RATIO} "
                      f"times, and at most {MOST_VOXELS:g} voxels with the space around the tissue",
                      f"It has {size:.3g}, of " + " x ".join(f"{edge:.4g}" for edge in voxel[::-1])
                      + " um: is the unit right (--voxel)? Else bin the image.")


@dataclass
class Cells:
    """What is measured of labels 1, 2, ...: row i is label numbers[i] of the array, names[i] of
    the file. places (n, dim) in um, order of the axes; volumes um^dim."""

    labels: np.ndarray
    voxel: np.ndarray
    numbers: np.ndarray
    names: np.ndarray
    volumes: np.ndarray
    places: np.ndarray

    @property
    def length(self):
        """Of the mean cell, um."""
        return float(self.volumes.mean() ** (1 / self.labels.ndim))

    def keep(self, kept):
        """Leaves out cells; their voxels are no cell's."""
        gone = np.zeros(self.labels.max() + 1, dtype=bool)
        gone[self.numbers[~kept]] = True
        self.labels[gone[self.labels]] = 0
        for name in ("numbers", "names", "volumes", "places"):
            setattr(self, name, getattr(self, name)[kept])


def cells_of(labels, names, voxel, smallest, words):
    """Measures the labels, leaves out crumbs, and says what is odd."""
    table = measure.regionprops_table(labels, properties=("label", "area", "centroid"))
    centres = np.stack([table[f"centroid-{d}"] for d in range(labels.ndim)], 1)
    cells = Cells(labels, voxel, table["label"], names[table["label"]],
                  table["area"] * voxel.prod(), (centres + 0.5) * voxel)
    crumbs = cells.volumes < smallest * np.median(cells.volumes)
    if crumbs.any():
        words.append(f"{crumbs.sum()} labels are smaller than {smallest:g} of the median one: "
                     f"these crumbs are left out ({_list(cells.names[crumbs])}).")
        cells.keep(~crumbs)
    if len(cells.names) < FEWEST:
        raise Refused("The image", f"{len(cells.names)} cells", f"at least {FEWEST} cells")
    _join_pieces(cells, words)
    _tell_border(cells, words)
    return cells


def _list(names, most=8):
    shown = ", ".join(str(name) for name in names[:most])
    return shown + (", ..." if len(names) > most else "")


def _join_pieces(cells, words):
    """A cell in several pieces stands in the largest one. Where a place is not within its own
    cell, as of a crescent, the cell stands where it is thickest."""
    pieces = measure.label(cells.labels, connectivity=cells.labels.ndim)
    parts = measure.regionprops_table(
        pieces, cells.labels, ("label", "area", "centroid", "max_intensity"))
    owner = parts["max_intensity"].astype(int)
    order = np.lexsort([parts["area"], owner])
    last = order[np.r_[np.diff(owner[order]) > 0, True]]  # the largest of each
    largest = dict(zip(owner[last], last))
    counts = np.bincount(owner, minlength=cells.labels.max() + 1)
    torn = counts[cells.numbers] > 1
    for row in np.flatnonzero(torn):
        part = largest[cells.numbers[row]]
        cells.places[row] = (np.array([parts[f"centroid-{d}"][part] for d
                                       in range(cells.labels.ndim)]) + 0.5) * cells.voxel
    if torn.any():
        words.append(f"{torn.sum()} labels are in several parts ({_list(cells.names[torn])}): "
                     "each counts as one cell with the volume of all its parts, placed in the "
                     "largest one.")
    index = tuple((cells.places / cells.voxel).astype(int).T)
    for row in np.flatnonzero(cells.labels[index] != cells.numbers):
        cells.places[row] = _thickest(cells.labels == cells.numbers[row], cells.voxel)


def _thickest(mask, voxel):
    box = ndimage.find_objects(mask)[0]
    depth = ndimage.distance_transform_edt(np.pad(mask[box], 1), voxel)
    place = np.array(np.unravel_index(depth.argmax(), depth.shape)) - 1
    return (place + [part.start for part in box] + 0.5) * voxel


def _tell_border(cells, words):
    border = cells.labels.copy()
    border[(slice(1, -1),) * border.ndim] = 0
    at_border = np.isin(cells.numbers, border)
    if at_border.any():
        words.append(f"{at_border.sum()} labels touch the border of the image "
                     f"({_list(cells.names[at_border])}): the image may cut "
                     "these cells, and the surface is closed there.")
