# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What is asked for, checked before anything is computed."""
from morula.command_line import output_directory, ranks_and_jobs
from morula.kept_runs import job_name
from morula.ladder import Plan, check_method, check_seeds, read_ladder, read_seeds
from morula.measures import read_measures
from morula.places import OUTPUT
from morula.program import Program
from morula.refusal import Refused
from morula.scene import Scene

from .offsets import read_offsets, samples
from .reference import Reference

# Keys that cannot be a rung of a ladder, and why.
APART = "Such states have no error in common"
NOT_VARIED = {"Random seed": "Use --seeds.", "Output directory": "Use --output.",
              "Dimension": f"{APART}.", "Time/End time": f"{APART}: -s sets it.",
              "Time/Stop at cells": f"{APART}."}


class Request:
    """Everything asked for; only the program itself judges each point."""

    def __init__(self, options):
        self.options = options
        self.ranks, self.jobs = ranks_and_jobs(options)
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
        self.end = self._end()
        self.reference = options.reference and Reference(options.reference)
        if self.reference:
            self.reference.check(self.measures, self.end)
        check_seeds(self.plan, self.seeds, options.seeds, len(self.samples))
        self.output = output_directory(options, OUTPUT / "accuracy" / self.scene.name)

    @property
    def asked(self):
        """Whether ladders or offsets were: else it is the error bar."""
        return bool(self.options.vary or self.options.offsets)

    @property
    def results(self):
        """Where tables and figure go: each command has a directory of its own."""
        asked = [("vary", text) for text in self.options.vary]
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
        for name in ("seeds", "reference"):
            if getattr(options, name) and not self.asked:
                raise Refused(f"--{name}", getattr(options, name), "something with a ladder or "
                              '--offsets', 'For instance --vary "Grid/Spacing=100,75,50".')
        ladders = [read_ladder(text, self.scene, NOT_VARIED, "a key that changes how well the same "
                               "state is computed") for text in options.vary]
        names = [ladder.name for ladder in ladders]
        if len(set(names)) < len(names):
            raise Refused("--vary", ", ".join(names), "one ladder for the same keys",
                          'Or give them names: "fine: Grid/Spacing=...".')
        return Plan(self.scene, ladders)

    def _end(self):
        """The day on which runs are compared, that of their end."""
        end = self.scene.number("Time/End time")
        if self.scene.number("Time/Stop at cells") > 0:
            raise Refused("Time/Stop at cells", self.scene["Time/Stop at cells"], "0 here", "Such runs "
                          'end at different times: use -s "Time/Stop at cells=0" and an End time.')
        return end

    def keys_at(self, point):
        """All keys of a point."""
        return {**self.scene.keys, **dict(self.plan.overrides(point))}

    def fixed_overrides(self):
        """What all runs have besides their point: output, -s."""
        files = not self.asked or any(m.kind != "statistics" for m in self.measures)
        return [*self.scene.overrides, ("Output/Formats", "csv" if files else "none"),
                ("Output/Interval", "0"), ("Output/Snapshot interval", "0")]
