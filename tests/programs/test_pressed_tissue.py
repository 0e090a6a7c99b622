# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A ball that relaxes under a pressure above its Young's modulus stays as it is:
volume and J_e are those of the closed form, in every grid cell and for many
relaxation times, though nothing but its cells' volumes resists for long."""
import math

from scipy.optimize import brentq

from tests.verification.material import lame

E, NU, PRESSURE = 10.0, 0.4, 16.0  # kPa
SCENE = {"Time/End time": 1, "Time/Step": 0.025, "Tissue/Shape": "sphere", "Tissue/Radius": 100,
         "Tissue/Cell spacing": 12, "Tissue/Surface cells": "trimmed", "Grid/Spacing": 45,
         "Material/Young's modulus": E, "Material/Poisson's ratio": NU,
         "Material/Energy per": "grown volume", "Material/Relaxation time": 0.125,
         "Boundary conditions/Pressure where": 1,
         "Boundary conditions/Pressure": f"{PRESSURE}*min(1, t/0.1)",
         "Output/Formats": "csv", "Output/Interval": 0}


def volume_ratio():
    """J_e, by mu (J^(2/3) - 1) + lambda ln J = -p J."""
    LAMBDA, MU = lame(E, NU)
    return brentq(lambda J: MU * (J**(2 / 3) - 1) + LAMBDA * math.log(J) + PRESSURE * J, 0.1, 1)


def test_stays_as_it_is(runs):
    run = runs.run("pooled", SCENE, {"Material/Volumetric strain": "pooled"})
    volume, expected = run.statistics["total_volume"], volume_ratio()
    assert abs(volume.iloc[-1] / volume[0] / expected - 1) < 1e-3
    assert run.cells(-1)["elastic_volume_ratio"].between(0.95 * expected, 1.05 * expected).all()
