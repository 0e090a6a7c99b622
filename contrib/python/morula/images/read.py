# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Files of images, and what of them may be labels."""
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from morula.refusal import Refused

# What other programs read and save as TIFF, or tables as CSV; JPEG changes labels.
FOREIGN = ".nrrd .czi .lif .nd2 .ims .oib .oif .jpg .jpeg .nii .mha .mat .xls .xlsx .ods".split()
IN_UM = {"um": 1.0, "µm": 1.0, "\u03bcm": 1.0, "\\u00b5m": 1.0, "micron": 1.0, "microns": 1.0,
         "micrometer": 1.0, "micrometers": 1.0, "micrometre": 1.0, "nm": 1e-3, "nanometer": 1e-3,
         "mm": 1e3, "millimeter": 1e3, "cm": 1e4, "m": 1e6}


@dataclass
class Image:
    """An array with axes z, y, x or y, x; `voxel` (um, in this order) is what
    the file says, or None; `words` what to say of it."""

    array: np.ndarray
    voxel: tuple = None
    words: list = field(default_factory=list)


def read_image(file, channel=None, frame=None, option="The image"):
    """Throws Refused for a file that holds no image, or more than one."""
    file = Path(file)
    if not file.is_file():
        raise Refused(option, file, "a file that can be read", "Correct its name.")
    reader = _read_numpy if file.suffix.lower() in (".npy", ".npz") \
        else _read_tiff
    try:
        array, axes, voxel, words = reader(file)
    except Refused:
        raise
    except Exception as error:  # libraries throw what they like
        raise Refused(option, file, "an image as TIFF or NumPy",
                      f"It cannot be read: {error}.") from None
    array, words = _without_axes(file, array, axes, channel, frame, words)
    if array.ndim == 3 and len(array) == 1:
        array = array[0]
        words.append("It has one slice: the tissue is two-dimensional.")
    if array.ndim not in (2, 3) or 0 in array.shape:
        raise Refused(option, file, "an image with axes z, y, x or y, x",
                      f"Its shape is {array.shape}.")
    return Image(array, voxel, words)


def _read_numpy(file):
    array = np.load(file, allow_pickle=False)
    if isinstance(array, np.lib.npyio.NpzFile):
        if len(array.files) != 1:
            raise Refused("The image", file, "a file with one array",
                          "It has " + ", ".join(array.files) + ".")
        array = array[array.files[0]]
    axes = {2: "YX", 3: "ZYX"}.get(array.ndim, "?" * array.ndim)
    if (array.ndim == 3 and array.shape[-1] in (3, 4) and array.dtype == np.uint8):
        axes = "YXS"
    return array, axes, None, []


def _read_tiff(file):
    import tifffile
    with tifffile.TiffFile(file) as tiff:
        series = tiff.series[0]
        words = [] if len(tiff.series) == 1 else [
            f"It has {len(tiff.series)} images: the first is taken."]
        return (series.asarray(), series.axes, _voxel_of(tiff, series), words)


def _voxel_of(tiff, series):
    """Edges in um in the order z, y, x, from OME, or ImageJ's."""
    if tiff.ome_metadata:
        root = ElementTree.fromstring(tiff.ome_metadata)
        for pixels in root.iter():
            if pixels.tag.rpartition("}")[2] == "Pixels":
                return _edges([(pixels.get(f"PhysicalSize{axis}"),
                                pixels.get(f"PhysicalSize{axis}Unit", "µm")) for axis in "ZYX"])
    if tiff.imagej_metadata:
        about, tags = tiff.imagej_metadata, series.pages[0].tags
        if "XResolution" not in tags:
            return None
        unit = str(about.get("unit", ""))
        per = [tags[name].value for name in ("YResolution", "XResolution")]
        return _edges([(about.get("spacing"), unit), *((low / high if high else None, unit)
                                                       for high, low in per)])
    return None


def _edges(pairs):
    """None if one in the plane is not known; z may be missing."""
    sizes = []
    for size, unit in pairs:
        factor = IN_UM.get(unit)
        sizes.append(float(size) * factor if size and factor else None)
    if sizes[1] is None or sizes[2] is None:
        return None
    return (sizes[0] or sizes[1], *sizes[1:])


def _without_axes(file, array, axes, channel, frame, words):
    """The array without channels, times and axes of length 1."""
    if "S" in axes and array.shape[axes.index("S")] in (2, 3, 4):
        raise Refused("The image", file, "labels: a whole number for each voxel",
                      "It is a colour picture (RGB): segment it first, and save the labels.")
    for axis, choice, option in (("C", channel, "--channel"), ("T", frame, "--frame")):
        if axis in axes:
            at = axes.index(axis)
            array = np.take(array, _chosen(option, choice, array.shape[at]), at)
            axes = axes.replace(axis, "", 1)
        elif choice not in (None, 0):
            raise Refused(option, choice, "nothing for this image", f"Its axes are {axes}.")
    single = [i for i, axis in enumerate(axes) if array.shape[i] == 1 and axis not in "YX"]
    array = np.squeeze(array, tuple(single)) if array.ndim > 3 else array
    if array.ndim > 3:
        raise Refused("The image", file, "axes z, y, x; or y, x", f"It has {array.ndim} axes of "
                      f"{array.shape}: save one time and one channel.")
    return array, words


def _chosen(option, choice, length):
    if choice is None and length > 1:
        raise Refused(option, "", f"a number from 0 to {length - 1}",
                      "The image has several: say which one has the labels.")
    if not 0 <= (choice or 0) < length:
        raise Refused(option, choice, f"a number from 0 to {length - 1}")
    return choice or 0
