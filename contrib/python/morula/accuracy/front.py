# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The runs that are worth their cost."""
import re
from dataclasses import dataclass

from morula.refusal import Refused

OPTION = "--wanted"
FORM = "'1%', '0.5um' or, for one measure, 'zmax=0.5um', several with commas"


def pareto(costs, errors):
    """Indices of the runs that no other one beats: none is both as cheap and
    as good, and better in one of the two. In order of cost."""
    best, front = float("inf"), []
    for i in sorted(range(len(costs)), key=lambda i: (costs[i], errors[i])):
        if errors[i] < best:
            best = errors[i]
            front.append(i)
    return front


@dataclass(frozen=True)
class Wanted:
    """An error that somebody is content with."""

    text: str
    number: float
    unit: str  # '%' or that of the measure; '': whatever the measure has

    def absolute(self, value):
        """In the measure's own unit."""
        return self.number * (abs(value) / 100 if self.unit == "%" else 1)


def read_wanted(text, measures):
    """{measure: Wanted} from --wanted; measures may be missing."""
    wanted = {}
    for word in text.split(",") if text else []:
        name, equals, amount = word.rpartition("=")
        match = re.fullmatch(r"\s*([0-9.]+(?:[eE][-+]?\d+)?)\s*(%|[a-zA-Z]\w*"
                             r"(?:\^\d)?|)\s*", amount)
        try:
            error = Wanted(amount.strip(), float(match[1]), match[2])
        except (TypeError, ValueError):
            raise Refused(OPTION, text, FORM) from None
        if error.number <= 0:
            raise Refused(OPTION, text, "errors > 0")
        fitting = [m for m in measures
                   if (m.text == name.strip() or not equals)
                   and error.unit in ("", "%", m.unit)]
        several_units = len({measure.unit for measure in measures}) > 1
        if not equals and not error.unit and several_units:
            raise Refused(OPTION, text, FORM, "The measures have different "
                          f"units: say which one '{word.strip()}' is for.")
        if not fitting:
            raise Refused(OPTION, text, "a measure of --measure, in % or its "
                          "unit: " + ", ".join(f"{m.text} [{m.unit or '1'}]"
                                               for m in measures))
        wanted.update({measure: error for measure in fitting})
    return wanted


def cheapest(costs, bounds, wanted):
    """Index of the cheapest run whose error is at most the wanted one, or
    None; the bounds hold the uncertainty as well."""
    good = [i for i in range(len(costs)) if bounds[i] <= wanted]
    return min(good, key=lambda i: costs[i], default=None)
