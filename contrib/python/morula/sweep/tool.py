# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""From the request to tables and the picture."""
import sys

from morula.command_line import run_tool, tell
from morula.kept_runs import KeptRuns

from morula.refusal import Refused

from .ensemble import Ensemble
from .figure import draw
from .options import parser
from .report import failed_runs, write_tables
from .request import Request


def main(words=None):
    """Exit code 0; 1 for what makes no sense; 2 if a run failed."""
    def tool():
        options = parser().parse_args(words)
        tell(f"sweep: asking the program about {options.scene} ...")
        options.words = sys.argv[1:] if words is None else words
        return sweep(Request(options))
    return run_tool("sweep", tool)


def sweep(request):
    """Checks all combinations, does the runs, writes what they say."""
    seeds = request.seeds or [None]
    points = request.plan.points
    runs = [request.run(point, seed) for point in points for seed in seeds]
    kept = KeptRuns(request.scene, request.output / "runs", request.ranks, request.jobs,
                    again=request.options.again, resume=True, say=_say, name="sweep")
    allowed = set(kept.check(runs[::len(seeds)], request.options.skip_refused))
    points = [point for point, run in zip(points, runs[::len(seeds)]) if run in allowed]
    runs = [request.run(point, seed) for point in points for seed in seeds]
    if not runs:
        raise Refused("--skip-refused", "all combinations", "some that Morula " "accepts")
    if request.options.plan:
        for run in runs:
            _say(run.name)
        return 0
    records = kept.run(runs)
    n = len(seeds)
    ensembles = [Ensemble(point, request.label(point), records[i * n:(i + 1) * n]) for i, point
                 in enumerate(points)]
    write_tables(request, ensembles, request.output)
    failures = list(failed_runs(request, ensembles))
    for line in failures:
        print(f"sweep: {line}", file=sys.stderr)
    if len(failures) < len(records):
        _say("drawing sweep.png ...")
        draw(request, ensembles, request.output / "sweep.png")
    _say(f"{len(records) - len(failures)} of {len(records)} runs finished; "
         f"tables and figure in {request.output}")
    return 2 if failures else 0


def _say(text):
    print(text, flush=True)
