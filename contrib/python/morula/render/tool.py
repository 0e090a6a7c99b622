# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The command morula render."""
import sys
import time

from morula.command_line import tell
from morula.draw.screen import virtual_screen
from morula.files import replaced
from morula.refusal import Refused
from morula.run import NoStates
from PIL import Image

from .frames import Frames
from .request import Request, arguments


def main(words=None):
    options = arguments(words)
    try:
        request = Request(options)
        with virtual_screen():
            draw(request)
    except (Refused, NoStates, OSError) as error:
        print(f"render: {error}", file=sys.stderr)
        return 1
    return 0


def draw(request):
    frames = Frames(request)
    options = request.options
    if request.film:
        def pictures():
            start = time.monotonic()
            for done, (_, picture) in enumerate(frames, 1):
                tell(progress(done, len(request.states), time.monotonic() - start))
                yield picture

        with replaced(request.path) as unfinished:
            request.film(pictures(), unfinished)
        print(f"render: {request.path}, {len(request.states)} states")
        return
    for number, picture in frames:
        path = (request.path / f"{options.field}-{number:04}.png" if options.all else request.path)
        Image.fromarray(picture).save(path, "PNG")
        print(f"render: {path}", flush=True)


def progress(done, total, seconds):
    """What is said when so many pictures of a film have been drawn."""
    left = seconds / done * (total - done)
    return (f"render: picture {done} of {total}"
            + (f", {left:.0f} s left" if done < total and left >= 1 else ""))
