# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Random scenes that can be turned and mirrored, as keys that override
prm/hard/properties.prm.

All that a seed decides is given in a frame of its own, with the coordinates
xi = Q^T (x - Q c) / R: Q is the orthogonal matrix that turns or mirrors the
scene, c its centre and R its size. So every place, direction and function of a
scene moves with Q, and the grid does not.
"""
import itertools
import math
import random

import numpy

AXES = "XYZ"


def text(values, separator=", "):
    return separator.join(repr(float(value)) for value in values)


def quarter_turns_and_mirrors(dim, det):
    """The orthogonal matrices that map the grid's axes onto each other, but for
    the identity, with this determinant."""
    found = []
    for axes in itertools.permutations(range(dim)):
        for signs in itertools.product((1, -1), repeat=dim):
            Q = numpy.zeros((dim, dim))
            Q[range(dim), axes] = signs
            if (round(numpy.linalg.det(Q)) == det
                    and not numpy.array_equal(Q, numpy.eye(dim))):
                found.append(Q)
    return found


def rotation(rng, dim):
    """By an angle, and in 3-D about an axis, that no grid line follows."""
    if dim == 2:
        angle = rng.uniform(0.2, math.pi / 2 - 0.2) + rng.randrange(4) * math.pi / 2
        c, s = math.cos(angle), math.sin(angle)
        return numpy.array([[c, -s], [s, c]])
    Q, R = numpy.linalg.qr(numpy.array(
        [[rng.gauss(0, 1) for _ in range(3)] for _ in range(3)]))
    Q = Q * numpy.sign(numpy.diag(R))
    return Q * numpy.linalg.det(Q)


class Frame:
    """Functions of xi, written for a scene moved by Q."""

    def __init__(self, Q, center, size):
        self.Q, self.dim, self.size = Q, len(Q), size
        self.center = Q @ center

    def coordinate(self, i):
        """xi_i as an expression of X, Y, Z."""
        terms = [f"({float(self.Q[d, i])!r})*({AXES[d]}-({float(self.center[d])!r}))"
                 for d in range(self.dim) if self.Q[d, i] != 0]
        return f"(({'+'.join(terms)})/{float(self.size)!r})"

    def linear(self, constant, slopes):
        return repr(float(constant)) + "".join(
            f"+({float(slope)!r})*{self.coordinate(i)}"
            for i, slope in enumerate(slopes))

    def vector(self, components):
        """Components, in the scene's frame, of a constant vector."""
        return text(self.Q @ components, "; ")


def random_direction(rng, dim):
    vector = numpy.array([rng.gauss(0, 1) for _ in range(dim)])
    return vector / numpy.linalg.norm(vector)


class RandomScene:
    """What all random scenes have: place, grid, growth, stiffness."""

    def __init__(self, seed, dim):
        self.rng = rng = random.Random(seed)
        self.seed, self.dim = seed, dim
        self.spacing = rng.uniform(6, 10)
        self.grid_spacing = self.spacing * (
            rng.uniform(2.2, 4.5) if dim == 2 else rng.uniform(2, 2.6))
        self.center = numpy.array([rng.uniform(-99, 99) for _ in range(dim)])
        self.grid_offset = numpy.array(
            [rng.uniform(0, self.grid_spacing) for _ in range(dim)])
        self.growth = (rng.uniform(-0.2, 0.6), rng.uniform(0, 0.3)
                       * random_direction(rng, dim))
        self.stiffness = rng.choice([0.0, 0.5]) * random_direction(rng, dim)
        self.ratio = rng.uniform(0, 0.45)
        self.energy_per = rng.choice(["initial volume", "grown volume"])

    def frame(self, Q):
        return Frame(Q, self.center, self.size)

    def common_keys(self, Q):
        frame = self.frame(Q)
        constant, slopes = self.growth
        return {
            "Dimension": self.dim,
            "Grid/Spacing": self.grid_spacing,
            "Grid/Offset": text(Q @ self.grid_offset),
            "Tissue/Cell spacing": self.spacing,
            "Growth/Isotropic/Stretch":
                f"1+t*({frame.linear(constant, slopes)})",
            "Material/Young's modulus":
                f"exp({frame.linear(0.0, self.stiffness)})",
            "Material/Poisson's ratio": self.ratio,
            "Material/Energy per": self.energy_per,
        }


