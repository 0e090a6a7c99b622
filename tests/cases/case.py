# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What a case is: trials, each a run of a scene, and findings, the figures that
they must have.

A case's module stands in tests/hard/cases or tests/verification/cases and
defines CASE. What every trial must do anyhow is checked by engine.py: see
tests/README.md.
"""
from dataclasses import dataclass, field

from tests.cases import rows_of_trials
from tests.common.tables import with_powers


@dataclass(frozen=True)
class Trial:
    """A run of a scene.

    name: unique in the case; also the directory of the run.
    scene: a file of prm/hard, or prm/verification, as the case is of one or the
        other. keys: differences from it; "{files}" in a value
        stands for the directory of the files.
    quick: further differences unless the full size is asked for. Trials with
        full_only are not run then.
    files: name -> text, or a function that returns it: inputs of this trial
        that are not worth a file beside the scene (meshes, points).
    ranks: numbers of ranks; the first one's run is judged, the others must
        have the same cells to `agreement` µm.
    exit: the exit code, or several that are allowed.
    message: regular expression found in what the program prints if it ends
        with 1 or 2.
    resume_keys: differences for resuming a run that has ended with 2.
    row: trials with the same row share a row of the table.
    timeout: seconds after which a run counts as hanging.
    """

    name: str
    scene: str
    keys: dict = field(default_factory=dict)
    quick: dict = field(default_factory=dict)
    full_only: bool = False
    files: dict = field(default_factory=dict)
    ranks: tuple = (1,)
    agreement: float = 1e-3
    exit: object = 0
    message: str = None
    resume_keys: dict = field(default_factory=dict)
    row: str = None
    timeout: float = 3600.0

    def __post_init__(self):
        codes = self.exit if isinstance(self.exit, tuple) else (self.exit,)
        object.__setattr__(self, "exit", codes)
        if not set(codes) <= {0, 1, 2}:
            raise ValueError(f"trial {self.name}: exit {codes}")
        if set(codes) != {0} and not self.message:
            raise ValueError(f"trial {self.name} may fail: what must the "
                             "message say?")

    def all_keys(self, full, files):
        """The differences from the scene; files: the directory of the files."""
        keys = {"Output/Formats": "csv", **self.keys,
                **({} if full else self.quick)}
        return {key: str(value).replace("{files}", str(files))
                for key, value in keys.items()}


@dataclass
class Finding:
    """A figure, and the limits that it must keep.

    at_most, at_least, equals = (value, tolerance): at least one of them.
    error: shown in the column "error" of the row of a trial (its name or its
    row's; default: all rows).
    says: the sentence in which the page states the limit; see Limit.
    """

    text: str
    value: float
    at_most: float = None
    at_least: float = None
    equals: tuple = None
    error: bool = False
    trial: str = None
    says: str = None

    def __post_init__(self):
        self.value = float(self.value)
        if self.at_most is self.at_least is self.equals is None:
            raise ValueError(f"the finding '{self.text}' asserts nothing")

    def holds(self):
        """NaN never does."""
        within = self.value == self.value
        if self.at_most is not None:
            within = within and self.value <= self.at_most
        if self.at_least is not None:
            within = within and self.value >= self.at_least
        if self.equals is not None:
            right, tolerance = self.equals
            within = within and abs(self.value - right) <= tolerance
        return within

    def limits(self):
        words = []
        if self.at_least is not None:
            words.append(f"at least {self.at_least:.6g}")
        if self.at_most is not None:
            words.append(f"at most {self.at_most:.6g}")
        if self.equals is not None:
            words.append("{:.6g} ± {:.2g}".format(*self.equals))
        return ", ".join(words)


@dataclass(frozen=True)
class Limit:
    """A limit that a page states: the sentence is written by the case, and the
    case must find a figure that keeps it whenever it is judged.

    says: with the places {at_most:g}, {at_least:g}, {right:g}, {tolerance:g}.
    """

    says: str
    at_most: float = None
    at_least: float = None
    equals: tuple = None

    def sentence(self):
        right, tolerance = self.equals or (None, None)
        return with_powers(self.says.format(
            at_most=self.at_most, at_least=self.at_least, right=right,
            tolerance=tolerance))

    def found(self, text, value, **more):
        """The Finding of a figure that must keep this limit."""
        return Finding(text, value, self.at_most, self.at_least, self.equals,
                       says=self.sentence(), **more)


@dataclass
class Figures:
    """What a run took. condition: the largest estimate of a step, None if the
    scene does not ask for it."""

    steps: int
    newton: float  # iterations a step
    tangents: float  # a step; an iteration may go on with the last one
    linear: float  # iterations a Newton iteration
    condition: float
    rejected: int
    smallest_J: float  # of J_e, any cell, any step


@dataclass
class TrialRun:
    """A trial that has been run. results: Results (tests/scenes/checks), None
    after exit code 1, as the figures are. resumed: exit code of --resume after
    exit code 2, otherwise None."""

    trial: Trial
    exit: int
    text: str
    results: object
    figures: Figures
    resumed: int = None


@dataclass(frozen=True)
class Case:
    """Trials, and what is found in them.

    measure(runs) -> what judge and report work with; runs: trial name ->
        TrialRun, of the trials that were run, full_only ones only at full size.
        Default: the runs themselves.
    judge(measured) yields the Findings.
    limits: those that the page states (a list of sentences), each with
        sentence(), which at least one finding says.
    report: the module that shows what was measured, by lines(measured, findings)
        and markdown(measured, findings, full).
    """

    title: str
    trials: list
    judge: object
    limits: tuple = ()
    measure: object = dict
    report: object = rows_of_trials

    def sentences(self):
        """What the case asserts, for its page."""
        return [limit.sentence() for limit in self.limits]

    def unfounded(self, findings):
        """The sentences that no finding stands for."""
        founded = {finding.says for finding in findings}
        return [text for text in self.sentences() if text not in founded]

    def __post_init__(self):
        names = [trial.name for trial in self.trials]
        if len(set(names)) < len(names):
            raise ValueError(f"'{self.title}' has two trials of one name")

    def wanted(self, full):
        return [trial for trial in self.trials if full or not trial.full_only]
