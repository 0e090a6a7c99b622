# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What is asked for, checked before anything is computed."""
from morula import columns
from morula.command_line import output_directory, ranks_and_jobs
from morula.kept_runs import Job, job_name, with_snapshots
from morula.ladder import (Plan, SamplesPlan, check_method, check_seeds,
                           read_ladder, read_samples, read_seeds, refuse_keys)
from morula.measures import Measure, read_measure
from morula.places import OUTPUT
from morula.program import Program
from morula.refusal import Refused
from morula.scene import Scene

# Keys that cannot be varied, and why.
NOT_VARIED = {"Random seed": "Use --seeds.", "Output directory": "Use --output."}
CHANGES = "a key that changes results"


class Request:
    """Everything asked for, and found to make sense but for what the program
    itself says of each combination."""

    def __init__(self, options):
        self.options = options
        self.ranks, self.jobs = ranks_and_jobs(options)
        program = Program(options.morula, options.mpiexec)
        self.scene = Scene(options.scene, program, options.set)
        self.seeds = read_seeds(options.seeds)
        self.plan = (SamplesPlan(self.scene, *self._samples()) if options.samples
                     else Plan(self.scene, self._ladders(), full_grid=True))
        self.told = self._told()
        self.columns = self._columns(options.columns)
        check_method(self.plan)
        check_seeds(self.plan, self.seeds, options.seeds)
        self.output = output_directory(options, OUTPUT / "sweep" / self.scene.name)

    def _told(self):
        """The columns of statistics.csv whose values at the end are told, by name: the results
        that all runs have, and what they took. Scenes of both dimensions have no units."""
        found = [columns.statistics_of({**self.scene.keys, **dict(zip(self.plan.keys, point))})
                 for point in self.plan.points]
        units = {"time": "day", **{name: unit for name, unit in found[0].items()
                                   if all(name in other for other in found)},
                 **dict.fromkeys(columns.EFFORT[2:], ""), "dt": "day", "wall_seconds": "s"}
        dimensions = self.plan.values("Dimension")
        return {name: Measure(name, "statistics", name, "mean", columns.unit_in(
            unit, int(*dimensions)) if len(dimensions) == 1 else "")
                for name, unit in units.items()}

    def _columns(self, text):
        """--columns: measures; those of the cells' and the surface's files are told, too."""
        names = dict.fromkeys(name.strip() for name in text.split(","))
        for name in names:
            if name not in self.told or name == "time":
                self.told[name] = read_measure(name, self.scene.keys, "--columns")
        return [self.told[name] for name in names]

    def _samples(self):
        if self.options.vary:
            raise Refused("--samples", self.options.samples, "nothing besides "
                          "--vary", "Leave out one of the two.")
        keys, points = read_samples(self.options.samples, self.scene)
        refuse_keys("--samples", keys, NOT_VARIED, CHANGES)
        return keys, points

    def _ladders(self):
        if not self.options.vary and not self.seeds:
            raise Refused("--vary", "", "at least one key with its values, --samples, or --seeds",
                          "For instance --vary " '"Grid/Spacing=60,40" --seeds 1-5.')
        return [read_ladder(text, self.scene, NOT_VARIED, CHANGES) for text in self.options.vary]

    def label(self, point):
        """A combination in few words."""
        return ", ".join(f"{key.split('/')[-1]} = {value}" for key, value
                         in zip(self.plan.keys, point)) or self.scene.name

    def run(self, point, seed):
        """The run of a combination and a seed (None: the scene's)."""
        special = list(zip(self.plan.keys, point))
        if seed is not None:
            special.append(("Random seed", str(seed)))
        overrides = (*self.scene.overrides, *special,
                     *with_snapshots({**self.scene.keys, **dict(special)}))
        return Job(job_name(special, overrides), overrides, ("cells", "surface", "snapshot"))
