# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""From the request to tables and figure."""
import functools
import sys

from morula.command_line import run_tool, tell
from morula.kept_runs import Job, KeptRuns, job_name

from .findings import Findings
from .options import parser
from .report import write_tables
from .request import Request

say = functools.partial(print, flush=True)


def main(words=None):
    """Exit code 0; 1 for what makes no sense; 2 if nothing could be compared."""
    def tool():
        options = parser().parse_args(words)
        options.words = sys.argv[1:] if words is None else words
        return measure(Request(options))
    return run_tool("accuracy", tool)


def measure(request):
    """Does the runs of a request and writes what they say."""
    options = request.options
    if not request.asked:
        return error_bar(request)
    kept = KeptRuns(request.scene, request.output / "runs", request.ranks, request.jobs,
                    options.again, say=say, name="accuracy")
    jobs = {(point, sample): job_of(request, point, sample)
            for point in request.plan.points for sample in request.samples}
    kept.check([jobs[point, request.samples[0]] for point in request.plan.points])
    if options.plan:
        for job in jobs.values():
            say(job.name)
        return 0
    findings = Findings(request, dict(zip(jobs, kept.run(list(jobs.values())))))
    request.results.mkdir(exist_ok=True)
    write_tables(findings, request.results)
    if not findings.estimates and not findings.scatters:
        print("accuracy: nothing to compare, as the run that all ladders share has failed: "
              "table.md says why. Choose other values for it by -s.", file=sys.stderr)
        return 2
    if findings.estimates:
        from .figure import draw
        draw(findings, request.results / "accuracy.png")
    for line in findings.summary():
        say(line)
    say(f"tables and figure in {request.results}")
    return 0


def error_bar(request):
    """The error of the scene's own run, a line a measure."""
    from .further import Further
    further = Further(request, tell)
    if request.options.plan:
        for name in further.names():
            say(name)
        return 0
    try:
        bars = further.bars()
    except RuntimeError as error:  # of the scene's own run
        print(f"accuracy: {error}", file=sys.stderr)
        return 2
    for bar in bars:
        say(bar.text())
    for note in further.notes:
        tell(f"accuracy: {note}")
    return 0


def job_of(request, point, sample):
    special = [*request.plan.overrides(point), *sample.overrides(request.keys_at(point))]
    overrides = (*request.fixed_overrides(), *special)
    kinds = {m.kind for m in request.measures} - {"statistics"}
    return Job(job_name(special, overrides), overrides, tuple(kinds))
