# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The tables: Markdown to read, CSV to go on with."""
import math
import shlex

from morula.files import write, write_csv
from morula.tables import markdown as table_of

from .limits import NOTES, ROUNDING
from .scatter import write_offsets


def write_tables(findings, directory):
    write(directory / "table.md", markdown(findings))
    if findings.request.n_offsets:
        write_offsets(findings, directory)
    if not findings.plan.ladders:
        (directory / "table.csv").unlink(missing_ok=True)  # of before
        return
    write_csv(directory / "table.csv", rows_of_csv(findings))


def markdown(findings):
    sections = [f"# Accuracy of {findings.request.scene.name}", how(findings)]
    for time in findings.request.times:
        there = [s for s in findings.scatters if s.time == time]
        if there:
            sections += [f"## Scatter at day {time:g}",
                         scatter_table(findings, there)]
        estimates = [e for e in findings.estimates if e.time == time]
        if estimates:
            title = f" at day {time:g}"
            sections += [f"## Runs{title}", run_table(findings, estimates),
                         f"## Each ladder alone{title}",
                         ladder_table(findings, estimates)]
    verdicts = [findings.verdict(e) for e in findings.estimates]
    verdicts = [line for line in verdicts if line]
    if verdicts:
        sections += ["## Least time for the wanted error", bullets(verdicts)]
    if findings.warnings():
        sections += ["## Mind", bullets(findings.warnings())]
    return "\n\n".join(sections) + "\n"


def how(findings):
    request = findings.request
    words = ["contrib/accuracy", *request.options.words]
    seeds = f", means over {len(request.seeds)} seeds" if request.seeds else ""
    if request.n_offsets:
        seeds += (f"{' and' if seeds else ', means over'} {request.n_offsets} "
                  "positions of the grid")
    times = (f"; shortest of {request.repeats}" if request.repeats > 1 else "")
    return (f"    {shlex.join(words)}\n\n"
            f"{request.scene.program.version}; {request.ranks} rank"
            f"{'s' if request.ranks > 1 else ''}, {request.jobs} run"
            f"{'s' if request.jobs > 1 else ''} at a time{times}{seeds}.")


def bullets(lines):
    return "\n".join(f"- {line}" for line in lines)


def table(head, rows):
    return table_of(head, rows, right=len(head) - 1)


def run_table(findings, estimates):
    """All runs: what they cost, and their errors; in the order of the
    ladders."""
    head = ["run", "wall time, s", "unknowns", "memory, MB"]
    costs = findings.costs[estimates[0].time]
    says = any(math.isfinite(cost.in_time) for cost in costs.values())
    if says:
        head.append("error in time, own estimate")
    head += [f"{e.measure.text}, error" for e in estimates]
    rows = []
    for point in findings.plan.points:
        row = [findings.plan.label(point)]
        if point in costs:
            cost = costs[point]
            row += [f"{cost.wall:.3g}", f"{cost.unknowns:.0f}",
                    f"{cost.memory:.0f}"]
            if says:
                row.append(f"{digits(100 * cost.in_time, False)} %")
            row += [error_cell(findings, e, point) for e in estimates]
        else:
            row += ["failed"] + ["–"] * (len(head) - 2)
        rows.append(row)
    right = ["**right value**", "", "", "", *[""] * says]
    right += [right_cell(e) for e in estimates]
    legend = ("● no run is both faster and better (errors that cannot be told "
              "from zero, in brackets, count alike)")
    if any(findings.least_cost(e) for e in estimates):
        legend += "; ★ the fastest for the wanted error"
    if findings.request.sampled:
        legend += ("; ± two standard errors from the "
                   + findings.request.sampled)
    legend += "."
    if says:
        legend += (" *Own estimate*: what the run itself says of its growth "
                   "and strain (doc/theory.md, 5.11); it knows nothing of "
                   "errors in space.")
    if any(e.compared_with for e in estimates):
        sources = sorted({e.source for e in estimates if e.compared_with})
        legend += (" " + ", ".join(f"*{source}*" for source in sources)
                   + ": the ladders tell no limit, so that errors are "
                   "differences from the value of that run, whose own error is "
                   "not known; ± is how far the values go apart.")
    return table(head, [*rows, right]) + f"\n\n{legend}"


def right_cell(estimate):
    """The right value; or that it is only the value of one run."""
    text = (f"{estimate.right:.6g} ± {estimate.uncertainty:.1g} "
            f"{pretty(estimate.measure.unit)}")
    return (f"{estimate.source}: " if estimate.compared_with else "") + text


def error_cell(findings, estimate, point):
    error, noise = estimate.errors[point], estimate.noise[point]
    text = shown(estimate, error, noise)
    if point == estimate.compared_with:
        text = "not known"
    elif abs(error) <= estimate.floor:
        text = f"({text})"
    if point in findings.front(estimate):
        text += " ●"
    if point == findings.least_cost(estimate):
        text += " ★"
    return text


def shown(estimate, number, uncertainty=0.0, sign=True):
    """A difference: lengths in um, everything else in per cent of the right
    value where there is one."""
    unit, factor = pretty(estimate.measure.unit), 1.0
    if estimate.measure.unit != "um" and abs(estimate.right) > ROUNDING:
        unit, factor = "%", 100 / abs(estimate.right)
    text = digits(factor * number, sign)
    if digits(factor * uncertainty, False) != "0":
        text += f" ± {digits(factor * uncertainty, False)}"
    return f"{text} {unit}".strip()


