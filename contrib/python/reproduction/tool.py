# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Regenerates the figures of Yokoyama, Kameo & Adachi (2023).

    contrib/reproduce                 everything
    contrib/reproduce fig-2 fig-4b    some panels; a figure is all its panels
    contrib/reproduce --list          which panels there are

Builds Morula, runs the scenes in prm/paper that the panels need (finished runs
are kept, stopped ones go on), draws every panel, and prints and writes table.md:
the numbers that the paper states beside ours.
"""
import argparse
import os
import shutil
import subprocess
import sys
from pathlib import Path

from morula.command_line import like_ctrl_c, tell
from morula.draw.screen import require_virtual_screen, virtual_screen
from reproduction import catalogue

ROOT = Path(__file__).resolve().parents[3]
IMAGES = ROOT / "doc/images/paper"


def arguments():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawTextHelpFormatter)
    add = parser.add_argument
    add("panels", nargs="*", metavar="PANEL", help="fig-1d, fig-2a, ... or fig-2, videos, ...")
    add("--list", action="store_true", help="list the panels and stop")
    add("--output", type=Path, metavar="DIR", default=ROOT / "output/paper",
        help="for runs, pictures and table.md; default: output/paper")
    add("--jobs", type=int, metavar="N", default=min(2, os.cpu_count() or 1),
        help="runs at a time, each on one core; default: 2, or 1 if there is one core")
    add("-s", dest="overrides", action="append", default=[], metavar="KEY=VALUE",
        help='override a key in every run, as for morula:\n-s "Tissue/Cell spacing=50" '
        '-s "Grid/Spacing=100" is a quick trial')
    add("--no-videos", action="store_true", help="leave out the videos")
    add("--document", action="store_true", help="copy the figures into doc/images/paper")
    add("--fresh", action="store_true", help="run again what has been run already")
    add("--morula", type=Path, metavar="FILE", help="an executable to use; default: build one")
    options = parser.parse_args()
    if options.jobs < 1:
        parser.error(f"--jobs {options.jobs}: at least 1 is needed")
    try:
        options.panels = catalogue.select(options.panels)
    except LookupError as error:
        parser.error(f"there is no panel '{error}'; known are\n" + catalogue.listing())
    if options.no_videos:
        options.panels = [panel for panel in options.panels if not panel.startswith("video")]
    options.output = options.output.resolve()
    return options


def executable(options):
    """The program, built if none is given."""
    if not options.morula:
        if subprocess.call([ROOT / "contrib/build", "morula"]) != 0:
            sys.exit("reproduce: Morula could not be built.")
        return ROOT / "build/morula"
    if not os.access(options.morula, os.X_OK):
        sys.exit(f"reproduce: {options.morula} cannot be executed.")
    return options.morula.resolve()


def main():
    options = arguments()
    if options.list:
        print(catalogue.listing())
        return 0
    try:
        with like_ctrl_c():
            return reproduce(options)
    except KeyboardInterrupt:
        sys.exit("reproduce: stopped; the same command goes on.")


def reproduce(options):
    # What drawing lacks shows before the runs, not after them.
    require_virtual_screen()
    from reproduction import panels  # noqa: F401
    from reproduction.runner import run_scenes
    from reproduction.table import write_table
    morula = executable(options)
    options.output.mkdir(parents=True, exist_ok=True)
    scenes = catalogue.scenes_of(options.panels)
    tell(f"reproduce: {len(scenes)} scene(s), {options.jobs} at a time, in {options.output}")
    failed = run_scenes(scenes, options, morula, ROOT / "prm/paper")
    print(write_table(options.output), flush=True)
    left = [panel for panel in options.panels if set(catalogue.PANELS[panel][0]) & set(failed)]
    with virtual_screen():
        code = subprocess.call([
            ROOT / "contrib/python/launch", "-P", "-m", "reproduction.draw", str(options.output),
            *(panel for panel in options.panels if panel not in left)])
    if failed:
        tell(f"reproduce: FAILED: the runs {', '.join(failed)}; therefore not drawn: "
             + ", ".join(left))
    elif options.document:
        for picture in IMAGES.glob("*.png"):
            shutil.copy(options.output / picture.name, picture)
    return 1 if failed or code else 0
