# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""From the request to tables and figures."""
import sys

import numpy
from morula.command_line import run_tool
from morula.kept_runs import Job, KeptRuns, job_name

from .estimate import center_of, estimate
from .figures import draw
from .findings import Findings
from .options import parser
from .report import write_tables
from .request import Request


def main(words=None):
    """Exit code 0; 1 for what makes no sense; 2 if nothing could be
    compared."""
    def tool():
        options = parser().parse_args(words)
        options.words = sys.argv[1:] if words is None else words
        return Accuracy(Request(options)).run()
    return run_tool("accuracy", tool)


class Accuracy:
    """The runs of a request and what they say."""

    def __init__(self, request):
        self.request = request
        self.plan = request.plan
        self.fixed = request.fixed_overrides()
        self.kept = KeptRuns(request.scene, request.output / "runs",
                             request.ranks, request.jobs, request.repeats,
                             request.options.again, say=self._say,
                             name="accuracy")
        self.records = {}  # (point, sample): Record

    def run(self):
        runs = {(point, sample): self._run_of(point, sample)
                for point in self.plan.points
                for sample in self.request.samples}
        self.kept.check([runs[point, self.request.samples[0]]
                           for point in self.plan.points])
        if self.request.options.plan:
            for run in runs.values():
                self._say(run.name)
            return 0
        self.records = dict(zip(runs, self.kept.run(list(runs.values()))))
        center = center_of(self.plan, self.request.kinds)
        estimates = self._estimates(center)
        return self._report(estimates)

    def _run_of(self, point, sample):
        special = list(self.plan.overrides(point))
        special += sample.overrides({**self.request.scene.keys,
                                     **dict(special)})
        overrides = tuple([*self.fixed, *special])
        kinds = {m.kind for m in self.request.measures} - {"statistics"}
        return Job(job_name(special, overrides), overrides, tuple(kinds))

    def _estimates(self, center):
        """One estimate for each measure and time, as far as the centre, or a
        reference file, knows what is right."""
        estimates = []
        for time in self.request.times if self.plan.ladders else []:
            for measure in self.request.measures:
                values = self._values(measure, time)
                if center in values or values and self.request.reference:
                    estimates.append(estimate(
                        self.plan, center, self.request.kinds, measure, time,
                        values, self.request.reference))
        return estimates

    def _values(self, measure, time):
        """{point: values, one a sample} of the points all of whose runs have
        finished and can be measured."""
        center = self._tissue_center()
        values = {}
        for point in self.plan.points:
            records = [record for (p, _), record in self.records.items()
                       if p == point]
            if all(record.finished for record in records):
                values[point] = numpy.array([
                    measure.evaluate(record, time, center)
                    for record in records])
        return values

    def _tissue_center(self):
        scene = self.request.scene
        numbers = [float(x) for x in scene["Tissue/Center"].split(",")]
        return numpy.array((numbers[:scene.dimension] + [0.0])[:3])

    def _report(self, estimates):
        self.request.output.mkdir(parents=True, exist_ok=True)
        findings = Findings(self.request, self.records, estimates,
                            self._tissue_center())
        write_tables(findings, self.request.output)
        if not estimates and not findings.scatters:
            print("accuracy: nothing to compare, as the run that all ladders "
                  "share has failed: table.md says why. Choose other values "
                  "for it by -s.", file=sys.stderr)
            return 2
        draw(findings, self.request.output)
        for line in findings.summary():
            print(line)
        print(f"tables and figures in {self.request.output}")
        return 0

    @staticmethod
    def _say(text):
        print(text, flush=True)
