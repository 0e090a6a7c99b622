# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A run with the closed forms of its material, and how to judge them."""
from pathlib import Path

import numpy
from morula.prm import parse
from morula.run import Run, places, read_csv

__all__ = ["Results", "agree", "initial_positions", "positions", "read_csv",
           "read_keys", "root", "stresses"]
positions = places  # current ones, of cells or boundary points, one row each


def read_keys(file):
    """The keys of a .prm file by full path, as text."""
    return parse(Path(file).read_text(encoding="utf-8"))


class Results(Run):
    """A Run whose tables are arrays."""

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

    def numbers(self, key):
        """Components of a key with several, without those 2-D lacks."""
        values = [float(value) for value in self.keys[key].split(",")]
        return numpy.array(values[: self.dimension])

    def function(self, key, X, t):
        """A key that is an expression, at positions X (rows) and time t."""
        names = {name: getattr(numpy, name) for name in ("sin", "cos", "exp", "sqrt")}
        names |= dict(zip("XYZ", [*X.T, numpy.zeros(len(X))]), t=t)
        components = self.keys[key].replace("^", "**").split(";")[:self.dimension]
        values = [numpy.broadcast_to(eval(text, {}, names), len(X))
                  for text in components]
        return values[0] if len(values) == 1 else numpy.array(values).T

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

    def is_pooled(self):
        return self.keys["Material/Volumetric strain"] == "pooled"

    def per_grown_volume(self):
        return self.keys["Material/Energy per"] == "grown volume"


def initial_positions(points):
    """Initial (founders') positions, one row each."""
    return numpy.stack([points[axis] for axis in "XYZ"], axis=1)


def stresses(cells):
    """Cauchy stresses in kPa, one 3 x 3 tensor a cell."""
    return numpy.stack([numpy.asarray(cells[f"sigma_{name}"]) for name in
                        ("xx", "xy", "zx", "xy", "yy", "yz", "zx", "yz", "zz")],
                       axis=1).reshape(-1, 3, 3)


def agree(what, computed, exact, tolerance):
    """All numbers agree within the tolerance."""
    error = numpy.max(numpy.abs(numpy.asarray(computed) - exact))
    print(f"{what} deviates by {error:.3g}, allowed {tolerance:g}")
    assert error <= tolerance, f"{what} deviates by {error:.3g}, allowed {tolerance:g}"


def root(function, low, high):
    """The zero of a function with a sign change."""
    from scipy.optimize import brentq
    return brentq(function, low, high, xtol=1e-15 * max(abs(low), abs(high)))