def digits(number, sign):
    """Two digits, with a true minus; zero for what is nothing here."""
    if not math.isfinite(number):
        return "–"
    text = f"{number:+.2g}" if sign else f"{number:.2g}"
    if "e+" in text:
        text = f"{number:+.0f}" if sign else f"{number:.0f}"
    if abs(number) < 1e-6:
        text = "0"
    return text.replace("e-0", "e-").replace("-", "−").replace("e−", "e-")


def pretty(unit):
    return unit.replace("um", "µm").replace("^2", "²").replace("^3", "³")


def scatter_table(findings, there):
    """Mean, extremes and standard deviation of every measure; with a reference
    file also the errors, from the least to the largest."""
    head = ["run", "measure", "runs", "mean", "smallest", "largest",
            "standard deviation"]
    if findings.request.reference:
        head += ["error of the mean", "errors, from", "to"]
    rows = []
    for s in there:
        unit = pretty(s.measure.unit)
        row = [findings.plan.label(s.point), s.measure.text,
               f"{len(s.values)}" + (f", {s.n_failed} failed"
                                     if s.n_failed else "")]
        row += [f"{number:.6g} {unit}".strip() for number in
                (s.values.mean(), s.values.min(), s.values.max())]
        row.append(relative(s, s.deviation, sign=False))
        if s.right is not None:
            row += [relative(s, number - s.right) for number in
                    (s.values.mean(), s.values.min(), s.values.max())]
        rows.append(row)
    legend = (f"The grid is moved to {findings.request.n_offsets} positions "
              "spread through one grid cell (doc/accuracy-and-cost.md); a "
              "single run is one of them. Standard deviations "
              + ("and errors " if findings.request.reference else "")
              + "are lengths in µm, else in per cent of the "
              + ("right value" if findings.request.reference else "mean")
              + "; offsets.csv has every run.")
    return table(head, rows) + f"\n\n{legend}"


def relative(scatter, number, sign=True):
    """A difference in um, or in per cent of what it is told against."""
    unit, factor = pretty(scatter.measure.unit), 1.0
    if scatter.measure.unit != "um" and abs(scatter.base) > ROUNDING:
        unit, factor = "%", 100 / abs(scatter.base)
    return f"{digits(factor * number, sign)} {unit}".strip()


def ladder_table(findings, estimates):
    """By how much the centre's values would change if one ladder alone went
    to its limit; the sum; and what a reference file says instead."""
    head = ["ladder"]
    head += [f"{e.measure.text}, change" for e in estimates]
    rows = []
    if not estimates[0].parts:
        return "The run that all ladders share has failed."
    for i, part in enumerate(estimates[0].parts):
        own = findings.plan.rung_label(part.ladder, estimates[0].center)
        rows.append([f"{part.ladder.name}, from {own}"]
                    + [part_cell(e, e.parts[i]) for e in estimates])
    rows.append(["**all that count**"]
                + [sum_cell(e) for e in estimates])
    if estimates[0].from_file:
        rows.append(["the reference file"] + [
            shown(e, -e.errors[e.center], e.uncertainty) for e in estimates])
    if findings.request.sampled:
        rows.append([f"scatter between {findings.request.sampled} "
                     "(standard deviation)"] + [
            shown(e, e.scatter[e.center], sign=False) for e in estimates])
    return table(head, rows) + "\n\n" + ladder_legend(estimates)


def ladder_legend(estimates):
    """Explains the words in the table, and no others."""
    parts = [part for e in estimates for part in e.parts]
    notes = [part.limit.note for part in parts if part.limit]
    lines = [f"*{note}*: {text}." for note, text in NOTES.items()
             if any(there.startswith(note) for there in notes)]
    if any(part.limit is None for part in parts):
        lines.append("*spread*: no value of this key is the right one; how far "
                     "the values go apart.")
    if any(part.limit and not part.used for part in parts):
        lines.append("In square brackets: does not count, as an earlier "
                     "ladder varies the same key.")
    return " ".join(lines)


def part_cell(estimate, part):
    if part.limit is None:
        return f"spread {shown(estimate, part.spread, sign=False)}"
    text = shown(estimate, part.change, part.uncertainty)
    if part.limit.note:
        text += f", {part.limit.note}"
    return text if part.used else f"[{text}]"


def sum_cell(estimate):
    used = [part for part in estimate.parts if part.used]
    if not used:
        return "–"
    return shown(estimate, sum(part.change for part in used),
                 sum(part.uncertainty for part in used))


def rows_of_csv(findings):
    """A row for each run and quantity, with all digits."""
    plan = findings.plan
    yield [*plan.keys, "time", "measure", "unit", "value", "seed_scatter",
           "right_value", "right_value_uncertainty", "error", "error_noise",
           "on_front", "least_time_for_wanted", "wall_seconds", "unknowns",
           "memory_mb", "right_value_from"]
    for e in findings.estimates:
        front, best = findings.front(e), findings.least_cost(e)
        for point in e.values:
            cost = findings.costs[e.time][point]
            numbers = [e.values[point], e.scatter[point], e.right,
                       e.uncertainty, e.errors[point], e.noise[point],
                       int(point in front), int(point == best), cost.wall,
                       cost.unknowns, cost.memory]
            yield [*point, f"{e.time:.10g}", e.measure.text, e.measure.unit,
                   *(f"{number:.10g}" for number in numbers), e.source]
