# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The types of cells: their names; and what befell cells: changes of type, death, removal."""
import numpy as np

from .prm import parse
from .refusal import Refused

EVENTS = ("time", "id", "event", "from", "to")
OF_DEATH = ("cause",)  # in runs whose cells die


def names_in(keys, section="Cell types"):
    """Names of the types (or of another section's things) by their numbers,
    from the keys of a scene; none if there are none."""
    names = keys.get(f"{section}/Names", "").split(",")
    return tuple(name.strip() for name in names if name.strip())


def names_of_run(directory):
    """The same of a run's directory, which need not have all its files."""
    file = directory / "parameters.prm"
    return names_in(parse(file.read_text(encoding="utf-8"))) if file.is_file() else ()


def read_events(file, names):
    """events.csv as a data frame; without the file, an empty one. Throws
    Refused if it is damaged, or has types that are not among the names."""
    import pandas
    if not file.is_file():
        return pandas.DataFrame(columns=EVENTS)
    try:
        # a type may have a name that pandas would take for a missing number
        table = pandas.read_csv(file, dtype=str, keep_default_na=False)
        table = table[[*EVENTS, *OF_DEATH[:"cause" in table]]].astype(
            {"time": float, "id": np.int64})
    except (ValueError, KeyError) as error:  # pandas' own are ValueErrors
        raise Refused("The table", file, "the columns " + ", ".join(EVENTS), f"{error}.") from None
    for name in {*table["from"], *table["to"]} - {*names, ""}:
        raise Refused("The table", file, "types of the run: "
                      + ", ".join(names), f"It has '{name}'.")
    return table
