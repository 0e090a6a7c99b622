# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs of scenes, with what they took."""
import csv
import os
import shutil
import subprocess
from dataclasses import dataclass

from tests.common.processes import ENVIRONMENT, ROOT, overrides


@dataclass
class Run:
    """sections: wall time (s) and calls by section of timings.csv. memory: of
    the largest process, bytes; 0 where MPI's launcher hides it."""

    sections: dict
    calls: dict
    rows: list
    memory: int

    def time(self, *names):
        return sum(self.sections.get(name, 0.0) for name in names)

    def total(self, column):
        return sum(float(row[column]) for row in self.rows)

    def cell_steps(self):
        """Cells at the end of each step, summed."""
        return sum(int(row["cells"]) for row in self.rows[1:])


def environment():
    return {**ENVIRONMENT, **os.environ}


class Runner:
    def __init__(self, morula, output, mpiexec="mpiexec"):
        self.morula, self.output, self.mpiexec = morula, output, mpiexec

    def run(self, name, scene, keys, ranks=1):
        directory = self.output / name
        shutil.rmtree(directory, ignore_errors=True)
        directory.parent.mkdir(parents=True, exist_ok=True)
        words = [self.morula, ROOT / scene,
                 *overrides({"Output/Interval": 0,
                             "Output/Snapshot interval": 0, **keys,
                             "Output directory": directory})]
        if ranks > 1:
            words = [self.mpiexec, "-n", ranks, *words]
        with open(self.output / f"{name}.log", "w") as log:
            process = subprocess.Popen([str(word) for word in words], cwd=ROOT,
                                       env=environment(), stdout=log,
                                       stderr=subprocess.STDOUT)
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            raise RuntimeError(f"{name} ended with {process.returncode}: see "
                               f"{self.output / name}.log")
        with open(directory / "timings.csv") as file:
            timings = list(csv.DictReader(file))
        with open(directory / "statistics.csv") as file:
            rows = list(csv.DictReader(file))
        return Run({row["section"]: float(row["wall_seconds"])
                    for row in timings},
                   {row["section"]: int(row["calls"]) for row in timings},
                   rows, usage.ru_maxrss * 1024 if ranks == 1 else 0)
