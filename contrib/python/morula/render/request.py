# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What morula render is asked for, checked before anything is drawn."""
import argparse
import math
from pathlib import Path

from morula.cell_types import names_of_run
from morula.refusal import Refused
from morula.run import states

from .films import film_writer

DESCRIPTION = """Draws the tissue of a run: every cell a shaded sphere of its volume, or
the polyhedron that it fills.

    morula render output                          the last state, from outside
    morula render output --panels 2               and beside it cut open
    morula render output --field energy_density --time 2.5 --output e.png
    morula render output --movie --panels 2       all states, as a film
    morula render output --shapes --cut           cells as polyhedra

It needs neither a display nor a graphics card; 200,000 cells take half a minute.
"""


def arguments(words):
    parser = argparse.ArgumentParser(description=DESCRIPTION,
                                     formatter_class=argparse.RawTextHelpFormatter)
    add = parser.add_argument
    add("directory", type=Path, help="output directory of a run")
    add("--field", help="column of the cells that gives the colour; default: type "
        "where\nthe run has types, else volume")
    add("--range", help="LOW,HIGH of the colours; default: the field's 1st to "
        "99th\npercentile, for pressure and stress as far on both sides of 0")
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--time", type=float, help="day; default: the last " "state written")
    which.add_argument("--all", action="store_true",
                       help="a picture of every state, FIELD-NNNN.png")
    which.add_argument("--movie", action="store_true",
                       help="a film of all states, FIELD.mp4 with Debian's package ffmpeg,\nelse "
                       "FIELD.gif; --output FILE.ogv, .gif, .mp4, .webm chooses")
    add("--fps", type=float, default=4, help="states in a second of the film")
    add("--panels", type=int, choices=(1, 2), default=1,
        help="2: outside and cut open, side by side")
    add("--cut", action="store_true", help="one panel, cut open")
    add("--shapes", action="store_true", help="cells as polyhedra, as morula shapes writes "
        "them;\n--field can be one of its fields, too")
    add("--section", action="store_true", help="with --shapes: cut through cells, not round them")
    add("--azimuth", type=float, default=-60, help="degrees from the x axis; the viewer is there")
    add("--elevation", type=float, default=14, help="degrees above the xy plane")
    add("--title", help="default: time and number of cells")
    add("--width", type=int, default=1000, help="of a panel, pixels")
    add("--output", type=Path, help="file to write; default: FIELD.png in the "
        "run's directory;\nwith --all: a directory, default the run's")
    return parser.parse_args(words)


class Request:
    """The options with what they stand for: the states to draw, numbers and
    (time, file), the limits of the colours or None, the names of the cells'
    types, the file to write, and what writes the film, if it is to be one."""

    def __init__(self, options):
        self.options = options
        if options.section and not options.shapes:
            raise Refused("--section", "on", "it with --shapes alone", "Spheres are drawn whole.")
        if not 20 <= options.width <= 20000:
            raise Refused("--width", options.width, "20 to 20000 pixels")
        if not 0 < options.fps <= 100:
            raise Refused("--fps", options.fps, "a number above 0, up to 100")
        for name in ("azimuth", "elevation"):
            if not math.isfinite(getattr(options, name)):
                raise Refused(f"--{name}", getattr(options, name), "a number of degrees")
        self.limits = limits_of(options.range)
        self.states = self._chosen(states(options.directory, "cells"))
        self.types = names_of_run(options.directory)
        if options.field is None:
            options.field = "type" if self.types else "volume"
        self.film = None
        if options.movie:
            self.path, self.film = film_writer(options.output, options.directory / options.field,
                                               options.fps)
        elif options.all:
            self.path = options.output or options.directory
            if not self.path.is_dir():
                raise Refused("--output", self.path, "a directory that exists")
        else:
            self.path = (options.output or options.directory / f"{options.field}.png")
        folder = self.path if options.all else self.path.parent
        if not folder.is_dir():
            raise Refused("--output", self.path, "a file in a directory that " "exists")

    @property
    def cut_open(self):
        """For every panel, whether it is cut open."""
        return ([False, True] if self.options.panels == 2 else [self.options.cut])

    def _chosen(self, found):
        """(number, time, file) of the states to draw."""
        numbered = [(i, *state) for i, state in enumerate(found)]
        if self.options.all or self.options.movie:
            return numbered
        time = self.options.time
        if time is None:
            return numbered[-1:]
        first, last = found[0][0], found[-1][0]
        slack = 1e-6 * max(1, abs(last))
        if not first - slack <= time <= last + slack:
            raise Refused("--time", f"{time:g}", f"a day from {first:g} to "
                          f"{last:g}, the first and the last state written")
        return [min(numbered, key=lambda state: abs(state[1] - time))]


def limits_of(text):
    if text is None:
        return None
    try:
        low, high = map(float, text.split(","))
    except ValueError:
        low = high = math.nan
    if not (low < high and math.isfinite(high - low)):
        raise Refused("--range", text, "LOW,HIGH, two numbers, the smaller " "one first")
    return low, high
