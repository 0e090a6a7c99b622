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

from .markup import Markup, text

WIDTH, MOST = 1600, 4


def pictures(run, say):
    """As HTML. A run without any gets one by contrib/render: the last state
    from outside and cut open."""
    found = sorted(run.directory.glob("*.png"))[:MOST]
    if found:
        return Markup("".join(element(file, file.name) for file in found))
    if not len(run.times):
        return Markup("<p>No cells were written (Output/Formats = none), so "
                      "that there is nothing to draw.</p>")
    with tempfile.TemporaryDirectory() as scratch:
        file = Path(scratch) / "energy_density.png"
        result = call(
            [sys.executable, "-P", "-m", "morula", "render", run.directory,
             "--panels", "2", "--field", "energy_density", "--output", file],
            stderr=subprocess.STDOUT)
        if result.code != 0 or not file.is_file():
            say(f"report: no picture: {result.stdout.strip()}")
            return Markup("<p>contrib/render could not draw the run: "
                          f"{text(result.stdout.strip()[-300:])}</p>")
        return Markup(element(file, "the last state, from outside and cut "
                              "open, drawn by contrib/render"))


def element(file, words):
    """The picture, at most so wide."""
    with Image.open(file) as image:
        image = image.convert("RGB")
        if image.width > WIDTH:
            image = image.resize((WIDTH, round(image.height * WIDTH
                                               / image.width)), Image.LANCZOS)
        stream = io.BytesIO()
        image.save(stream, "JPEG", quality=85, optimize=True)
    content = base64.b64encode(stream.getvalue()).decode()
    return (f'<figure class="picture"><img alt="{text(words)}" '
            f'src="data:image/jpeg;base64,{content}">'
            f"<figcaption>{text(words)}</figcaption></figure>")
