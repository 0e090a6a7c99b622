# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tables with a row a trial, for the terminal and for the documentation."""
import math
import re

from morula import tables

from tests.common.tables import aligned, number

HEADER = ["trial", "outcome", "steps", "Newton/step", "linear/Newton",
          "condition", "rejected", "smallest J_e", "error"]


def figure(value):
    """Three digits; very small and very large ones with a power of ten."""
    if not math.isfinite(value):
        return str(value)
    return f"{value:.3g}" if 1e-3 <= abs(value) < 1e4 else number(value)


def time_of_failure(text):
    match = re.search(r"[Aa]t t = ([-+.0-9e]+) day", text)
    return float(match[1].rstrip(".")) if match else None


def span(values, write):
    """One value, or the smallest and the largest, as text."""
    values = [value for value in values if value is not None]
    if not values:
        return ""
    low, high = write(min(values)), write(max(values))
    return low if low == high else f"{low} … {high}"


def outcome(runs):
    """How the runs of a row have ended: 'finished', '17 finished, 3 exit 2 at
    t = 0.1 … 0.3'."""
    words = []
    for code in sorted({run.exit for run in runs}, key=str):
        ended = [run for run in runs if run.exit == code]
        count = "" if len(runs) == 1 else f"{len(ended)} "
        if code == 0:
            words.append(count + "finished")
        elif code == 1:
            words.append(count + "exit 1")
        else:
            time = span([time_of_failure(run.text) for run in ended],
                        lambda t: f"{t:g}")
            words.append(f"{count}exit {code} at t = {time}")
    return ", ".join(words)


def row(label, runs, findings):
    """The cells of a row: figures of all its runs."""
    def column(name, write):
        return span([getattr(run.figures, name) for run in runs if run.figures],
                    write)

    names = {label, *(run.trial.name for run in runs)}
    errors = [finding for finding in findings
              if finding.error and finding.trial in {None, *names}]
    return [label, outcome(runs), column("steps", str),
            column("newton", "{:.1f}".format),
            column("linear", "{:.0f}".format), column("condition", figure),
            column("rejected", str), column("smallest_J", "{:.3g}".format),
            "; ".join(f"{f.text}: {figure(f.value)}" for f in errors)]


def rows(runs, findings):
    """A row for each trial, or for all that share one."""
    collected = {}
    for run in runs.values():
        label = run.trial.row or run.trial.name
        collected.setdefault(label, []).append(run)
    return [row(label, of_row, findings)
            for label, of_row in collected.items()]


def lines(runs, findings):
    """The table for the terminal."""
    return aligned(HEADER, rows(runs, findings))


def markdown(runs, findings, full):
    """The table, and below it what is asserted."""
    size = "Full size." if full else "At the size of ctest."
    asserted = [f"- {finding.text}: {finding.value:.4g} ({finding.limits()})"
                + ("" if finding.holds() else " **not met**")
                for finding in findings]
    return "\n".join([f"*{size}*", "",
                      tables.markdown(HEADER, rows(runs, findings)), "",
                      "<details><summary>All that is asserted</summary>", "",
                      *asserted, "", "</details>"])
