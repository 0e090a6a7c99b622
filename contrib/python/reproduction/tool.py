# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Regenerates the figures of Yokoyama, Kameo & Adachi (2023).

    contrib/reproduce                 everything
    contrib/reproduce fig-2 fig-4b    some panels; a figure is all its panels
    contrib/reproduce --list          which panels there are

Builds Morula, runs the scenes in prm/paper that the panels need (finished runs
are kept, stopped ones go on), draws every panel and writes table.md: the
numbers that the paper states beside ours.
"""
import argparse
import os
import shutil
import subprocess
import sys
from pathlib import Path

from morula.command_line import like_ctrl_c
from morula.draw.screen import require_virtual_screen, run_on_virtual_screen
from reproduction import catalogue
from upkeep.made import made_with
from upkeep.version_data import store

ROOT = Path(__file__).resolve().parents[3]


def arguments():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("panels", nargs="*", metavar="PANEL",
                        help="fig-1d, fig-2a, ... or fig-2, videos, ...")
    parser.add_argument("--list", action="store_true",
                        help="list the panels and stop")
    parser.add_argument("--output", type=Path, metavar="DIR",
                        default=ROOT / "output/paper",
                        help="for runs, pictures and table.md; default: "
                        "output/paper")
    parser.add_argument("--jobs", type=int, metavar="N",
                        default=min(2, os.cpu_count() or 1),
                        help="runs at a time, each on one core; default: "
                        "2, or 1 if there is one core")
    parser.add_argument("-s", dest="overrides", action="append", default=[],
                        metavar="KEY=VALUE",
                        help="override a key in every run, as for morula:\n"
                        '-s "Tissue/Cell spacing=50" -s "Grid/Spacing=100" '
                        "is a quick trial")
    parser.add_argument("--no-videos", action="store_true",
                        help="leave out the videos")
    parser.add_argument("--document", action="store_true",
                        help="write the numbers into doc/measured, the "
                        "figures into\ndoc/images/paper")
    parser.add_argument("--fresh", action="store_true",
                        help="run again what has been run already")
    parser.add_argument("--morula", type=Path, metavar="FILE",
                        help="an executable to use; default: build one")
    options = parser.parse_args()
    if options.jobs < 1:
        parser.error(f"--jobs {options.jobs}: at least 1 is needed")
    try:
        options.panels = catalogue.select(options.panels)
    except catalogue.UnknownPanel as error:
        parser.error(f"there is no panel '{error}'; known are\n"
                     + catalogue.listing())
    if options.no_videos:
        options.panels = [panel for panel in options.panels
                          if not panel.startswith("video")]
    options.output = options.output.resolve()
    return options


def executable(options):
    """The program, built if none is given."""
    if options.morula:
        if not os.access(options.morula, os.X_OK):
            sys.exit(f"reproduce: {options.morula} cannot be executed; give "
                     "--morula an executable, or leave it out to build one.")
        return options.morula.resolve()
    if subprocess.call([ROOT / "contrib/build", "morula"]) != 0:
        sys.exit("reproduce: Morula could not be built.")
    return ROOT / "build/morula"


def say(text):
    print(text, flush=True)


def run_needed(options, morula):
    """Runs what the panels need; the scenes that failed. What drawing lacks
    shows before the runs, not after them."""
    require_virtual_screen()
    import reproduction.draw
    import reproduction.table  # noqa: F401
    from reproduction.runner import run_scenes
    scenes = catalogue.scenes_of(options.panels)
    say(f"reproduce: {len(scenes)} scene(s), {options.jobs} at a time, in "
        f"{options.output}")
    return run_scenes(scenes, options, morula, ROOT / "prm/paper", say)


def draw(options, panels):
    """Draws the panels in a process with a screen; its exit code."""
    if not panels:
        return 0
    return run_on_virtual_screen([
        sys.executable, "-P", "-m", "reproduction.draw", str(options.output),
        *panels])


def document(options, morula):
    """Stores the numbers of this version and its figures."""
    found = (options.output / "table.md").read_text(encoding="utf-8")
    store("reproduction", {"numbers": found[found.index("## Numbers"):]},
          made_with(ROOT, morula), ROOT)
    for figure in options.output.glob("fig-[1234]*.png"):
        if (ROOT / "doc/images/paper" / figure.name).is_file():
            shutil.copy(figure, ROOT / "doc/images/paper")


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
    morula = executable(options)
    options.output.mkdir(parents=True, exist_ok=True)
    failed = run_needed(options, morula)
    panels = [panel for panel in options.panels
              if not set(catalogue.PANELS[panel][0]) & set(failed)]
    from reproduction.table import write_table
    write_table(options.output)
    say(f"reproduce: {options.output / 'table.md'}")
    code = draw(options, panels)
    if options.document and not failed:
        document(options, morula)
    left = [panel for panel in options.panels if panel not in panels]
    if failed:
        say(f"reproduce: FAILED: the runs {', '.join(failed)}; therefore not "
            f"drawn: {', '.join(left)}")
    return 1 if failed or code else 0
