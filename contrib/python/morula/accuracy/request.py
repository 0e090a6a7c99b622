# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What is asked for, checked before anything is computed."""
import math
from fractions import Fraction

from morula.command_line import output_directory, ranks_and_jobs, whole_number
from morula.ladder import (Plan, check_method, check_seeds, read_ladder,
                           read_seeds)
from morula.places import OUTPUT
from morula.program import Program
from morula.refusal import Refused
from morula.scene import Scene, as_number

from .front import read_wanted
from .limits import read_kinds
from .measures import read_measures
from .offsets import read_offsets, samples
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
        self.ranks, self.jobs = ranks_and_jobs(options)
        self.repeats = whole_number("--repeat", options.repeat)
        program = Program(options.morula, options.mpiexec)
        self.scene = Scene(options.scene, program, options.set)
        self.seeds = read_seeds(options.seeds)
        self.measures = read_measures(options.measure, self.scene.keys)
        self._check_surface()
        self.plan = self._plan()
        check_method(self.plan)
        self.n_offsets = read_offsets(options.offsets, self.plan)
        self.samples = samples(self.seeds, self.n_offsets,
                               self.scene.dimension)
        self.kinds = read_kinds(options.limit, self.scene)
        self.times = self._times()
        self.wanted = read_wanted(options.wanted, self.measures)
        self.reference = self._reference()
        check_seeds(self.plan, self.seeds, options.seeds, len(self.samples))
        self.output = output_directory(
            options, OUTPUT / "accuracy" / self.scene.name)

    def _check_surface(self):
        for measure in self.measures:
            if measure.of_surface and not self._has_surface():
                raise Refused("--measure", measure.text, "a measure of the "
                              "cells", "The tissue has no surface, as 'Tissue/"
                              "Points surface' does not ask for one.")

    def _has_surface(self):
        """As source/scene/seeded_tissue.cc decides."""
        keys = self.scene.keys
        choice = keys["Tissue/Points surface"]
        # The tension acts everywhere if it is there.
        tension = "Boundary conditions/Surface tension"
        held_or_loaded = keys[tension] != "0" or keys["Obstacles/Names"] or any(
            value for key, value in keys.items()
            if key.startswith("Boundary conditions/")
            and key.endswith(" where") and key != tension + " where")
        return (keys["Tissue/Shape"] != "points" or choice == "always"
                or (choice == "automatic" and held_or_loaded))

    @property
    def sampled(self):
        """What the runs of a point differ by, in words; empty if there is one
        run a point."""
        words = ["seeds"] if len(self.seeds or []) > 1 else []
        return " and ".join(words + (["offsets"] if self.n_offsets else []))

    def _plan(self):
        if not self.options.vary and self.options.offsets:
            for option in ("grid", "wanted", "limit"):
                if getattr(self.options, option):
                    raise Refused(f"--{option}", "", "--vary as well",
                                  "Without a ladder no error is estimated.")
            return Plan(self.scene, [])
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
        varied = "Time/Step" in self.plan.keys
        for step in filter(as_number, self.plan.values("Time/Step")):
            if varied and float(step) > times[-1] * (1 + 1e-9):
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
