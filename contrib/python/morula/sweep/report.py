# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The tables: Markdown to read, CSV to go on with."""
import math
import shlex

from morula.columns import unit_in
from morula.files import write, write_csv
from morula.tables import markdown as table_of


def write_tables(request, ensembles, directory):
    """table.csv, runs.csv and table.md; each replaces the old one as a whole."""
    keys = request.plan.keys
    write_csv(directory / "table.csv", [[*keys, "column", "unit", "runs", "failed", "mean",
                                         "standard_deviation", "standard_error", "smallest",
                                         "largest"], *_rows_of_ends(request, ensembles)])
    write_csv(directory / "runs.csv", [[*keys, "seed", "directory", "exit", *request.all_columns],
                                       *_rows_of_runs(request, ensembles)])
    write(directory / "table.md", markdown(request, ensembles))


def _rows_of_ends(request, ensembles):
    for ensemble in ensembles:
        for column in request.all_columns:
            n, *numbers = ensemble.end(column)
            yield [*ensemble.point, column, unit(request, column), n, len(ensemble.records)
                   - len(ensemble.tables), *(format(number, ".10g") for number in numbers)]


def _rows_of_runs(request, ensembles):
    """The last row of statistics.csv of every run, nan if it failed."""
    for ensemble in ensembles:
        for seed, record in zip(seeds(request), ensemble.records):
            table = record.run.statistics if record.finished else {}
            yield [*ensemble.point, seed, record.output.relative_to(request.output),
                   record.repeats[-1]["exit"], *(format(table[column].iloc[-1] if column in table
                                                        else math.nan, ".10g") for column
                                                 in request.all_columns)]


def seeds(request):
    return request.seeds or [request.scene["Random seed"]]


def unit(request, column):
    """Empty for numbers, and for scenes of which some are two-dimensional."""
    known = {"time": "day", "dt": "day", "wall_seconds": "s", **request.results}
    dimensions = request.plan.values("Dimension")
    if len(dimensions) > 1:
        return ""
    return unit_in(known.get(column, ""), int(*dimensions))


def markdown(request, ensembles):
    words = shlex.join(["contrib/sweep", *request.options.words])
    n_runs = sum(len(ensemble.records) for ensemble in ensembles)
    sections = [f"# Sweep of {request.scene.name}", f"    {words}",
                f"{request.scene.program.version}; {len(ensembles)} "
                f"combinations, seeds {', '.join(map(str, seeds(request)))}: "
                f"{n_runs} runs. Values at the end of each run."]
    for column in request.columns:
        sections += [f"## {', '.join(filter(None, (column, unit(request, column))))}",
                     _table(request, ensembles, column)]
    failures = list(failed_runs(request, ensembles))
    if failures:
        sections += ["## Failed", "\n".join(f"- {line}" for line in failures)]
    return "\n\n".join(sections) + "\n"


def _table(request, ensembles, column):
    head = [*(request.plan.keys or ["scene"]), "runs", "mean",
            "standard deviation", "standard error"]
    lines = []
    for ensemble in ensembles:
        end = ensemble.end(column)
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
