# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The work that a run has done, counted, not timed: a change that costs more
shows on any machine."""
import csv
import re

# Iterations depend on the rounding, that is on the processor.
TOLERANCE = 0.1
# Sums of ranks' blocks precondition less well than the whole factorisation, by
# far so on the few grid cells of these scenes.
RANKS_FACTOR = 4.5
# What each of Newton's iterations, or each tangent, has many of.
IN_EACH = {"linear_iterations": "newton_iterations", "tangent_kflop": "tangents"}


def flop_per_point(dim):
    """Least arithmetic of a tangent: dim symmetric blocks of rank-one updates
    of the 3^dim splines, dim (dim - 1)/2 full ones of two each
    (doc/performance.md, The kernels)."""
    n = 3**dim
    return dim * n * (n + 1) + dim * (dim - 1) // 2 * 4 * n * n


def read(path):
    with open(path, newline="") as stream:
        return list(csv.DictReader(stream))


def counters(output):
    """name -> number, of a run's output directory."""
    rows = read(output / "statistics.csv")
    calls = {row["section"]: int(row["calls"])
             for row in read(output / "timings.csv")}
    dim = int(re.search(r"set Dimension *= *(\d)",
                        (output / "parameters.prm").read_text())[1])

    def total(name):
        return sum(int(row[name]) for row in rows[1:])
    # Steps take tangents in the same proportion as Newton iterations.
    points = sum(int(before["cells"]) * int(row["newton_iterations"])
                 for before, row in zip(rows, rows[1:]))
    points = (points * calls.get("tangent", 0)
              // max(total("newton_iterations"), 1))
    return {"unknowns": total("unknowns"),
            "newton_iterations": total("newton_iterations"),
            "linear_iterations": total("linear_iterations"),
            "tangents": calls.get("tangent", 0),
            "residuals": calls.get("residual", 0),
            "preconditioners": calls.get("preconditioner", 0),
            "tangent_kflop": points * flop_per_point(dim) // 1000}


def write(path, found):
    with open(path, "w") as stream:
        stream.write("counter,value\n")
        stream.writelines(f"{name},{value}\n" for name, value in found.items())


def excess(found, reference, ranks):
    """What was done more often than in the reference, or less often: then the
    reference is to be renewed. A list of texts."""
    texts = []
    usual_work = {row["counter"]: int(row["value"]) for row in read(reference)}
    for name, usual in usual_work.items():
        lower, upper = usual * (1 - TOLERANCE), usual * (1 + TOLERANCE)
        if ranks > 1 and name == "linear_iterations":
            upper *= RANKS_FACTOR
        # Two of whatever is counted. On more ranks than the reference has these
        # may be two of Newton's iterations or tangents, with what they take.
        few = 2
        if ranks > 1 and name in IN_EACH:
            few *= usual / max(usual_work[IN_EACH[name]], 1)
        if not lower - few <= found[name] <= upper + few:
            texts.append(f"{name}: {found[name]}, in the reference {usual}")
    return texts
