# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Films of pictures (height, width, 3), bytes. GIF comes with PIL, and Ogg with VTK; MP4 and WebM,
which all browsers show and are a tenth of the size, need the program ffmpeg."""
import shutil
import subprocess

import numpy as np
from morula.refusal import Refused
from PIL import Image

REST = 1.0   # seconds that the last picture stays
BLOCK = 16   # videos consist of blocks of so many pixels


def film_writer(wanted, stem, rate):
    """(file, what writes the pictures to it). Throws Refused if the kind is
    unknown, or what it needs is missing."""
    path = wanted or stem.with_name(stem.name + (".mp4" if shutil.which("ffmpeg") else ".gif"))
    kinds = {".gif": write_gif, ".ogv": write_ogg, ".mp4": write_by_ffmpeg,
             ".webm": write_by_ffmpeg}
    write = kinds.get(path.suffix.lower())
    if write is None:
        raise Refused("--output", path, "a film's name, with " + ", ".join(kinds) + " at its end")
    if write is write_by_ffmpeg and not shutil.which("ffmpeg"):
        raise Refused("--output", path, "a name with .gif or .ogv at its end, as the program "
                      "ffmpeg is missing", "Debian's package ffmpeg has it.")
    return path, lambda pictures, target: write(pictures, target, rate)


def in_blocks(pictures):
    """With white at the right and below up to whole blocks."""
    for picture in pictures:
        height, width = picture.shape[:2]
        yield np.pad(picture, ((0, -height % BLOCK), (0, -width % BLOCK),
                               (0, 0)), constant_values=255)


def write_gif(pictures, path, rate):
    first, *rest = [Image.fromarray(picture).quantize(
        dither=Image.Dither.NONE) for picture in pictures]
    times = [1000 / rate] * len(rest) + [1000 * max(REST, 1 / rate)]
    first.save(path, save_all=True, append_images=rest, duration=times,
               loop=0, optimize=False, format="GIF")


def write_ogg(pictures, path, rate):
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonDataModel import vtkImageData
    from vtkmodules.vtkIOOggTheora import vtkOggTheoraWriter

    def image(picture):
        """VTK's image counts rows from below."""
        data = vtkImageData()
        data.SetDimensions(picture.shape[1], picture.shape[0], 1)
        rows = np.ascontiguousarray(picture[::-1]).reshape(-1, 3)
        data.GetPointData().SetScalars(numpy_to_vtk(rows, deep=True))
        return data

    writer = vtkOggTheoraWriter()
    writer.SetFileName(str(path))
    writer.SetRate(max(1, round(rate)))
    writer.SetQuality(2)
    writer.SubsamplingOn()  # 4:2:0, which every player knows
    for i, picture in enumerate(in_blocks(pictures)):
        writer.SetInputData(image(picture))
        if i == 0:
            writer.Start()
        writer.Write()
    for _ in range(round(REST * writer.GetRate())):
        writer.Write()
    writer.End()
    if writer.GetError():
        raise OSError(f"VTK could not write {path}: is the disk full?")


def write_by_ffmpeg(pictures, path, rate):
    process = None
    for picture in in_blocks(pictures):
        if process is None:
            height, width = picture.shape[:2]
            process = subprocess.Popen(["ffmpeg", "-y", "-loglevel", "error", "-f", "rawvideo",
                                        "-pix_fmt", "rgb24", "-s", f"{width}x{height}", "-r",
                                        str(rate), "-i", "-", "-vf",
                                        f"tpad=stop_mode=clone:stop_duration={REST}", "-pix_fmt",
                                        "yuv420p", "-r", str(max(rate, 10)), "-f", path.suffix[1:],
                                        str(path)], stdin=subprocess.PIPE)
        try:
            process.stdin.write(picture.tobytes())
        except BrokenPipeError:
            break
    process.stdin.close()
    if process.wait():
        raise OSError(f"ffmpeg could not write {path}; see above")