class LatticeScene(RandomScene):
    """A shape with a surface and conditions on it. Turned by quarters and
    mirrored, lattice and boundary points stay the same ones."""

    SUPPORTS = ("free", "fixed", "pressed", "pulled", "heavy", "slip")

    def __init__(self, seed, dim, gentle):
        """gentle: a box under small loads that grows nearly uniformly, whose
        inner grid cells stay a rectangle."""
        super().__init__(seed, dim)
        rng = self.rng
        if gentle:
            self.growth = (0.2 * self.growth[0], 0.1 * self.growth[1])
        else:
            # five grid cells across at least, to compare discretisations
            self.grid_spacing = self.spacing * rng.uniform(2.2, 2.8)
        least, most = ((4, 6) if gentle else (9, 11)) if dim == 3 else (
            (8, 14) if gentle else (15, 20))
        numbers = [rng.randint(least, most) for _ in range(dim)]
        self.lengths = self.spacing * numpy.array(numbers)
        self.size = float(max(self.lengths)) / 2
        self.shape = "box" if gentle else rng.choice(["sphere", "ellipsoid"])
        self.lattice_offset = numpy.array(
            [0.0 if self.shape == "box" else self.spacing
             * rng.uniform(-0.45, 0.45) for _ in range(dim)])
        # a round cap that may only slip along itself hardly lets tissue grow
        self.support = rng.choice(self.SUPPORTS[:None if gentle else -1])
        if dim == 3 and not gentle:
            self.support = "free"  # the patches of its surface do not turn
        self.level = rng.uniform(-0.6, -0.4)
        self.load = rng.uniform(0.005, 0.03) * (0.1 if gentle else 1.0)
        self.direction = random_direction(rng, dim)
        self.divides = rng.random() < 0.6 and (
            not gentle or self.support in ("free", "slip"))
        self.duration = (rng.uniform(0.5, 0.7),
                         rng.uniform(0, 0.05) * random_direction(rng, dim))

    def keys(self, Q):
        keys = self.common_keys(Q)
        full = numpy.ones(3)
        full[:self.dim] = abs(Q) @ self.lengths
        keys.update({
            "Tissue/Shape": self.shape,
            "Tissue/Surface cells": "whole",
            "Tissue/Center": text([*(Q @ self.center), 0, 0][:3]),
            "Tissue/Size": text(full),
            "Tissue/Radius": self.size,
            "Tissue/Lattice offset": text([*(Q @ self.lattice_offset), 0, 0][:3]),
            # the same ones after a quarter turn, in 2-D
            "Tissue/Boundary points":
                0 if self.shape == "box" or self.dim == 3 else
                4 * round(self.size / 4),
        })
        return {**keys, **self.conditions(Q), **self.proliferation(Q)}

    def conditions(self, Q):
        frame, section = self.frame(Q), "Boundary conditions/"
        left = f"{frame.coordinate(0)} < {float(self.level)!r}"
        right = f"{frame.coordinate(0)} > {-float(self.level)!r}"
        force = frame.vector(self.load * self.direction)
        keys = {"fixed": {}, "slip": {section + "Slip where": left},
                "free": {},
                "pressed": {section + "Pressure where": right,
                            section + "Pressure": self.load},
                "pulled": {section + "Traction where": right,
                           section + "Traction": force},
                "heavy": {"Body force/Force density": frame.vector(
                    self.load / self.size * self.direction)}}[self.support]
        held = self.support not in ("free", "slip")
        return {section + "Fixed where": left if held else "", **keys}

    def proliferation(self, Q):
        if not self.divides:
            return {}
        section = "Proliferation/Cell cycle/"
        constant, slopes = self.duration
        return {"Proliferation/Law": "cell cycle",
                section + "Start": "together",
                section + "G0 exit rate": 0,
                section + "Duration": self.frame(Q).linear(constant, slopes),
                section + "Division axis": "fixed",
                section + "Fixed axis": text(Q @ self.direction)}


class AlignedScene(LatticeScene):
    """Round tissue whose cells stand on grid lines, where every choice between
    two sides of a line, or among equally near cells, is a tie."""

    def __init__(self, seed, dim, pooled):
        super().__init__(seed, dim, False)
        self.grid_spacing = (3 if dim == 2 else 2) * self.spacing
        self.center, self.grid_offset = numpy.zeros(dim), numpy.zeros(dim)
        self.lattice_offset = numpy.full(dim, self.spacing / 2)
        self.pooled = pooled
        if pooled:
            self.ratio = 0.49

    def common_keys(self, Q):
        form = "pooled" if self.pooled else "pointwise"
        return {**super().common_keys(Q), "Material/Volumetric strain": form}


class PointsScene(RandomScene):
    """Cells from a file, which can be turned by any angle and written in any
    order. They have no surface; nothing holds them. Refined, cells and grid
    cells are smaller by this factor, and everything else is the same."""

    def __init__(self, seed, dim, refinement=1):
        super().__init__(seed, dim)
        rng, L = self.rng, self.spacing
        axes = numpy.array([L * rng.uniform(5, 8) if dim == 2 else
                            L * rng.uniform(2.5, 3.5) for _ in range(dim)])
        self.size = float(max(axes))
        L = self.spacing = L / refinement
        self.grid_spacing /= refinement
        reach = int(self.size / L) + 1
        cells = []
        for index in itertools.product(range(-reach, reach + 1), repeat=dim):
            x = L * (numpy.array(index) + [rng.uniform(-0.2, 0.2)
                                           for _ in range(dim)])
            if sum((x / axes) ** 2) < 1:
                cells.append([*(self.center + x),
                              L ** dim * rng.uniform(0.8, 1.2)])
        self.cells = numpy.array(cells)

    def points_file(self, Q, order=None):
        cells = self.cells if order is None else self.cells[order]
        names = AXES[:self.dim].lower()
        lines = [",".join([*names, "volume"])]
        for cell in cells:
            lines.append(",".join(
                repr(float(value))
                for value in [*(Q @ cell[:self.dim]), cell[self.dim]]))
        return "\n".join(lines) + "\n"

    def permutation(self):
        order = list(range(len(self.cells)))
        random.Random(self.seed).shuffle(order)
        return order

    def keys(self, Q):
        return {**self.common_keys(Q),
                "Tissue/Shape": "points",
                "Tissue/Points file": "{files}/cells.csv",
                "Tissue/Boundary points": 0,
                "Boundary conditions/Fixed where": ""}
