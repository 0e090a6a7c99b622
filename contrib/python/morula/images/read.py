# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Files of images, and what of them may be labels."""
import json
import pickle
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from morula.refusal import Refused

# What other programs read and save as TIFF, or tables as CSV; JPEG changes labels.
FOREIGN = ".czi .lif .nd2 .ims .oib .oif .jpg .jpeg .nii .mha .mat .xls .xlsx .ods".split()
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


def is_image(file):
    """Whether a file is none of text."""
    if file.is_dir() or file.suffix.lower() in (*FOREIGN, ".nrrd", ".nhdr"):
        return True
    with file.open("rb") as stream:
        head = stream.read(4096)
    return b"\0" in head and not head.startswith((b"\xff\xfe", b"\xfe\xff")) and head[1:2] != b"\0"


def read_image(file, options, channel=None, option="The image"):
    """Throws Refused for a file that holds no image, or more than one."""
    file = Path(file)
    if not file.exists():
        raise Refused(option, file, "a file that can be read", "Correct its name.")
    kind = file.suffix.lower()
    if kind in FOREIGN:
        raise Refused(option, file, "an image as TIFF, or a table as CSV", f"No {kind[1:].upper()} "
                      "is read: save it as TIFF (Fiji and 3D Slicer open most), a table as CSV.")
    reader = _read_zarr if file.is_dir() else {
        ".tif": _read_tiff, ".tiff": _read_tiff, ".lsm": _read_tiff, ".npy": _read_numpy,
        ".npz": _read_numpy, ".h5": _read_hdf5, ".hdf5": _read_hdf5, ".nrrd": _read_nrrd,
        ".nhdr": _read_nrrd}.get(kind, _read_picture)
    try:
        array, axes, voxel, words = reader(file, options.dataset)
    except (Refused, ImportError):
        raise
    except Exception as error:  # libraries throw what they like
        raise Refused(option, file, "an image as TIFF, PNG, NumPy, HDF5 or OME-Zarr",
                      f"It cannot be read: {error}. Is it cut off, damaged, or not of "
                      "the kind that its ending says?") from None
    axes = options.axes.upper() if options.axes else axes or {
        2: "YX", 3: "ZYX"}.get(array.ndim, "?" * array.ndim)
    if len(axes) != array.ndim or options.axes and not {*"YX"} <= {*axes} <= {*"TCZYX"}:
        raise Refused("--axes", axes, f"a letter of tczyx for each of {array.ndim} axes")
    array, words = _without_axes(file, array, axes, channel, options.frame, words)
    if array.ndim == 3 and len(array) == 1:
        array = array[0]
        words.append("It has one slice: the tissue is two-dimensional.")
    if array.ndim not in (2, 3) or 0 in array.shape:
        raise Refused(option, file, "an image with axes z, y, x or y, x",
                      f"Its shape is {array.shape}.")
    return Image(array, voxel, words)


class _Arrays(pickle.Unpickler):
    """Arrays, numbers and texts as cellpose saves them; nothing that could be executed."""

    def find_class(self, module, name):
        if module.startswith("numpy") and name in ("_reconstruct", "ndarray", "dtype", "scalar"):
            return super().find_class(module.replace("numpy._core", "numpy.core"), name)
        raise pickle.UnpicklingError(f"it has a {module}.{name}")


def _read_numpy(file, dataset):
    with file.open("rb") as stream:
        if stream.read(6) == b"\x93NUMPY":
            stream.seek(0)
            version = np.lib.format.read_magic(stream)
            *_, kind = np.lib.format._read_array_header(stream, version)
            if kind.hasobject:
                return _Arrays(stream).load().item()["masks"], None, None, [
                    "It is a file of cellpose: its masks are taken."]
    array = np.load(file, allow_pickle=False)
    if isinstance(array, np.lib.npyio.NpzFile):
        array = array[_chosen_name(file, array.files, dataset)]
    colours = array.ndim == 3 and array.shape[-1] in (3, 4) and array.dtype == np.uint8
    return array, "YXS" if colours else None, None, []


def _chosen_name(file, names, dataset):
    """Of several arrays in a file: --dataset, the only one, or that of ilastik."""
    names = list(names)
    name = dataset or (names[0] if len(names) == 1 else "exported_data")
    if name not in names:
        raise Refused("--dataset", dataset or "", "one of " + (", ".join(names) or "none"),
                      f"{file} has {len(names)} arrays: say which one has the labels.")
    return name


def _read_picture(file, _):
    from PIL import Image as Pictures
    with Pictures.open(file) as picture:  # of a palette the numbers are the labels
        return np.array(picture), "YXS"[:np.array(picture).ndim], None, []


