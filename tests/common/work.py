# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The work that a run has done, counted, not timed: a change that costs more
shows on any machine."""
from morula.run import Run

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


def counters(output):
    """name -> number, of a run's output directory."""
    run = Run(output)
    rows, calls = run.statistics, run.timings["calls"]
    totals = rows[1:].sum()
    newton = int(totals["newton_iterations"])
    tangents = int(calls.get("tangent", 0))
    # Steps take tangents in the same proportion as Newton iterations.
    points = (rows["cells"].shift()[1:] * rows["newton_iterations"][1:]).sum()
    points = int(points) * tangents // max(newton, 1)
    return {"unknowns": int(totals["unknowns"]),
            "newton_iterations": newton,
            "linear_iterations": int(totals["linear_iterations"]),
            "tangents": tangents,
            "residuals": int(calls.get("residual", 0)),
            "preconditioners": int(calls.get("preconditioner", 0)),
            "tangent_kflop": points * flop_per_point(run.dimension) // 1000}


def excess(found, usual_work, ranks):
    """What was done more often than usual, or less often: then the reference is to be
    renewed. A list of texts."""
    texts = []
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
