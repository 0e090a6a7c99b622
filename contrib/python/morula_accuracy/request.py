# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What is asked for, checked before anything is computed."""
import math
from fractions import Fraction

from morula_runs.ladder import MAX_RUNS, Plan, read_ladder, read_seeds
from morula_runs.program import Program, cores
from morula_runs.refusal import Refused
from morula_runs.scene import Scene, as_number

from .front import read_wanted
from .limits import read_kinds
from .measures import read_measures
from .options import ROOT
from .reference import Reference

# Keys that cannot be a rung of a ladder, and why.
NOT_VARIED = {
    "Random seed": "Use --seeds.",
    "Output directory": "Use --output.",
    "Dimension": "Runs of two and three dimensions have no error in common.",
    "Time/End time": "Use --at: states at different times have no error in "
                     "common.",
    "Time/Stop at cells": "States at different times have no error in common.",
}


class Request:
    """Everything asked for, and found to make sense but for what the program
    itself says of each point."""

    def __init__(self, options):
        self.options = options
        self.ranks = whole_number("--ranks", options.ranks)
        self.jobs = whole_number("--jobs", options.jobs)
        self.repeats = whole_number("--repeat", options.repeat)
        if self.jobs > 1 and self.jobs * self.ranks > cores():
            raise Refused("--jobs", options.jobs, f"at most {cores()} cores "
                          f"for all runs with --ranks {self.ranks}",
                          "More would make every time meaningless.")
        program = Program(options.morula, options.mpiexec)
        self.scene = Scene(options.scene, program, options.set)
        self.seeds = read_seeds(options.seeds)
        self.measures = read_measures(options.measure, self.scene.dimension)
        self._check_surface()
        self.plan = self._plan()
        self.kinds = read_kinds(options.limit, self.scene)
        self.times = self._times()
        self.wanted = read_wanted(options.wanted, self.measures)
        self.reference = self._reference()
        self._check_seeds()
        self.output = options.output or (
            ROOT / "output/accuracy" / self.scene.name)
        if self.output.exists() and not self.output.is_dir():
            raise Refused("--output", self.output, "a directory")

    def _check_surface(self):
        for measure in self.measures:
            if measure.of_surface and self.scene["Tissue/Shape"] == "points":
                raise Refused("--measure", measure.text, "a measure of the "
                              "cells", "A tissue of the shape 'points' has no "
                              "surface.")

    @property
    def n_runs(self):
        return len(self.plan.points) * len(self.seeds or [1])

    def _plan(self):
        if not self.options.vary:
            raise Refused("--vary", "", "at least one ladder", "For instance "
                          '--vary "Grid/Spacing=100,75,50".')
        ladders = [read_ladder(text, self.scene) for text in self.options.vary]
        for ladder in ladders:
            for key in ladder.keys:
                if key in NOT_VARIED or key.startswith("Output/"):
                    raise Refused("--vary", key, "a key that changes how well "
                                  "the same state is computed",
                                  NOT_VARIED.get(key, "Output is not computed "
                                                      "here."))
        names = [ladder.name for ladder in ladders]
        if len(set(names)) < len(names):
            raise Refused("--vary", ", ".join(names),
                          "one ladder for the same keys",
                          "Put all values into one, or give them names: "
                          "\"fine: Grid/Spacing=...\".")
        return Plan(self.scene, ladders, self.options.grid)

    def _times(self):
        """When runs are compared; each run ends at the last of these times."""
        end = self.scene.number("Time/End time")
        if self.scene.number("Time/Stop at cells") > 0:
            stop = self.scene["Time/Stop at cells"]
            raise Refused("Time/Stop at cells", stop, "0 here",
                          "Runs that stop at a number of cells end at "
                          "different times: use -s \"Time/Stop at cells=0\" "
                          "and --at.")
        words = (self.options.at or format(end, ".15g")).split(",")
        times = [as_number(word) for word in words]
        if any(time is None or not 0 < time <= end for time in times):
            raise Refused("--at", self.options.at, "times above 0 and up to "
                          f"Time/End time = {end:g} day")
        if sorted(set(times)) != times:
            raise Refused("--at", self.options.at, "rising times")
        self._check_steps(times)
        return times

    def _check_steps(self, times):
        """Runs end at the last time exactly; before it, steps must."""
        keys = self.plan.keys
        at = keys.index("Time/Step") if "Time/Step" in keys else None
        steps = {self.scene["Time/Step"] if at is None else point[at]
                 for point in self.plan.points}
        for step in filter(as_number, steps):
            if at is not None and float(step) > times[-1] * (1 + 1e-9):
                raise Refused("--vary", f"Time/Step={step}", "a step up to "
                              f"the end, {times[-1]:g} day", "Longer ones are "
                              "all the same run.")
            for time in times[:-1]:
                ratio = time / float(step)
                if abs(ratio - round(ratio)) > 1e-9 * max(1.0, ratio):
                    raise Refused("--at", self.options.at, "multiples of "
                                  "every Time/Step (and any last time)",
                                  f"Day {time:g} is no end of a step of "
                                  f"{step}.")

    def _reference(self):
        if self.options.reference is None:
            if self.options.reference_column:
                raise Refused("--reference-column",
                              self.options.reference_column[0],
                              "something with --reference only")
            return None
        reference = Reference(self.options.reference,
                              self.options.reference_column)
        reference.check(self.measures, self.times)
        return reference

    def _check_seeds(self):
        if self.n_runs > MAX_RUNS:
            raise Refused("--vary", f"{self.n_runs} runs",
                          f"at most {MAX_RUNS} runs")
        if self.seeds and len(self.seeds) > 1 and not self.random:
            raise Refused("--seeds", self.options.seeds, "one seed for a scene "
                          "in which nothing is random",
                          "Its Proliferation/Law is none.")

    @property
    def random(self):
        keys = self.plan.keys
        laws = {self.scene["Proliferation/Law"]}
        if "Proliferation/Law" in keys:
            at = keys.index("Proliferation/Law")
            laws = {point[at] for point in self.plan.points}
        return laws != {"none"}

    def fixed_overrides(self):
        """What all runs have besides their point: end, output, -s."""
        result = list(self.scene.overrides)
        if self.options.at:
            result.append(("Time/End time", format(self.times[-1], ".15g")))
        files = any(m.kind != "statistics" for m in self.measures)
        return [*result, ("Output/Formats", "csv" if files else "none"),
                ("Output/Interval", output_interval(self.times)),
                ("Output/Snapshot interval", "0")]


def output_interval(times):
    """The longest interval of outputs that meets all times; the last one is
    always written."""
    if len(times) == 1:
        return "0"
    exact = [Fraction(time).limit_denominator(10**6) for time in times]
    denominator = math.lcm(*(f.denominator for f in exact))
    numerator = math.gcd(*(int(f * denominator) for f in exact))
    return format(numerator / denominator, ".15g")


def whole_number(option, text):
    try:
        number = int(text)
    except ValueError:
        number = 0
    if number < 1:
        raise Refused(option, text, "an integer >= 1")
    return number
