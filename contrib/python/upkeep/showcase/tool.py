# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Compares the showcase scenes with published data: prints tables, and draws the
pictures of doc/images/showcase.

    contrib/upkeep/showcase               all of them: some hours
    contrib/upkeep/showcase cut organoid  these

Runs that are finished below output/showcase are not repeated.
"""
from morula import Scene
from morula.run import Run
from morula.style import RC, plt
from morula.tables import markdown

from upkeep import ROOT, parser

from . import cortex, cut, organoid, plate, pressure, spheroids

SUBJECTS = {"spheroids": spheroids, "pressure": pressure, "growth-plate": plate,
            "organoid": organoid, "cut": cut, "cortex": cortex}


def run_of(subject, case, again):
    scene = Scene(subject.SCENE, morula=ROOT / "build/morula").with_keys(case.keys)
    directory = ROOT / "output/showcase" / case.name.replace(", ", "-").replace(" ", "-")
    return Run(scene.run(directory, progress=False, again=again).directory)


def main():
    tool = parser(__doc__)
    tool.add_argument("names", nargs="*", metavar="NAME", help=", ".join(SUBJECTS))
    tool.add_argument("--again", action="store_true", help="repeat finished runs")
    options = tool.parse_args()
    if not set(options.names) <= set(SUBJECTS):
        tool.error(f"the scenes are {', '.join(SUBJECTS)}")
    plt.rcParams.update(RC)
    for name in options.names or SUBJECTS:
        subject = SUBJECTS[name]
        pairs = [(case, run_of(subject, case, options.again)) for case in subject.cases()]
        rows = [[*subject.row(case, run), f"{run.statistics['wall_seconds'].iloc[-1] / 60:.1f}"]
                for case, run in pairs]
        print(f"### Published data: {name}\n\n{markdown(subject.HEADER, rows)}\n", flush=True)
        subject.draw(pairs).savefig(ROOT / f"doc/images/showcase/{name}.png")
