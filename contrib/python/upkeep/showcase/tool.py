# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Compares the showcase scenes with published data.

    contrib/upkeep/showcase                       all runs: more than an hour
    contrib/upkeep/showcase "WM983b, 2500 cells"  this one
    contrib/upkeep/showcase pressure              all that begin so
    contrib/upkeep/showcase --fit                 fits the equations to the data anew

Runs are kept below output/showcase and not repeated by the same build. With
--document, the tables of this version (doc/measured) and the pictures of
doc/showcase.md are written anew.
"""
import argparse
from dataclasses import dataclass
from pathlib import Path

import numpy
from morula.command_line import run_tool
from morula.kept_runs import Job, KeptRuns, job_name
from morula.program import Program
from morula.refusal import Refused
from morula.run import Run
from morula.scene import Scene
from morula.tables import markdown

from upkeep.made import made_with
from upkeep.version_data import store

from tests.common.tables import aligned

from . import cortex, cut, figure, organoid, plate, pressure
from .spheroids import ROOT, SCENE, all_series, fit, radii_of_run

HEADER = ["series", "from the data, µm", "Greenspan's from the data, µm",
          "R from Greenspan's", "R_n from Greenspan's", "to day", "cells",
          "minutes"]


def row(series, record):
    """How far a run is from the data, and from the equations: there, the largest
    difference on any day after the first, as a part of their R."""
    times, radii = radii_of_run(record.output)
    exact = series.greenspan(times + series.days[0])
    there = numpy.isin(times + series.days[0], series.days)
    data = numpy.isin(series.days, times + series.days[0])
    off = abs(radii - exact)[:, times > 0] / exact[0, times > 0]
    n = Run(record.output).statistics["cells"].iloc[-1]
    return [series.name, f"{rms(radii[:, there] - series.radii[:, data]):.1f}",
            f"{rms((series.greenspan() - series.radii)[:, data]):.1f}",
            f"{100 * off[0].max():.1f} %", f"{100 * off[1].max():.1f} %",
            f"{times[-1] + series.days[0]:g}",
            f"{n:,.0f}", f"{record.process_seconds / 60:.0f}"]


def rms(differences):
    return numpy.sqrt(numpy.mean(differences**2))


@dataclass(frozen=True)
class Subject:
    """A scene, its runs, and what the page shows of them: a table and a picture
    of this name."""

    name: str
    scene: Path
    cases: object  # () -> what is run: each has a name and overrides()
    header: list
    row: object  # (case, record of its run) -> cells of the table
    draw: object  # (pairs of them, path)


SUBJECTS = (
    Subject("spheroids", SCENE, all_series, HEADER, row, figure.draw),
    Subject("pressure", pressure.SCENE, pressure.all_cases, pressure.HEADER,
            pressure.row, pressure.draw),
    Subject("growth-plate", plate.SCENE, plate.all_cases, plate.HEADER,
            plate.row, plate.draw),
    Subject("organoid", organoid.SCENE, organoid.all_cases, organoid.HEADER,
            organoid.row, organoid.draw),
    Subject("cut", cut.SCENE, cut.all_cases, cut.HEADER, cut.row, cut.draw),
    Subject("cortex", cortex.SCENE, cortex.all_cases, cortex.HEADER,
            cortex.row, cortex.draw))


def wanted(names):
    """Cases of each subject, by the beginnings of their names."""
    cases = {subject.name: subject.cases() for subject in SUBJECTS}
    for name in names:
        if not any(case.name.startswith(name)
                   for some in cases.values() for case in some):
            raise Refused("The run", name, "the beginning of " + ", ".join(
                f"'{case.name}'" for some in cases.values() for case in some),
                "Without a name, all are run.")
    return {subject: [case for case in some if not names or
                      any(case.name.startswith(name) for name in names)]
            for subject, some in cases.items()}


def compare(options):
    if options.fit:
        for line, (values, error) in fit().items():
            print(f"{line}: R_c, R_d, s, lambda, starts =",
                  *(f"{value:.4g}" for value in values),
                  f"rms {error:.1f} um")
        return 0
    chosen = wanted(options.runs)
    finished = [run(subject, chosen[subject.name], options)
                for subject in SUBJECTS if chosen[subject.name]]
    return 0 if all(finished) else 1


def run(subject, chosen, options):
    """Whether all runs have come to their end."""
    scene = Scene(subject.scene, Program(options.morula), options.overrides)
    jobs = [Job(job_name([("series", case.name)], keys), keys)
            for case in chosen
            for keys in [(*case.overrides(), *scene.overrides)]]
    kept = KeptRuns(scene, options.output, n_at_a_time=options.jobs,
                    resume=True)
    kept.check(jobs)
    records = kept.run(jobs)
    done = list(zip(chosen, records))
    rows = [subject.row(*pair) for pair in done]
    print(*aligned(subject.header, rows), sep="\n")
    if options.document:
        store("showcase", {subject.name: markdown(subject.header, rows)},
              made_with(ROOT, options.morula), ROOT)
        subject.draw(done, ROOT / f"doc/images/showcase/{subject.name}.png")
    return all(record.finished for record in records)


def parser():
    result = argparse.ArgumentParser(
        prog="showcase", description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    result.add_argument("runs", nargs="*", metavar="RUN")
    result.add_argument("--fit", action="store_true",
                        help="only fit the equations to the data")
    result.add_argument("--morula", default=ROOT / "build/morula",
                        help="the program, default build/morula")
    result.add_argument("--output", type=Path,
                        default=ROOT / "output/showcase",
                        help="directory of the runs")
    result.add_argument("--jobs", type=int, default=1,
                        help="how many runs at a time")
    result.add_argument("-s", dest="overrides", action="append", default=[],
                        metavar="KEY=VALUE", help="another value of a key")
    result.add_argument("--document", action="store_true",
                        help="write tables and pictures of this version")
    return result


def main(words=None):
    return run_tool("showcase", lambda: compare(parser().parse_args(words)))
