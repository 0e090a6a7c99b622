# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tissue in plane strain that grows evenly between slip walls, free above
(doc/exact-solutions.md)."""
import math

from scipy.optimize import brentq

from tests.verification.material import lame


def slab(theta, E=1.0, nu=0.4):
    """(height by initial height, energy density in kPa) at a stretch theta."""
    lame_lambda, mu = lame(E, nu)
    L = brentq(lambda L: mu * (L * L - 1) + lame_lambda * math.log(L / theta),
               0.1, 10.0, xtol=1e-14)
    ln_J = math.log(L / theta)
    return theta * L, (lame_lambda / 2 * ln_J**2 +
                       mu / 2 * (1 / theta**2 + L**2 - 2 - 2 * ln_J))
