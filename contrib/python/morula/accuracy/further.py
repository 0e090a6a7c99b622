# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The runs that an error bar is made of: the scene's own, in its own directory, and at most 16
further ones, coarser in space or in time."""
import json
import math

from morula.api.scene import Scene
from morula.files import write
from morula.kept_runs import Job, KeptRuns, job_name
from morula.places import OUTPUT
from morula.refusal import Refused
from morula.run import ERRORS

from .bar import Bar, bias, duration, scatter
from .offsets import Sample, fractions

KEYS = {"grid": "Grid/Spacing", "cells": "Tissue/Cell spacing", "step": "Time/Step"}
TOLERANCE = "Time/Tolerance"
COARSER, LONGER = (1.25, 1.5), (2.0, 4.0)
N_POSITIONS, N_SEEDS = 4, 5
ROUGH = 1e-6  # VTU files have single precision
COUNTS = ("cells", "dividing", "held", "close")  # numbers of cells begin with these words


class Further:
    """The runs by (part, ratio or number), in an order in which some say how to do the rest."""

    def __init__(self, request, say):
        self.request, self.scene, self.say = request, request.scene, say
        self.kept = KeptRuns(request.scene, request.output / "runs", request.ranks, request.jobs,
                             again=request.options.again, say=say, name="accuracy")
        self.records, self.notes = {}, []

    def bars(self):
        """A Bar for each measure, kept in errors.json of the scene's own run."""
        own = self._own()
        values = {m: dict.fromkeys([(part, 1.0) for part in KEYS], m.evaluate(own))
                  for m in self.request.measures}
        for measure, found in values.items():
            if not math.isfinite(found["grid", 1.0]):
                raise Refused("--measure", measure.text, "one that is a number at the end")
        coarser = self._coarser()
        self.biased = dict.fromkeys(part for part, _ in coarser)
        self._run(coarser, values)
        longer = self._longest(name for name, record in self.records.items() if record.finished)
        self._run({**self._moved(longer), **self._seeded(longer, 1)}, values)
        self.random = any(not math.isclose(*(found.get(("chance", i), math.nan) for i in (0, 1)),
                                           rel_tol=ROUGH) for found in values.values())
        if self.random:
            self._run(self._seeded(longer, N_SEEDS - 1), values)
        bars = [self._bar(measure, found, own) for measure, found in values.items()]
        keep(own, bars)
        done = {record.directory: record for record in self.records.values() if record.cost}
        seconds = sum(record.process_seconds for record in done.values())
        self.notes.append(f"{len(done)} further runs of {duration(seconds)} in all; "
                          f"errors are kept in {own.directory / ERRORS}")
        return bars

    def names(self):
        """What bars() runs, if nothing fails and something is random."""
        coarser = self._coarser()
        longer = self._longest(coarser)
        wanted = {**coarser, **self._moved(longer), **self._seeded(longer, N_SEEDS - 1)}
        return dict.fromkeys(self._job(special).name for special in wanted.values() if special)

    def _own(self):
        """The scene's own run; done, if it is not there."""
        options = self.request.options
        scene = Scene(options.scene, morula=options.morula).with_keys(dict(self.scene.overrides))
        scene.program = self.scene.program
        return scene.run(scene["Output directory"] or OUTPUT / self.scene.name,
                         ranks=self.request.ranks)

    def _times(self, part, ratio):
        """The key of a part's size, so many times as large; with the step also Time/Tolerance,
        as what a step misses falls with its square."""
        factors = {KEYS[part]: ratio} | ({TOLERANCE: ratio**2} if part == "step" else {})
        return tuple((key, format(factor * self.scene.number(key), ".12g"))
                     for key, factor in factors.items() if self.scene.number(key))

    def _coarser(self):
        """The runs that tell the biases. A single step cannot be longer."""
        end = self.scene.number("Time/End time") * (1 + 1e-9)
        longer = [r for r in LONGER if r * self.scene.number("Time/Step") <= end]
        found = {"grid": COARSER, "step": longer or [0.5], "cells": COARSER}
        if (self.scene["Tissue/Shape"] == "points" or self.scene["Proliferation/Law"] != "none"):
            self.notes.append("cells: not varied, as another size of cells is another tissue")
            del found["cells"]
        return {(part, r): self._times(part, r) for part, ratios in found.items() for r in ratios}

    def _longest(self, names):
        """The override of the longest step among runs."""
        ratio = max((r for part, r in names if part == "step"), default=1.0)
        return self._times("step", ratio) if ratio > 1 else ()

    def _job(self, special):
        """The run that has this besides the scene."""
        overrides = (*self.request.fixed_overrides(), *special)
        return Job(job_name(special, overrides), overrides)

    def _moved(self, longer):
        """The run with another place of the grid, from its own on."""
        return {("position", i): (*longer, *Sample(None, place).overrides(self.scene.keys))
                for i, place in enumerate(fractions(N_POSITIONS, self.scene.dimension))}

    def _seeded(self, longer, number):
        """The run with another seed, from its own on."""
        own = int(self.scene["Random seed"])
        return {("chance", i): (*longer, *Sample(own + i if i else None).overrides({}))
                for i in range(number + 1)}

    def _run(self, wanted, values):
        """Does runs, given by what they have besides the scene, and measures them."""
        jobs = {name: self._job(special) for name, special in wanted.items() if special}
        for found in values.values():  # the scene itself
            found.update((name, found["grid", 1.0]) for name in wanted if name not in jobs)
        allowed = set(self.kept.check(list(dict.fromkeys(jobs.values())), skip=True))
        jobs = {name: job for name, job in jobs.items() if job in allowed}
        unique = list(dict.fromkeys(jobs.values()))
        records = dict(zip(unique, self.kept.run(unique)))
        for name, job in jobs.items():
            self.records[name] = records[job]
            if records[job].finished:
                for measure, found in values.items():
                    value = measure.evaluate(records[job].run)
                    found.update({name: value} if math.isfinite(value) else {})
            else:
                self.notes.append(f"{name[0]}: left out a run, which {records[job].summary()}: "
                                  f"{job.name}")

    def _bar(self, measure, found, own):
        """The Bar of a measure, from its value in each run."""
        parts, orders, noise = {}, {}, 0.0
        for part in ["chance"] * self.random + ["position"]:
            there = [value for (name, _), value in found.items() if name == part]
            deviation, parts[part] = scatter(there) if len(there) > 1 else (0.0, None)
            noise = math.hypot(noise, 2 * math.sqrt(2) * deviation)  # of a difference
        for part in self.biased:
            there = {ratio: value for (name, ratio), value in found.items() if name == part}
            parts[part], orders[part] = bias(there, noise) if len(there) > 1 else (None, 1.0)
        if measure.text.split("_")[0] in COUNTS:
            parts.pop("cells", None)
        sizes = {part: self.scene.number(key) for part, key in KEYS.items()}
        return Bar(measure, found["grid", 1.0], parts, orders, seconds_of(own), sizes,
                   {part: self._power(part, seconds_of(own)) for part in KEYS})

    def _power(self, part, seconds):
        """The power of a size with which the wall time falls: from 1 to the dimension, as times
        on a busy machine say little."""
        there = {r: record for (name, r), record in self.records.items()
                 if name == part and record.finished}
        if part == "step" or not there:
            return 1.0 if part == "step" else float(self.scene.dimension)
        ratio = max(there)
        power = math.log(seconds / seconds_of(there[ratio].run)) / math.log(ratio)
        return min(max(1.0, power), self.scene.dimension)


def seconds_of(run):
    return float(run.statistics["wall_seconds"].iloc[-1])


def keep(run, bars):
    """Adds the measures to those that are kept with a run."""
    kept = {} if run.errors.empty else json.loads((run.directory / ERRORS).read_text())["errors"]
    kept.update((bar.measure.text, bar.record()) for bar in bars)
    write(run.directory / ERRORS, json.dumps({"of": run.digest, "errors": kept}, indent=1))
