# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What the growing spheres and discs have in common: their errors."""
import numpy

from tests.common.results import initial_positions, positions
from tests.verification.errors import field_errors
from tests.verification.material import cauchy, lame
from tests.verification.radial import GrowingBall

RADIUS = 250  # µm


def solution(results, layers):
    """The GrowingBall that the scene describes; its growth must be the
    scene's at every cell."""
    ball = GrowingBall(layers, lame(), results.dimension,
                       results.per_grown_volume())
    cells = results.last_cells()
    X = initial_positions(cells)
    theta = ball.stretches(numpy.linalg.norm(X, axis=1))[2]
    scene = results.function("Growth/Isotropic/Stretch", X, cells["time"][0])
    numpy.testing.assert_allclose(theta, scene, rtol=1e-12)
    return ball


def errors(results, layers):
    """Errors of the fields and, where there are boundary points, of the outer
    radius (their mean, as their areas are equal), and its scatter."""
    ball = solution(results, layers)

    def stress(X, t):
        growth = ball.stretches(numpy.linalg.norm(X, axis=1))[2]
        return cauchy(ball.gradient(X), lame(), growth, results.dimension,
                      results.per_grown_volume())

    found = field_errors(results, lambda X, t: ball.motion(X), stress)
    if results.keys["Tissue/Shape"] == "points":
        return found
    radii = numpy.linalg.norm(positions(results.last_surface()), axis=1)
    exact = RADIUS * ball.stretches(numpy.array([RADIUS]))[1, 0]
    return {**found, "outer radius [µm]": abs(radii.mean() - exact),
            "scatter [µm]": radii.std()}
