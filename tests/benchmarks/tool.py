# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Measures what Morula costs, next to what the core can do.

    contrib/upkeep/benchmark                    everything: about 20 minutes
    contrib/upkeep/benchmark kernels phases     these tables
    contrib/upkeep/benchmark --document         writes the tables of this version,
                                         doc/measured

Nothing else should run on the machine meanwhile. The yardstick for arithmetic
is the matrix product of OpenBLAS, taken from the distribution's package into
the output directory, not installed.
"""
import argparse
import subprocess
from pathlib import Path

from morula.tables import markdown
from upkeep.made import made_with
from upkeep.version_data import store

from tests.benchmarks import measure
from tests.benchmarks.runs import Bench
from tests.common.tables import aligned

ROOT = Path(__file__).resolve().parents[2]

TABLES = ("kernels", "phases", "five_days", "sizes", "spacings", "ranks",
          "rank_counts", "model", "effects", "estimates")


def fast_blas(directory):
    """A library with a fast dgemm_."""
    found = sorted(directory.rglob("libopenblas*.so*"))
    if not found:
        directory.mkdir(parents=True, exist_ok=True)
        for words in (["apt-get", "download", "libopenblas0-serial"],
                      ["sh", "-c", "dpkg -x libopenblas0-serial*.deb ."]):
            subprocess.run(words, cwd=directory, check=True,
                           stdout=subprocess.DEVNULL)
        found = sorted(directory.rglob("libopenblas*.so*"))
    return found[0]


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("tables", nargs="*", metavar="table",
                        help="of " + ", ".join(TABLES) + "; default: all")
    parser.add_argument("--document", action="store_true",
                        help="write these tables into doc/measured")
    parser.add_argument("--largest", type=int, default=1000000,
                        help="most cells in the table of sizes")
    parser.add_argument("--built", action="store_true",
                        help="take the programs in build/ as they are")
    parser.add_argument("--output", type=Path, default=ROOT / "output/benchmark",
                        help="directory for the runs")
    options = parser.parse_args()
    unknown = set(options.tables) - set(TABLES)
    if unknown:
        parser.error(f"no table '{unknown.pop()}'; there are "
                     + ", ".join(TABLES))
    options.output.mkdir(parents=True, exist_ok=True)
    if not options.built:
        for target in ("morula", "benchmark_kernels"):
            subprocess.run([ROOT / "contrib/build", target], check=True)
    runner = Bench(ROOT / "build/morula", options.output.resolve())
    program = ROOT / "build/tests/benchmark_kernels"
    wanted = options.tables or TABLES
    blas = (fast_blas(options.output.resolve() / "openblas")
            if {"kernels", "ranks"} & set(wanted) else None)
    arguments = {"kernels": (program, blas), "sizes": (runner, options.largest),
                 "ranks": (runner, program, blas)}
    for name in wanted:
        header, *rows = getattr(measure, name)(*arguments.get(name, (runner,)))
        print("\n".join([name, *aligned(header, rows), ""]), flush=True)
        if options.document:
            store("performance", {name: markdown(header, rows)},
                  made_with(ROOT), ROOT)
    return 0
