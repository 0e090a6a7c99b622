# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Right values for a free sphere that grows by theta(R): the solution of its
radial equilibrium (tests/verification/radial.py), which has nothing of
Morula."""
import csv

import numpy
from morula.prm import parse
from scipy.integrate import quad

from tests.verification.material import lame
from tests.verification.radial import GrowingBall, Layer

RADIUS = 250.0  # um
GROWTH = "1 + 0.4*t*(X^2+Y^2+Z^2)/250^2"


def write(scene, file):
    """The values of the scene at day 1 as a reference for contrib/accuracy.
    The sphere must be the one that is solved here."""
    keys = parse(scene.read_text(encoding="utf-8"), scene.parent)
    given = (keys["Growth/Isotropic/Stretch"], float(keys["Tissue/Radius"]),
             float(keys["Time/End time"]))
    if given != (GROWTH, RADIUS, 1.0):
        raise ValueError(f"{scene} is no longer the sphere solved in "
                         f"{__name__}: {given}")
    file.parent.mkdir(parents=True, exist_ok=True)
    with file.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerows(zip(*values().items()))


def values():
    lame_lambda, mu = lame()
    ball = GrowingBall(
        [Layer(0.0, RADIUS, lambda R: 1 + 0.4 * R**2 / RADIUS**2,
               lambda R: 0.8 * R / RADIUS**2)], (lame_lambda, mu), 3, False)

    def energy(R):
        """Per initial volume (theory.md: compressible neo-Hookean)."""
        along, across, theta = (x[0] for x in ball.stretches([R]))
        a, b = along / theta, across / theta
        ln_J_e = numpy.log(a * b * b)
        return (lame_lambda / 2 * ln_J_e**2
                + mu / 2 * (a * a + 2 * b * b - 3 - 2 * ln_J_e))

    integral = quad(lambda R: energy(R) * R**2, 0, RADIUS, epsabs=0,
                    epsrel=1e-9)[0]
    radius = float(RADIUS * ball.stretches([RADIUS])[1][0])
    return {"surface:mean(radius)": f"{radius:.10g}",
            "surface:std(radius)": "0",
            "total_volume": f"{4 / 3 * numpy.pi * radius**3:.10g}",
            "mean_energy_density": f"{3 * integral / RADIUS**3:.10g}"}
