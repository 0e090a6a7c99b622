# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tables of errors and orders, for the terminal and for the documentation."""
import numpy

from morula import tables

from tests.common.tables import aligned, number


def table(measured):
    """Header and rows of text: size, then each error with the order at which
    it has fallen since the rung before; last the order through all rungs."""
    names = list(measured.errors)
    header = [measured.ladder.varied] + [
        word for name in names for word in (name, "order")]
    rows = []
    for i, size in enumerate(measured.sizes):
        row = [f"{size:g}"]
        for name in names:
            error = measured.errors[name]
            row.append(f"{error[i]:.2e}")
            if i == 0 or not error[i - 1] > 0 < error[i]:
                row.append("")
            else:
                row.append("%.2f" % (
                    numpy.log(error[i - 1] / error[i])
                    / numpy.log(measured.sizes[i - 1] / size)))
        rows.append(row)
    if len(rows) > 2:
        rows.append(["all"] + [word for name in names
                               for word in ("", f"{measured.order(name):.2f}")])
    return header, rows


def lines(ladders, findings):
    """The tables of all ladders for the terminal."""
    found = []
    for measured in ladders:
        scenes = ", ".join(measured.ladder.scenes)
        found += ["", f"{measured.ladder.name}: {scenes}, "
                  f"{measured.ladder.fixed}", *aligned(*table(measured))]
    return found


def summary(measured, name):
    """What the documentation says of one error of a ladder."""
    ladder, errors = measured.ladder, measured.errors[name]
    if name in ladder.most:
        return (f"≤ {number(max(errors))} "
                f"(asserted: {number(ladder.most[name])})")
    text = f"{number(errors[0])} → {number(errors[-1])}"
    if ladder.varied.startswith("dt"):
        return text
    order = f"order {measured.order(name):.1f}"
    if name in ladder.least_orders:
        order = f"**{order}** (≥ {ladder.least_orders[name]:g})"
    return f"{text}, {order}"


def markdown(ladders, findings, full):
    """A table with a row for each ladder of a case, and below it what is not
    as the ladders assert."""
    others = [name for measured in ladders for name in measured.errors
              if name not in ("displacement", "stress")]
    names = ["displacement", "stress", *dict.fromkeys(others)]
    rows = []
    for measured in ladders:
        ladder = measured.ladder
        symbol, unit = ladder.varied.split(" [")
        cells = [f"`{ladder.name}`",
                 f"{symbol} = {measured.sizes[0]:g} → {measured.sizes[-1]:g} "
                 + unit.rstrip("]"), ladder.fixed]
        cells += [summary(measured, name) if name in measured.errors else ""
                  for name in names]
        rows.append(cells)
    table = tables.markdown(["ladder", "varied", "fixed", *names], rows)
    unmet = [f"- **Not met:** {finding.text} is {finding.value:.3g}, not "
             f"{finding.limits()}" for finding in findings
             if not finding.holds()]
    return "\n".join([table, "", *unmet] if unmet else [table])
