# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What is asked for, checked before anything is computed."""
import math
from fractions import Fraction

from morula.command_line import output_directory, ranks_and_jobs, whole_number
from morula.kept_runs import job_name
from morula.ladder import Plan, check_method, check_seeds, read_ladder, read_seeds
from morula.measures import read_measures
from morula.places import OUTPUT
from morula.program import Program
from morula.refusal import Refused
from morula.scene import Scene, as_number

from .offsets import read_offsets, samples
from .reference import Reference
from .wanted import read_wanted

# Keys that cannot be a rung of a ladder, and why.
APART = "Such states have no error in common"
NOT_VARIED = {"Random seed": "Use --seeds.", "Output directory": "Use --output.",
              "Dimension": f"{APART}.", "Time/End time": f"{APART}: use --at.",
              "Time/Stop at cells": f"{APART}."}


class Request:
    """Everything asked for; only the program itself judges each point."""

    def __init__(self, options):
        self.options = options
        self.ranks, self.jobs = ranks_and_jobs(options)
        self.repeats = whole_number("--repeat", options.repeat)
        program = Program(options.morula, options.mpiexec)
        self.scene = Scene(options.scene, program, options.set)
        self.seeds = read_seeds(options.seeds)
        self.measures = read_measures(options.measure, self.scene.keys)
        of_surface = [m.text for m in self.measures if m.of_surface]
        if of_surface and not self.scene.explained["boundary points"]:
            raise Refused("--measure", of_surface[0], "a measure of the cells",
                          "The tissue has no surface (Tissue/Points surface).")
        self.plan = self._plan()
        check_method(self.plan)
        self.n_offsets = read_offsets(options.offsets, self.plan)
        self.samples = samples(self.seeds, self.n_offsets, self.scene.dimension)
        self.times = self._times()
        self.wanted = read_wanted(options.wanted, self.measures)
        if options.reference_column and options.reference is None:
            raise Refused("--reference-column", options.reference_column[0],
                          "something with --reference only")
        self.reference = options.reference and Reference(
            options.reference, options.reference_column)
        if self.reference:
            self.reference.check(self.measures, self.times)
        check_seeds(self.plan, self.seeds, options.seeds, len(self.samples))
        self.output = output_directory(options, OUTPUT / "accuracy" / self.scene.name)

    @property
    def asked(self):
        """Whether ladders or offsets were: else it is the error bar."""
        return bool(self.options.vary or self.options.offsets)

    @property
    def results(self):
        """Where tables and figure go: each command has a directory of its own."""
        asked = [("", text) for text in self.options.vary]
        asked += [("offsets", str(self.n_offsets))] * bool(self.n_offsets)
        words = [word for word in self.options.words if word != "--again"]
        return self.output / job_name(asked, tuple(words))

    @property
    def sampled(self):
        """What the runs of a point differ by, in words; empty for one run."""
        return " and ".join(["seeds"] * (len(self.seeds or []) > 1)
                            + ["offsets"] * bool(self.n_offsets))

    def _plan(self):
        options = self.options
        for name in ("wanted", "at", "seeds", "reference"):
            if getattr(options, name) and not (options.vary or self.asked and name != "wanted"):
                raise Refused(f"--{name}", getattr(options, name), "something with a ladder only",
                              "For instance " '--vary "Grid/Spacing=100,75,50".')
        ladders = [read_ladder(text, self.scene, NOT_VARIED, "a key that changes how well the same "
                               "state is computed") for text in options.vary]
        names = [ladder.name for ladder in ladders]
        if len(set(names)) < len(names):
            raise Refused("--vary", ", ".join(names), "one ladder for the same keys",
                          'Or give them names: "fine: Grid/Spacing=...".')
        return Plan(self.scene, ladders)

    def _times(self):
        """When runs are compared; each run ends at the last of these times."""
        end = self.scene.number("Time/End time")
        if self.scene.number("Time/Stop at cells") > 0:
            raise Refused("Time/Stop at cells", self.scene["Time/Stop at cells"],
                          "0 here", "Such runs end at different times: use -s "
                          "\"Time/Stop at cells=0\" and --at.")
        words = (self.options.at or format(end, ".15g")).split(",")
        times = [as_number(word) for word in words]
        if (any(time is None or not 0 < time <= end for time in times)
                or sorted(set(times)) != times):
            raise Refused("--at", self.options.at, "rising times above 0 and up to "
                          f"Time/End time = {end:g} day")
        for step in map(as_number, self.plan.values("Time/Step")):
            self._check_step(step, times)
        return times

    def _check_step(self, step, times):
        """Runs end at the last time exactly; before it, steps must."""
        if not step:
            return
        if "Time/Step" in self.plan.keys and step > times[-1] * (1 + 1e-9):
            raise Refused("--vary", f"Time/Step={step:g}", "a step up to the end, "
                          f"{times[-1]:g} day", "Longer ones are all the same run.")
        for time in times[:-1]:
            ratio = time / step
            if abs(ratio - round(ratio)) > 1e-9 * max(1.0, ratio):
                raise Refused("--at", self.options.at, "multiples of every Time/Step (and any last "
                              "time)", f"Day {time:g} is no end of a step of {step:g}.")

    def keys_at(self, point):
        """All keys of a point."""
        return {**self.scene.keys, **dict(self.plan.overrides(point))}

    def fixed_overrides(self):
        """What all runs have besides their point: end, output, -s."""
        result = list(self.scene.overrides)
        if self.options.at:
            result.append(("Time/End time", format(self.times[-1], ".15g")))
        files = not self.asked or any(m.kind != "statistics" for m in self.measures)
        return [*result, ("Output/Formats", "csv" if files else "none"),
                ("Output/Interval", output_interval(self.times)),
                ("Output/Snapshot interval", "0")]


def output_interval(times):
    """The longest interval of outputs that meets all times; the last one is always written."""
    if len(times) == 1:
        return "0"
    exact = [Fraction(time).limit_denominator(10**6) for time in times]
    denominator = math.lcm(*(f.denominator for f in exact))
    numerator = math.gcd(*(int(f * denominator) for f in exact))
    return format(numerator / denominator, ".15g")
