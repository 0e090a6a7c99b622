# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A disc whose rim grows and whose core fades, for some days: its size is that of
the equation and its surface stays with its cells."""
import numpy
from scipy.integrate import solve_ivp

SPACING = 55.0  # um
RADIUS, WIDTH = 300.0, 60.0  # um
GROWTH, LOSS = 0.4, 0.15  # 1/day
SCENE = {"Dimension": 2, "Time/End time": 6, "Time/Step": 0.125, "Tissue/Shape": "sphere",
         "Tissue/Radius": RADIUS, "Tissue/Cell spacing": 18,
         "Tissue/Coarsen surface": "true",
         "Grid/Spacing": SPACING, "Growth/Law": "rate",
         "Growth/Rate/Rate": f"if(present_depth < {WIDTH}, {GROWTH}, -{LOSS})",
         "Division by size/Volume": 324, "Division by size/Noise": 0.2,
         "Death/When": "volume < 32", "Death/Shrinking time": 1,
         "Boundary conditions/Surface tension": 2, "Material/Poisson's ratio": 0.48,
         "Material/Relaxation time": 0.1, "Output/Formats": "none"}


def speed(_, R):
    """dR/dt = b (w - w²/2R) - c (R - w)²/2R."""
    return GROWTH * (WIDTH - WIDTH**2 / (2 * R)) - LOSS * (R - WIDTH)**2 / (2 * R)


def test_size_and_surface(runs):
    """Without cells that spread they overlap below the surface: boundary
    points are left behind, until they are pulled back at h/2."""
    rows = runs.run("disc", SCENE).statistics
    days = rows[8::8]
    exact = solve_ivp(speed, (0, 6), [RADIUS], t_eval=days["time"], rtol=1e-8).y[0]
    radius = RADIUS * numpy.sqrt(days["enclosed_volume"] / rows["enclosed_volume"][0])
    numpy.testing.assert_allclose(radius, exact, rtol=0.02)
    assert rows["surface_distance"].max() < 0.45 * SPACING
