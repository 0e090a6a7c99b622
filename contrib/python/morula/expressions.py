# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Expressions that the user types: '10*(theta - 1)' of columns, or the
condition 'generation >= 2 && Y < 0', which pandas evaluates."""
import numpy as np

from .refusal import Refused


def rows_where(text, columns, option):
    """A mask of the rows for which a condition holds, from their columns by name:
    pandas' DataFrame.eval. && and || and ^ are those of a scene's expressions, too; a
    number is true where it is above 0, as with Fixed where."""
    import pandas
    table = pandas.DataFrame({name: np.asarray(values) for name, values in columns.items()
                              if np.ndim(values) == 1})
    plain = text.replace("&&", " and ").replace("||", " or ").replace("^", "**")
    try:
        with np.errstate(all="ignore"):
            found = np.asarray(table.eval(plain.strip(), engine="python",
                                          local_dict={}, global_dict={}))
        if found.shape not in ((len(table),), ()) or found.dtype.kind not in "bif":
            raise ValueError("it is no number")
    except Exception as error:  # pandas throws what Python does
        raise Refused(option, text, "what pandas' DataFrame.eval takes, and && || ^; the columns "
                      "are " + ", ".join(table), f"Not so: {error}.") from None
    return np.broadcast_to(found, (len(table),)) > 0
