# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs of scenes, with what they took."""
import csv
import json
import shutil
import subprocess
from dataclasses import dataclass

from morula.execute import call, command, overrides

from tests.common.program import ROOT


@dataclass
class MeasuredRun:
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


class Bench:
    """Where runs are measured, and of which program."""

    def __init__(self, morula, output, mpiexec="mpiexec"):
        self.morula, self.output, self.mpiexec = morula, output, mpiexec

    def run(self, name, scene, keys, ranks=1):
        directory, cost = self.output / name, self.output / f"{name}.cost"
        shutil.rmtree(directory, ignore_errors=True)
        directory.parent.mkdir(parents=True, exist_ok=True)
        words = command(self.morula, ROOT / scene,
                        *overrides({"Output/Interval": 0,
                                    "Output/Snapshot interval": 0, **keys,
                                    "Output directory": directory}),
                        ranks=ranks, mpiexec=self.mpiexec)
        log = self.output / f"{name}.log"
        ended = call(words, cwd=ROOT, stdout=log, stderr=subprocess.STDOUT,
                     cost=cost)
        if ended.code != 0:
            raise RuntimeError(f"{name} ended with {ended.code}: see {log}")
        with open(directory / "timings.csv") as file:
            timings = list(csv.DictReader(file))
        with open(directory / "statistics.csv") as file:
            rows = list(csv.DictReader(file))
        memory = json.loads(cost.read_text())["peak_bytes"]
        return MeasuredRun({row["section"]: float(row["wall_seconds"])
                            for row in timings},
                           {row["section"]: int(row["calls"])
                            for row in timings},
                           rows, memory if ranks == 1 else 0)
