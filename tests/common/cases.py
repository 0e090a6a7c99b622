# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Hard cases and verification: runs of scenes of prm/, and figures with limits."""
import math
import re
import shutil
from dataclasses import dataclass

import numpy
from morula.execute import overrides
from morula.run import Run
from morula.tables import markdown

from tests.common import forks
from tests.common.program import ROOT, Runs
from tests.common.results import Results, positions, read_csv

NOT_A_NUMBER = re.compile(r"(^|,)\s*[-+]?(nan|inf)", re.IGNORECASE | re.MULTILINE)
TIME = r"[Aa]t t = ([-+.0-9e]+) day"
FAILED = "the step failed even at"


class Table:
    """Rows of a case, in parts, each a dictionary of texts by column."""

    def __init__(self):
        self.parts = {}

    def add(self, part, row):
        self.parts.setdefault(part, []).append(row)

    def markdown(self):
        texts = []
        for rows in self.parts.values():
            header = list(dict.fromkeys(name for row in rows for name in row))
            texts.append(markdown(header, [[row.get(name, "") for name in header]
                                           for row in rows]))
        return "\n\n".join(texts) + "\n"


@dataclass
class Trial:
    """A run that has been done: its exit code, what it said, what it has written
    (nothing after exit code 1)."""

    code: int
    text: str
    results: Results

    @property
    def rows(self):
        return self.results.statistics()

    def last(self, column):
        return self.rows[column][-1]

    def condition(self):
        """The largest estimate of a step."""
        return read_csv(self.results.directory / "condition.csv")["condition"].max()

    def figures(self):
        """What the run took: numbers by column of the table."""
        rows = self.rows
        newton, steps = rows["newton_iterations"].sum(), max(rows["step"].max(), 1)
        tangents = Run(self.results.directory).timings["calls"].get("tangent", 0)
        return {"steps": rows["step"].max(), "Newton/step": newton / steps,
                "tangents/step": tangents / steps,
                "linear/Newton": rows["linear_iterations"].sum() / max(newton, 1),
                "rejected": rows["rejected_steps"].sum(),
                "smallest J_e": rows["min_elastic_volume_ratio"].min()}


def assert_finite(directory):
    for file in sorted(directory.glob("*.csv")):
        wrong = NOT_A_NUMBER.search(file.read_text().partition("\n")[2])
        assert not wrong, f"{file}: {wrong[0]}"


def span(values):
    """One value, or the smallest and the largest, as text."""
    low, high = f"{min(values):.3g}", f"{max(values):.3g}"
    return low if low == high else f"{low} … {high}"


class Case(Runs):
    """Runs of the scenes of prm/KIND, each with what must be true of every run;
    `full`: all trials at their full size, not those of contrib/check."""

    def __init__(self, options, module, table):
        super().__init__(options, module)
        self.full = options.ring == "release"
        self.scenes = ROOT / "prm" / module.split(".")[1]
        self.table, self.trials = table, {}

    def trial(self, name, scene, keys=(), files=(), ranks=(1,), agreement=1e-3,
              exits=(0,), message=FAILED, resume_keys=(), row=None):
        """Runs a scene with these keys, in which "{files}" stands for the directory
        of the files (their texts by name), on the first number of ranks, at full
        length on all: they must have the same cells, to `agreement` um. The exit code
        is one of `exits`, with a message that matches. Trials of one row are one row
        of the table."""
        folder = self.work / f"{name}.files"
        for file, text in dict(files).items():
            folder.mkdir(parents=True, exist_ok=True)
            (folder / file).write_text(text)
        keys = {key: str(value).replace("{files}", str(folder)) for key, value in
                {"Output/Formats": "csv", **dict(keys)}.items()}
        first, *others = [
            self._on_ranks(self.scenes / scene, keys, self.work / f"{name}-on-{n}", n,
                           exits, message, dict(resume_keys))
            for n in (ranks if self.full else ranks[:1])]
        for other in others:
            if first.code == other.code == 0:
                assert_same_cells(first.results, other.results, agreement)
        self.trials.setdefault(row or name, []).append(first)
        return first

    def _on_ranks(self, scene, keys, output, ranks, exits, message, resume_keys):
        def start(output, more, *words):
            keys_now = {**keys, **more, "Output directory": output}
            return forks.call(self.command(scene, *overrides(keys_now), *words,
                                           ranks=ranks), cwd=ROOT)

        output.parent.mkdir(parents=True, exist_ok=True)
        ended = start(output, {})
        said = f"exit code {ended.code} of {output.name}:\n{ended.text[-3000:]}"
        assert ended.code in exits, said
        if ended.code != 0:
            assert re.search(message, ended.text), said
        if ended.code == 1:
            assert not output.exists(), "bad input, but an output directory was made"
            return Trial(1, ended.text, None)
        assert_finite(output)
        if ended.code == 2:
            assert re.search(TIME, ended.text) and "--resume" in ended.text, said
            copy = output.with_name(output.name + "-resumed")
            shutil.copytree(output, copy)
            again = start(copy, resume_keys, "--resume")
            assert again.code in (0, 2), again.text
            assert again.code == 0 or re.search(TIME, again.text), again.text
            # It has gone on from the state that was saved.
            before, after = ((folder / "statistics.csv").read_text()
                             for folder in (output, copy))
            assert after.startswith(before)
            assert_finite(copy)
        return Trial(ended.code, ended.text, Results(output))

    def found(self, text, value, at_most=math.inf, at_least=-math.inf, equals=None):
        """A figure, which must keep these limits; `equals`: a value and a tolerance."""
        if equals:
            at_least, at_most = equals[0] - equals[1], equals[0] + equals[1]
        limits = ", ".join(f"{word} {limit:.6g}" for word, limit in (
            ("at least", at_least), ("at most", at_most)) if math.isfinite(limit))
        assert limits, f"the figure '{text}' has no limit"
        holds = at_least <= value <= at_most
        used = (value / (at_most or 1) if math.isinf(at_least) else
                at_least / (value or 1) if math.isinf(at_most) else
                abs(2 * value - at_least - at_most) / (at_most - at_least or 1))
        self.table.add("figures", {"figure": text, "value": f"{value:.4g}", "limits": limits + (
            "" if holds else " **not met**"), "of the limit": f"{used:.3g}"})
        assert holds, f"{text}: {value:.6g} is not {limits}"

    def finish(self):
        """A row of the table for the trials that share one."""
        for label, trials in self.trials.items():
            codes = [trial.code for trial in trials]
            row = {"trial": label, "outcome": ", ".join(
                f"{codes.count(code)} exit {code}" for code in sorted(set(codes)))}
            figures = [trial.figures() for trial in trials if trial.results]
            for name in figures[0] if figures else ():
                row[name] = span([of_trial[name] for of_trial in figures])
            self.table.add("trials", row)


def assert_same_cells(one, other, agreement):
    if not one.outputs("cells"):
        return
    a, b = one.last_cells(), other.last_cells()
    for name in ("id", "parent", "phase"):
        assert numpy.array_equal(a[name], b[name]), f"other cells: {name}"
    distance = numpy.linalg.norm(positions(a) - positions(b), axis=1).max()
    assert distance <= agreement, f"cells {distance:.3g} um apart"