def _read_hdf5(file, dataset):
    import h5py
    with h5py.File(file) as stream:
        found = []
        stream.visititems(lambda name, node: found.append(name) if getattr(
            node, "shape", None) and len(node.shape) > 1 else None)
        node = stream[_chosen_name(file, found, dataset)]
        tags = json.loads(node.attrs.get("axistags", "{}")).get("axes", [])
        return (node[()], "".join(tag["key"] for tag in tags).upper(),
                tuple(map(float, node.attrs.get("element_size_um", ()))) or None, [])


def _read_nrrd(file, _):
    try:
        import nrrd
    except ImportError:
        raise Refused("The image", file, "NRRD only where Python has pynrrd", "Install it (pip "
                      "install pynrrd), or save the labels as TIFF, as Fiji does.") from None
    array, about = nrrd.read(str(file), index_order="C")
    edges = np.linalg.norm(about["space directions"], axis=1) if "space directions" in about \
        else np.asarray(about.get("spacings", []), dtype=float)  # NaN: of channels
    sizes = [*zip(edges[np.isfinite(edges)], about.get("space units", about.get("units", [])))]
    return array, None, _edges([(None, None)] * (3 - len(sizes)) + sizes[2::-1]), []


def _read_zarr(file, dataset):
    import zarr
    group = zarr.open(str(file), mode="r")
    if "labels" in group:  # of OME, beside the image
        group = group["labels"]
        group = group[_chosen_name(file, group.attrs.get("labels", group.group_keys()), dataset)]
    if "multiscales" not in group.attrs:
        return (group[_chosen_name(file, group.array_keys(), dataset)]
                if hasattr(group, "array_keys") else group)[:], None, None, []
    scales = group.attrs["multiscales"][0]
    array = group[scales["datasets"][0]["path"]][:]
    axes = [axis if isinstance(axis, dict) else {"name": axis}
            for axis in scales.get("axes", "tczyx"[-array.ndim:])]
    scale = next((one["scale"] for one in scales["datasets"][0].get(
        "coordinateTransformations", ()) if one["type"] == "scale"), [None] * len(axes))
    sizes = {axis["name"]: (size, axis.get("unit")) for axis, size in zip(axes, scale)}
    return (array, "".join(sizes).upper(),
            _edges([sizes.get(axis, (None, None)) for axis in "zyx"]), [])


def _read_tiff(file, _):
    import tifffile
    with tifffile.TiffFile(file) as tiff:
        series, size = tiff.series[0], file.stat().st_size
        order = {"<": "little", ">": "big"}[tiff.byteorder]
        ends = [offset + count for page in tiff.pages for offset, count
                in zip(page.dataoffsets, page.databytecounts)]
        following = tiff.pages[0].offset  # each page says where the next one is
        while 0 < following < size:
            ends.append(following)
            tiff.filehandle.seek(following)
            n_tags = int.from_bytes(tiff.filehandle.read(tiff.tiff.tagnosize), order)
            tiff.filehandle.seek(n_tags * tiff.tiff.tagsize, 1)
            following = int.from_bytes(tiff.filehandle.read(tiff.tiff.offsetsize), order)
        if max(following, series.dataoffset + series.nbytes if series.dataoffset else 0,
               *ends) > size:
            raise Refused("The image", file, "a complete file",
                          f"The file is cut off after {size:,} bytes: copy or save it again.")
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
        units = {axis: str(about.get(f"{axis}unit", about.get("unit", ""))) for axis in "zy"}
        per = [tags[name].value for name in ("YResolution", "XResolution")]
        return _edges([(about.get("spacing"), units["z"]), *(
            (low / high if high else None, unit)
            for (high, low), unit in zip(per, (units["y"], about.get("unit", ""))))])
    return None


def _edges(pairs):
    """None if one in the plane is not known; z may be missing."""
    sizes = []
    for size, unit in pairs:
        factor = IN_UM.get(str(unit).lower())
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
            array = np.take(array, chosen(option, choice, array.shape[at]), at)
            axes = axes.replace(axis, "", 1)
        elif choice not in (None, 0):
            raise Refused(option, choice, "nothing for this image", f"Its axes are {axes}.")
    for axis in [axis for axis in axes if axis not in "ZYX"]:
        at = axes.index(axis)
        if array.ndim > 3 and array.shape[at] == 1:
            array, axes = np.squeeze(array, at), axes.replace(axis, "", 1)
    if {*axes} <= {*"ZYX"}:
        array = array.transpose(np.argsort(["ZYX".index(axis) for axis in axes]))
    if array.ndim > 3:
        raise Refused("The image", file, "axes z, y, x; or y, x", f"It has {array.ndim} axes of "
                      f"{array.shape}: say which is which (--axes tzyx), and choose"
                      " --frame and --channel.")
    return array, words


def chosen(option, choice, length):
    """The number of a channel or a time, which must be said if there are several."""
    if not 0 <= (choice or 0) < length or choice is None and length > 1:
        kind = "times" if option == "--frame" else "channels"
        raise Refused(option, "" if choice is None else choice, f"a number from 0 to {length - 1}",
                      f"There are {length} {kind}: say which one has the labels.")
    return choice or 0
