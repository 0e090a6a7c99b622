# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Compares the showcase scenes with published data.

    contrib/showcase                       all series: some hours
    contrib/showcase "WM983b, 2500 cells"  this one
    contrib/showcase --fit                 fits the equations to the data anew

Runs are kept below output/showcase and not repeated by the same build. With
--document, the tables and pictures of doc/showcase.md are written anew.
"""
import argparse
from pathlib import Path

import numpy
from morula.command_line import run_tool
from morula.kept_runs import Job, KeptRuns, job_name
from morula.program import Program
from morula.refusal import Refused
from morula.run import Run
from morula.scene import Scene

from tests.common.tables import aligned, markdown, renew

from .figure import draw
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


def wanted(names):
    known = {series.name: series for series in all_series()}
    for name in names:
        if name not in known:
            raise Refused("The series", name, "one of " + ", ".join(
                f"'{one}'" for one in known), "Without a name, all are run.")
    return [known[name] for name in names or known]


def compare(options):
    if options.fit:
        for line, (values, error) in fit().items():
            print(f"{line}: R_c, R_d, s, lambda, starts =",
                  *(f"{value:.4g}" for value in values),
                  f"rms {error:.1f} um")
        return 0
    chosen = wanted(options.series)
    scene = Scene(SCENE, Program(options.morula), options.overrides)
    jobs = [Job(job_name([("series", series.name)], keys), keys)
            for series in chosen
            for keys in [(*series.overrides(), *scene.overrides)]]
    kept = KeptRuns(scene, options.output, n_at_a_time=options.jobs,
                    resume=True)
    kept.check(jobs)
    records = kept.run(jobs)
    done = list(zip(chosen, records))
    rows = [row(*pair) for pair in done]
    print(*aligned(HEADER, rows), sep="\n")
    if options.document:
        renew(ROOT / "doc/showcase.md", {"spheroids": markdown(HEADER, rows)})
        draw(done, ROOT / "doc/images/showcase/spheroids.png")
    return 0 if all(record.finished for record in records) else 1


def parser():
    result = argparse.ArgumentParser(
        prog="showcase", description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    result.add_argument("series", nargs="*", metavar="SERIES")
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
                        help="write the page's table and pictures anew")
    return result


def main(words=None):
    return run_tool("showcase", lambda: compare(parser().parse_args(words)))
