# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tolerances at the limit of rounding, and expressions that lose their value in
mid-run."""
import pytest

# No number between t = 0.9 and 1.6; but at 0 and at End time, where scenes are checked
# before they run.
LOST = "sqrt((t - 0.9) * (t - 1.6))"
CONDITIONS = "Boundary conditions/"
KEYS = {"Growth/Isotropic/Stretch": f"1 + 0.01 * {LOST}",
        CONDITIONS + "Displacement": f"0; 0; 0.01 * {LOST}",
        CONDITIONS + "Traction": f"0; 0; 0.001 * {LOST}",
        CONDITIONS + "Pressure": f"0.001 * {LOST}",
        "Body force/Force density": f"0; 0; 1e-5 * {LOST}"}


def test_tight(case):
    """A tolerance that rounding does not allow is met as far as it does."""
    trial = case.trial("tight", "solver.prm", ranks=(1, 2))
    loose = case.trial("loose", "solver.prm", {"Solver/Newton tolerance": "1e-6"})
    case.found("tight: apex against a tolerance of 1e-6 [µm]",
               abs(trial.last("zmax") - loose.last("zmax")), at_most=1e-3)
    case.found("tight: largest residual of a step", trial.rows["residual"][1:].max(),
               at_most=1e-9)
    case.found("tight: most iterations of a step",
               trial.rows["newton_iterations"][1:].max(), at_most=10)


@pytest.mark.parametrize("key", [
    key if "Traction" in key else pytest.param(key, marks=pytest.mark.release)
    for key in KEYS])
def test_lost(case, key):
    """At t = 1 the key has no value: the last good state is that at 0.5."""
    name = key.rpartition("/")[2]
    where = {f"{CONDITIONS}{name} where": "Z > 20"} if name in (
        "Traction", "Pressure") else {}
    trial = case.trial(f"lost {name}", "solver.prm", {key: KEYS[key], **where},
                       ranks=(1, 2), exits=(2,), resume_keys={"Time/Step": "0.25"},
                       message=rf"At t = 0.5 day: (?s:.*){key}(?s:.*)t = 1 day")
    case.found(f"lost {name}: time of the last good state [day]", trial.last("time"),
               equals=(0.5, 1e-12))
