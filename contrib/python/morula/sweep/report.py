# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The tables: Markdown to read, CSV to go on with."""
import math
import shlex

from morula.files import write, write_csv
from morula.tables import markdown as table_of


def write_tables(request, ensembles, directory):
    """table.csv, runs.csv and table.md; each replaces the old one as a whole."""
    keys = request.plan.keys
    write_csv(directory / "table.csv", [[*keys, "column", "unit", "runs", "failed", "mean",
                                         "standard_deviation", "standard_error", "smallest",
                                         "largest"], *_rows_of_ends(request, ensembles)])
    write_csv(directory / "runs.csv", [[*keys, "seed", "directory", "exit", *request.told],
                                       *_rows_of_runs(request, ensembles)])
    write(directory / "table.md", markdown(request, ensembles))


def _rows_of_ends(request, ensembles):
    for ensemble in ensembles:
        for measure in request.told.values():
            n, *numbers = ensemble.end(measure)
            yield [*ensemble.point, measure.text, measure.unit, n, len(ensemble.records)
                   - len(ensemble.runs), *(format(number, ".10g") for number in numbers)]


def _rows_of_runs(request, ensembles):
    """The last values of every run, nan if it failed."""
    for ensemble in ensembles:
        for seed, record in zip(seeds(request), ensemble.records):
            run = record.run if record.finished else None
            yield [*ensemble.point, seed, record.output.relative_to(request.output),
                   record.exit,
                   *(format(measure.evaluate(run) if run and measure.is_in(run) else math.nan,
                            ".10g") for measure in request.told.values())]


def seeds(request):
    return request.seeds or [request.scene["Random seed"]]


def markdown(request, ensembles):
    words = shlex.join(["morula", "sweep", *request.options.words])
    n_runs = sum(len(ensemble.records) for ensemble in ensembles)
    sections = [f"# Sweep of {request.scene.name}", f"    {words}",
                f"{request.scene.program.version}; {len(ensembles)} "
                f"combinations, seeds {', '.join(map(str, seeds(request)))}: "
                f"{n_runs} runs. Values at the end of each run."]
    for measure in request.columns:
        sections += [f"## {', '.join(filter(None, (measure.text, measure.unit)))}",
                     _table(request, ensembles, measure)]
    failures = list(failed_runs(request, ensembles))
    if failures:
        sections += ["## Failed", "\n".join(f"- {line}" for line in failures)]
    return "\n\n".join(sections) + "\n"


def _table(request, ensembles, measure):
    head = [*(request.plan.keys or ["scene"]), "runs", "mean",
            "standard deviation", "standard error"]
    lines = []
    for ensemble in ensembles:
        end = ensemble.end(measure)
        runs = (f"{end.n}" if end.n == len(ensemble.records)
                else f"{end.n} of {len(ensemble.records)}")
        lines.append([*(ensemble.point or [request.scene.name]), runs,
                      *map(_number, (end.mean, end.deviation, end.error))])
    return table_of(head, lines, right=4)


def _number(value):
    return f"{value:.6g}" if math.isfinite(value) else "–"


def failed_runs(request, ensembles):
    """A line for each."""
    for ensemble in ensembles:
        for seed, record in zip(seeds(request), ensemble.records):
            if not record.finished:
                yield (f"{ensemble.label}, seed {seed}: {record.summary()} "
                       f"({record.directory.relative_to(request.output)})")
