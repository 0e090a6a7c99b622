# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The places of the cells over time as one table, as OpenVT's portal has them."""
import pandas


def write(run, states, file):
    """Returns the numbers of rows and columns. Times are days, places um."""
    tables = []
    for number in states:
        cells = run.cells(number)
        types = ([run.type_names[type] for type in cells["type"]] if run.type_names
                 else ["cell"] * len(cells))
        tables.append(pandas.DataFrame({
            "simID": run.name, "time": run.times[number], "cellID": cells["id"].to_numpy(),
            "cellType": types, **{axis: cells[axis].to_numpy()
                                  for axis in "xyz"[:run.dimension]}}))
    table = pandas.concat(tables)
    table.to_csv(file, index=False)
    return table.shape
