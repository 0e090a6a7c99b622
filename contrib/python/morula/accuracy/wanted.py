# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""An error that somebody is content with: --wanted."""
import re
from dataclasses import dataclass

from morula.refusal import Refused

OPTION = "--wanted"
FORM = re.compile(r"(?:(.+)=)?\s*([0-9.]+(?:e[-+]?\d+)?)\s*(%|[a-z]\w*(?:\^\d)?|)", re.IGNORECASE)


@dataclass(frozen=True)
class Wanted:
    """`unit`: '%' or that of the measure; '': whatever the measure has."""

    text: str
    number: float
    unit: str

    def absolute(self, value):
        """In the measure's own unit."""
        return self.number * (abs(value) / 100 if self.unit == "%" else 1)


def read_wanted(text, measures):
    """{measure: Wanted} from --wanted; measures may be missing."""
    wanted = {}
    for word in text.split(",") if text else []:
        match = FORM.fullmatch(word.strip())
        name, number, unit = match.groups() if match else ("", "0", "")
        fitting = [m for m in measures if name in (None, m.text) and unit in ("", "%", m.unit)]
        units = {measure.unit for measure in fitting}
        if number.count(".") > 1 or not float(number) > 0 or not fitting or (
                not unit and len(units) > 1):
            raise Refused(OPTION, word, "'1%', '0.5um' or, for one measure, "
                          "'zmax=0.5um', several with commas; errors > 0 of "
                          + ", ".join(f"{m.text} [{m.unit or '1'}]"
                                      for m in measures))
        error = Wanted(f"{match[2]}{unit}", float(number), unit)
        wanted.update(dict.fromkeys(fitting, error))
    return wanted
