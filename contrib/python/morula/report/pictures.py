# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Pictures of the run: those in its directory, or one that is made."""
import base64
import io
import subprocess
import sys
import tempfile
from pathlib import Path

from morula.execute import call
from PIL import Image

from .markup import joined, paragraph, photograph

WIDTH, MOST = 1600, 4


def pictures(run, say):
    """As HTML. A run without any gets one by contrib/render: the last state
    from outside and cut open."""
    found = sorted(run.directory.glob("*.png"))[:MOST]
    if found:
        return joined(element(file, file.name) for file in found)
    if not len(run.times):
        return paragraph("No cells were written (Output/Formats = none), so "
                         "that there is nothing to draw.")
    with tempfile.TemporaryDirectory() as scratch:
        field = "type" if run.type_names else "energy_density"
        file = Path(scratch) / f"{field}.png"
        result = call(
            [sys.executable, "-P", "-m", "morula", "render", run.directory,
             "--panels", "2", "--field", field, "--output", file],
            stderr=subprocess.STDOUT)
        if result.code != 0 or not file.is_file():
            say(f"report: no picture: {result.stdout.strip()}")
            return paragraph("contrib/render could not draw the run: "
                             + result.stdout.strip()[-300:])
        return element(file, "the last state, " + (
            "" if run.dimension == 2 else "from outside and cut open, ")
            + "drawn by contrib/render")


def element(file, words):
    """The picture, at most so wide."""
    with Image.open(file) as image:
        image = image.convert("RGB")
        if image.width > WIDTH:
            image = image.resize((WIDTH, round(image.height * WIDTH
                                               / image.width)), Image.LANCZOS)
        stream = io.BytesIO()
        image.save(stream, "JPEG", quality=85, optimize=True)
    return photograph(base64.b64encode(stream.getvalue()).decode(), words)
