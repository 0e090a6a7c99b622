# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What a run has written, and how to judge it."""
from pathlib import Path

import numpy
from morula.prm import parse
from morula.run import read_csv


def read_keys(file):
    """The keys of a .prm file by full path, as text."""
    return parse(Path(file).read_text(encoding="utf-8"))


class Results:
    """The files in an output directory, read on demand."""

    def __init__(self, directory):
        self.directory = Path(directory)
        self.keys = read_keys(self.directory / "parameters.prm")
        self.dimension = int(self.keys["Dimension"])

    def statistics(self):
        return read_csv(self.directory / "statistics.csv")

    def lineage(self):
        return read_csv(self.directory / "lineage.csv")

    def outputs(self, kind):
        """The files of 'cells' or 'surface' in order of time."""
        return sorted(self.directory.glob(f"{kind}-[0-9]*.csv"))

    def last_cells(self):
        return read_csv(self.outputs("cells")[-1])

    def last_surface(self):
        return read_csv(self.outputs("surface")[-1])

    def number(self, key):
        return float(self.keys[key])

    def numbers(self, key):
        """Components of a key with several, without those 2-D lacks."""
        values = [float(value) for value in self.keys[key].split(",")]
        return numpy.array(values[: self.dimension])

    def function(self, key, X, t):
        """A key that is an expression, at positions X (rows) and time t."""
        def value(text):
            names = dict(zip("XYZ", [*X.T, numpy.zeros(len(X))]), t=t,
                         **{name: getattr(numpy, name)
                            for name in ("sin", "cos", "exp", "sqrt")})
            formula = text.replace("^", "**")
            return numpy.broadcast_to(eval(formula, {}, names), len(X))

        components = self.keys[key].split(";")
        if len(components) == 1:
            return value(components[0])
        return numpy.array(
            [value(text) for text in components[: self.dimension]]).T

    def lame(self):
        """The Lame constants (lambda, mu) in kPa of a homogeneous tissue."""
        E = self.number("Material/Young's modulus")
        nu = self.number("Material/Poisson's ratio")
        return E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))

    def stress_of(self, b_e):
        """The Kirchhoff stress in kPa of the material where b_e is diagonal,
        with these three entries."""
        lame_lambda, mu = self.lame()
        b_e = numpy.asarray(b_e)
        J_e = numpy.sqrt(b_e.prod())
        if self.keys["Material/Law"] == "neo-Hookean":
            return mu * (b_e - 1) + lame_lambda * numpy.log(J_e)
        kappa = lame_lambda + 2 / 3 * mu
        return (mu * J_e ** (-2 / 3) * (b_e - b_e.mean())
                + kappa / 2 * (J_e**2 - 1))

    def is_projected(self):
        return self.keys["Material/Volumetric strain"] == "projected"

    def per_grown_volume(self):
        return self.keys["Material/Energy per"] == "grown volume"


def positions(points):
    """Current positions of cells or boundary points, one row each."""
    return numpy.array([points["x"], points["y"], points["z"]]).T


def initial_positions(points):
    """Initial (founders') positions, one row each."""
    return numpy.array([points["X"], points["Y"], points["Z"]]).T


def stresses(cells):
    """Cauchy stresses in kPa, one 3 x 3 tensor a cell."""
    sigma = numpy.empty((len(cells), 3, 3))
    for i, a in enumerate("xyz"):
        for j, b in enumerate("xyz"):
            name = f"sigma_{a}{b}"
            if name not in cells.dtype.names:
                name = f"sigma_{b}{a}"
            sigma[:, i, j] = cells[name]
    return sigma


def agree(what, computed, exact, tolerance):
    """All numbers agree within the tolerance."""
    error = numpy.max(numpy.abs(numpy.asarray(computed) - exact))
    print(f"{what} deviates by {error:.3g}, allowed {tolerance:g}")
    assert error <= tolerance, f"{what} deviates by {error:.3g}, allowed {tolerance:g}"


def root(function, low, high):
    """The zero of a function with a sign change, by bisection."""
    positive_at_low = function(low) > 0
    for _ in range(200):
        middle = 0.5 * (low + high)
        if (function(middle) > 0) == positive_at_low:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)
