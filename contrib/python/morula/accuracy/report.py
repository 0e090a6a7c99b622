# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The tables: Markdown to read, CSV to go on with."""
import math
import shlex

from morula.columns import pretty
from morula.files import write, write_csv
from morula.tables import markdown as table_of

from .limits import ROUNDING


def write_tables(findings, directory):
    """table.md; with ladders table.csv, with offsets offsets.csv."""
    write(directory / "table.md", markdown(findings))
    if findings.plan.ladders:
        write_csv(directory / "table.csv", rows_of_errors(findings))
    if findings.scatters:
        write_csv(directory / "offsets.csv", rows_of_runs(findings))


def markdown(findings):
    request = findings.request
    sections = [f"# Accuracy of {request.scene.name}",
                f"    {shlex.join(['morula', 'accuracy', *request.options.words])}", how(request)]
    if findings.scatters:
        sections += [f"## Scatter at day {request.end:g}", scatter_table(findings)]
    if findings.estimates:
        sections += [f"## Runs at day {request.end:g}", run_table(findings, findings.estimates),
                     "## Each ladder alone", ladder_table(findings, findings.estimates)]
    text = "\n".join(f"- {line}" for line in findings.warnings())
    sections += ["## Warnings", text] if text else []
    return "\n\n".join(sections) + "\n"


def how(request):
    return (f"{request.scene.program.version}; --ranks {request.ranks} --jobs "
            f"{request.jobs}"
            + (f"; means over {len(request.samples)} runs that differ by "
               f"{request.sampled}" if request.sampled else "") + ".")


def table(head, rows):
    return table_of(head, rows, right=len(head) - 1)


def run_table(findings, estimates):
    """All runs: what they cost, and their errors; in the order of the ladders."""
    head = ["run", "processor time, s", "unknowns", "memory, MB", "error in time, own estimate",
            *(f"{e.measure.text}, error" for e in estimates)]
    rows = []
    for point in findings.plan.points:
        cost = findings.cost(point)
        rows.append([findings.plan.label(point)] + (
            [f"{cost.seconds:.3g}", f"{cost.unknowns:.0f}", f"{cost.memory:.0f}",
             f"{digits(100 * cost.in_time, False)} %",
             *(error_cell(findings, e, point) for e in estimates)]
            if cost else ["failed"] + ["–"] * (len(head) - 2)))
    rows.append(["**right value**", "", "", "", "",
                 *(f"{e.right:.6g} ± {e.uncertainty:.1g} "
                   f"{pretty(e.measure.unit)}" for e in estimates)])
    return table(head, rows) + (
        "\n\n● no run is both faster and better; "
        "in brackets: not distinguishable from zero; ± two standard errors.")


def error_cell(findings, estimate, point):
    error = estimate.errors[point]
    text = shown(estimate, error, estimate.noise[point])
    if abs(error) <= estimate.floor:
        text = f"({text})"
    return text + " ●" * (point in findings.front(estimate))


def scale_of(found):
    """The unit in which differences of an Estimate or a Scatter are told, and the
    factor to it: lengths in um, everything else in per cent of its base."""
    if found.measure.unit != "um" and abs(found.base) > ROUNDING:
        return "%", 100 / abs(found.base)
    return pretty(found.measure.unit), 1.0


def shown(found, number, uncertainty=0.0, sign=True):
    """A difference of an Estimate or a Scatter."""
    unit, factor = scale_of(found)
    text, uncertain = digits(factor * number, sign), digits(factor * uncertainty, False)
    return f"{text}{'' if uncertain == '0' else f' ± {uncertain}'} {unit}".strip()


def digits(number, sign):
    """Two digits, with a true minus; zero for what is nothing here."""
    if not math.isfinite(number):
        return "–"
    plus = "+" if sign else ""
    text = f"{number:{plus}.2g}" if abs(number) < 100 else f"{number:{plus}.0f}"
    return "0" if abs(number) < 1e-6 else text.replace("e-0", "e-").replace(
        "-", "−", text[0] == "-")


def scatter_table(findings):
    """Mean, extremes and standard deviation of every measure; with a reference
    file also the errors, from the least to the largest."""
    head = ["run", "measure", "runs", "mean", "smallest", "largest", "standard deviation"]
    if findings.request.reference:
        head += ["error of the mean", "errors, from", "to"]
    rows = []
    for s in findings.scatters:
        numbers = (s.values.mean(), s.values.min(), s.values.max())
        rows.append([
            findings.plan.label(s.point), s.measure.text, f"{len(s.values)}"
            + (f", {s.n_failed} failed" if s.n_failed else ""),
            *(f"{number:.6g} {pretty(s.measure.unit)}".strip() for number in numbers),
            shown(s, s.deviation, sign=False),
            *(shown(s, number - s.right) for number in numbers
              if s.right is not None)])
    return table(head, rows)


def ladder_table(findings, estimates):
    """By how much the centre's values would change if one ladder alone went
    to its limit; the sum; and what a reference file says instead."""
    first = estimates[0]
    if not first.parts:
        return "The run that all ladders share has failed."
    cells = {
        f"{part.ladder.name}, from "
        + findings.plan.rung_label(part.ladder, first.center):
        lambda e, i=i: part_cell(e, e.parts[i]) for i, part in enumerate(first.parts)}
    cells["**all that count**"] = lambda e: (
        shown(e, *e.sum_of_parts) if any(part.used for part in e.parts) else "–")
    if first.from_file:
        cells["the reference file"] = lambda e: shown(e, -e.errors[e.center], e.uncertainty)
    if findings.request.sampled:
        cells[f"scatter between {findings.request.sampled} (standard deviation)"] = (
            lambda e: shown(e, e.scatter[e.center], sign=False))
    return table(["ladder", *(f"{e.measure.text}, change" for e in estimates)],
                 [[name, *map(cell, estimates)] for name, cell in cells.items()]
                 ) + "\n\nIn square brackets: does not count."


def part_cell(estimate, part):
    if part.limit is None:
        return f"spread {shown(estimate, part.spread, sign=False)}"
    text = ", ".join(filter(None, [shown(estimate, part.change, part.uncertainty),
                                   part.limit.note]))
    return text if part.used else f"[{text}]"


def rows_of_errors(findings):
    """A row for each run and quantity, with all digits."""
    yield [*findings.plan.keys, "measure", "unit", "value", "seed_scatter", "right_value",
           "right_value_uncertainty", "error", "error_noise", "on_front",
           "processor_seconds", "unknowns", "memory_mb"]
    for e in findings.estimates:
        front = findings.front(e)
        for point in e.values:
            cost = findings.cost(point)
            yield [*point, e.measure.text, e.measure.unit, *map(tens, (
                e.values[point], e.scatter[point], e.right, e.uncertainty,
                e.errors[point], e.noise[point], int(point in front), *cost[:3]))]


def rows_of_runs(findings):
    """A row for every run, time and measure."""
    axes = "xyz"[:findings.request.scene.dimension]
    yield [*findings.plan.keys, "seed", *(f"moved_{a}" for a in axes),
           "measure", "unit", "value", "right_value"]
    for s in findings.scatters:
        for sample, value in zip(s.samples, s.values):
            yield [*s.point, "" if sample.seed is None else sample.seed,
                   *map(tens, sample.moved), s.measure.text,
                   s.measure.unit, *map(tens, (value, s.right))]


def tens(number):
    """Ten digits; nothing for what is not known."""
    return "" if number is None else format(number, ".10g")
