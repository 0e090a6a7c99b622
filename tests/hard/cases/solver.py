# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tolerances at the limit of rounding, and expressions that lose their value in
mid-run."""
from tests.cases.case import Case, Finding, Limit, Trial

# No number between t = 0.9 and 1.6; but at 0 and at End time, where scenes are
# checked before they run.
LOST = "sqrt((t - 0.9) * (t - 1.6))"
CONDITIONS = "Boundary conditions/"

TIGHT = Limit("A tolerance that rounding does not allow is met as far as it "
              "does: no step takes more than {at_most:g} Newton iterations.",
              at_most=10)
LEFT = Limit("What it leaves of the residual is at most {at_most:g}.",
             at_most=1e-9)


def without_value(name, key, text, **more):
    """At t = 1 the key has no value: the last good state is that at 0.5."""
    return Trial(name, "solver.prm", ranks=(1, 2), exit=2,
                 keys={key: text.replace("LOST", LOST), **more},
                 resume_keys={"Time/Step": "0.25"},
                 message=rf"At t = 0.5 day: (?s:.*){key}(?s:.*)t = 1 day")


def judge(runs):
    tight = runs["tight"].results.statistics()
    loose = runs["loose"].results.statistics()
    yield Finding("tight: apex against a tolerance of 1e-6 [µm]",
                  abs(tight["zmax"][-1] - loose["zmax"][-1]),
                  at_most=1e-3, error=True, trial="tight")
    yield LEFT.found("tight: largest residual of a step",
                     tight["residual"][1:].max())
    yield TIGHT.found("tight: most iterations of a step",
                      tight["newton_iterations"][1:].max())
    for name, run in runs.items():
        if name.startswith("lost"):
            yield Finding(f"{name}: time of the last good state [day]",
                          run.results.statistics()["time"][-1],
                          equals=(0.5, 1e-12))


CASE = Case(
    title="A solver asked for too much, and for what does not exist",
    judge=judge, limits=(TIGHT, LEFT),
    trials=[
        Trial("tight", "solver.prm", ranks=(1, 2)),
        Trial("loose", "solver.prm", keys={"Solver/Newton tolerance": "1e-6"}),
        without_value("lost-growth", "Growth/Isotropic/Stretch",
                      "1 + 0.01 * LOST"),
        without_value("lost-displacement", CONDITIONS + "Displacement",
                      "0; 0; 0.01 * LOST"),
        without_value("lost-traction", CONDITIONS + "Traction",
                      "0; 0; 0.001 * LOST",
                      **{CONDITIONS + "Traction where": "Z > 20"}),
        without_value("lost-pressure", CONDITIONS + "Pressure", "0.001 * LOST",
                      **{CONDITIONS + "Pressure where": "Z > 20"}),
        without_value("lost-force", "Body force/Force density",
                      "0; 0; 1e-5 * LOST"),
    ])
