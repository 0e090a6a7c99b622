# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A column under a load that becomes stiff with time alone: nothing grows, flows or
changes its type. It keeps its strain, so all of it stiffens."""
from math import log

import pytest
from scipy.optimize import brentq

COLUMN = """
set Dimension = 2
subsection Time
  set End time = 3
  set Step     = 0.5
end
subsection Tissue
  set Shape        = box
  set Center       = 0, 50
  set Size         = 100, 100
  set Cell spacing = 10
end
subsection Grid
  set Spacing = 50
end
subsection Boundary conditions
  set Slip where     = Y < 99
  set Pressure where = Y > 99
  set Pressure       = 0.2*min(1, t/0.5)
end
subsection Output
  set Formats = csv
end
"""


def height(E, nu=0.4):
    """That of the column between its walls, µm: the stretch at which the nominal
    stress mu (L - 1/L) + lambda ln L / L is the load."""
    mu, lame_lambda = E / (2 * (1 + nu)), E * nu / ((1 + nu) * (1 - 2 * nu))
    return 100 * brentq(lambda L: mu * (L - 1 / L) + lame_lambda * log(L) / L + 0.2,
                        0.5, 1, xtol=1e-14)


@pytest.mark.parametrize("key, value, soft, stiff", [
    ("Young's modulus", "1 + 99*ramp(t, 1, 2)", (1, 0.4), (100, 0.4)),
    ("Poisson's ratio", "0.3 + 0.1*ramp(t, 1, 2)", (1, 0.3), (1, 0.4))])
def test_stiffness_of_time_alone(runs, key, value, soft, stiff):
    run = runs.run(key.split()[0], COLUMN, {f"Material/{key}": value})
    top = run.statistics.set_index("time")["ymax"]
    assert top[1.0] == pytest.approx(height(*soft), rel=1e-4)
    assert top[3.0] == pytest.approx(height(*stiff), rel=1e-4)
