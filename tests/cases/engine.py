# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Checks that every trial must pass, whatever its case is about."""
import re

import numpy

from tests.common.results import positions, read_csv
from tests.cases.case import Figures

NOT_A_NUMBER = re.compile(r"(^|,)\s*[-+]?(nan|inf)", re.IGNORECASE)
TIME = r"[Aa]t t = [-+.0-9e]+ day"


def numbers_missing(directory):
    """The first NaN or infinity of each CSV file, as sentences."""
    found = []
    for file in sorted(directory.glob("*.csv")):
        lines = file.read_text().splitlines()
        for number, line in enumerate(lines[1:], 2):
            if NOT_A_NUMBER.search(line):
                found.append(f"{file.name}:{number} is not finite: {line}")
                break
    return found


def wrong_end(trial, code, text, directory):
    """What is wrong with how the program has ended, as sentences."""
    found = []
    if code not in trial.exit:
        expected = " or ".join(map(str, trial.exit))
        found.append(f"exit code {code}, expected {expected}")
    if code in (1, 2) and trial.message and not re.search(trial.message, text):
        found.append(f"the message lacks '{trial.message}'")
    if code == 1 and directory.exists():
        found.append("bad input, but an output directory was made")
    if code == 2:
        if not re.search(TIME, text):
            found.append("the message does not say at what time")
        if "--resume" not in text:
            found.append("the message does not say how to resume")
        if not (directory / "snapshot.h5").is_file():
            found.append("there is no snapshot")
    return found


def wrong_resume(code, text, before, after):
    """What is wrong with a run resumed after exit code 2: it must have gone on
    from the state that was saved; before and after: of statistics.csv."""
    found = []
    if code not in (0, 2):
        found.append(f"--resume ends with exit code {code}")
    if code == 2 and not re.search(TIME, text):
        found.append("resumed, the message does not say at what time")
    if after[:len(before)] != before:
        found.append("--resume has not gone on from the rows that were there")
    return found


def different_cells(one, other, agreement):
    """How the last cells of two runs differ, as sentences."""
    if not one.outputs("cells") or not other.outputs("cells"):
        return []
    a, b = one.last_cells(), other.last_cells()
    if len(a) != len(b) or any((a[name] != b[name]).any()
                               for name in ("id", "parent", "phase")):
        return ["other cells (ids, parents or phases)"]
    distance = numpy.linalg.norm(positions(a) - positions(b), axis=1).max()
    if not distance <= agreement:
        return [f"cells {distance:.3g} µm apart, at most {agreement:g} is "
                "allowed"]
    return []


def n_tangents(directory):
    """How many tangents a run has assembled."""
    timings = directory / "timings.csv"
    lines = timings.read_text().splitlines() if timings.is_file() else []
    return sum(int(line.split(",")[1]) for line in lines
               if line.startswith("tangent,"))


def figures(results):
    rows = results.statistics()
    newton = rows["newton_iterations"].sum()
    condition = None
    if (results.directory / "condition.csv").is_file():
        estimates = read_csv(results.directory / "condition.csv")["condition"]
        condition = float(estimates.max()) if estimates.size else None
    steps = int(rows["step"].max())
    return Figures(steps=steps, newton=newton / max(steps, 1),
                   tangents=n_tangents(results.directory) / max(steps, 1),
                   linear=rows["linear_iterations"].sum() / max(newton, 1),
                   condition=condition,
                   rejected=int(rows["rejected_steps"].sum()),
                   smallest_J=float(rows["min_elastic_volume_ratio"].min()))
