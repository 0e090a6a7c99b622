# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A ball whose outer layer grows within the surface: how far its folds are from each
other, and how much surface they hide."""
from dataclasses import dataclass

import numpy
from morula.run import Run
from morula.style import COLOURS, RC, plt
from scipy.special import eval_gegenbauer, gammaln

from .spheroids import ROOT

SCENE = ROOT / "prm/showcase/cortex.prm"
LAYER = 20.0  # um, thickness of the layer at the start
DEGREES = numpy.arange(3, 41)  # of waves on the ball; 0 to 2 are its shape
FOLDED = 0.1 * LAYER  # um, depth from which on the surface has folds

HEADER = ["stiffness, of the core", "friction, 10⁻⁶ kPa day/µm²",
          "folds at a growth of", "squeezed to", "thin film",
          "apart, thicknesses", "thin film", "at a growth of",
          "apart, thicknesses", "depth, µm", "surface over that of a ball",
          "minutes"]

plt.rcParams.update(RC)


@dataclass(frozen=True)
class Case:
    """The scene with another stiffness of the layer, over that of the core, and
    another friction, kPa day/um^2."""

    ratio: float
    friction: float
    end: float = 1.0  # day

    @property
    def name(self):
        return f"cortex, {self.ratio:g} times as stiff, {self.friction:g}"

    def overrides(self):
        """What is special in the scene, as (key, value)."""
        return (("Material/Young's modulus", f"1 + {self.ratio - 1:g}"
                 "/(1 + exp(10*(depth/20 - 1)))"),
                ("Friction/Coefficient", f"{self.friction:g}"),
                ("Time/End time", f"{self.end:g}"))

    @property
    def thin_film(self):
        """Of a thin film on a half-space, both without change of volume: to which
        part of its length it is squeezed when it folds, and how far its folds
        are from each other, in thicknesses."""
        return (1 - (3 / self.ratio)**(2 / 3) / 4,
                2 * numpy.pi * (self.ratio / 3)**(1 / 3))


def all_cases():
    return [Case(10.0, 1e-5), Case(10.0, 1e-4), Case(3.0, 1e-4, 1.2)]


def growth(day):
    """Of a length in the surface of the outermost cells."""
    return numpy.exp(0.5 * day)


@dataclass(frozen=True)
class Waves:
    """The surface of a ball as its height above the mean, by degrees of spherical
    harmonics."""

    power: numpy.ndarray  # mean square of the height in each of DEGREES, um^2
    radius: float  # mean, um
    area: float  # of the surface, um^2

    @classmethod
    def of(cls, surface):
        """Of boundary points that had equal parts of the ball at the start."""
        start = surface[["X", "Y", "Z"]].to_numpy()
        start /= numpy.linalg.norm(start, axis=1)[:, None]
        now = surface[["x", "y", "z"]].to_numpy()
        height = ((now - now.mean(axis=0)) * start).sum(axis=1)
        radius = height.mean()
        return cls(numpy.array([_power(height - radius, start, degree)
                                for degree in DEGREES]),
                   radius, surface["area"].sum())

    @property
    def depth(self):
        """Root of the mean square of the height's part in DEGREES, um."""
        return numpy.sqrt(self.power.sum())

    @property
    def spacing(self):
        """2 pi over the mean wave number, weighted by power, um."""
        number = numpy.sqrt(DEGREES * (DEGREES + 1.0)) / self.radius
        return 2 * numpy.pi * self.power.sum() / (number * self.power).sum()

    @property
    def area_ratio(self):
        """Of the surface, over that of a ball of the mean radius."""
        return self.area / (4 * numpy.pi * self.radius**2)


def _power(height, place, degree):
    """Mean square of the part of this degree in a height that is known at many
    even places on the unit sphere. Associated Legendre functions by Gegenbauer's
    polynomials, as scipy's own overflow."""
    angle = numpy.arctan2(place[:, 1], place[:, 0])
    cosine = numpy.clip(place[:, 2], -1, 1)
    total = 0.0
    for order in range(degree + 1):
        n, index = degree - order, order + 0.5
        values = ((1 - cosine**2)**(order / 2)
                  * eval_gegenbauer(n, index, cosine))
        mean = numpy.mean(height * values * numpy.exp(1j * order * angle))
        norm = (n + index) * numpy.exp(
            2 * index * numpy.log(2) + gammaln(n + 1) + 2 * gammaln(index)
            - gammaln(n + 2 * index)) / numpy.pi
        total += (2 if order else 1) * norm * abs(mean)**2
    return total


def course(run):
    """Times, and the waves at each."""
    return run.times, [Waves.of(run.surface(i)) for i in range(len(run.times))]


def onset(times, waves):
    """The time at which the depth passes FOLDED, which it does by a rate, and the
    number of the first state after it; none if it stays below."""
    depths = [wave.depth for wave in waves]
    first = next((i for i, depth in enumerate(depths) if depth > FOLDED), None)
    if not first:
        return None, None
    there = slice(first - 1, first + 1)
    return numpy.interp(numpy.log(FOLDED), numpy.log(depths[there]),
                        times[there]), first


def row(case, record):
    times, waves = course(Run(record.output))
    time, first = onset(times, waves)
    folds = ["none", "", f"{case.thin_film[0]:.2f}", ""]
    if first:
        radius = numpy.interp(time, times, [wave.radius for wave in waves])
        squeezed = radius / (waves[0].radius * growth(time))
        folds = [f"{growth(time):.2f}", f"{squeezed:.2f}",
                 f"{case.thin_film[0]:.2f}",
                 f"{waves[first].spacing / LAYER:.1f}"]
    return [f"{case.ratio:g}", f"{1e6 * case.friction:g}", *folds,
            f"{case.thin_film[1]:.1f}", f"{growth(times[-1]):.2f}",
            f"{waves[-1].spacing / LAYER:.1f}", f"{waves[-1].depth:.1f}",
            f"{waves[-1].area_ratio:.2f}", f"{record.process_seconds / 60:.0f}"]


def draw(pairs, path):
    """Depth and spacing of folds over the growth, of (case, record of its run)."""
    canvas, (left, right) = plt.subplots(1, 2, layout="constrained",
                                         figsize=(7.4, 2.8))
    for i, (case, record) in enumerate(pairs):
        times, waves = course(Run(record.output))
        folded = [wave.depth > FOLDED for wave in waves]
        left.plot(growth(times), [wave.depth for wave in waves], ".-",
                  color=COLOURS[i],
                  label=f"{case.ratio:g}, {1e6 * case.friction:g}")
        right.plot(growth(times)[folded],
                   [wave.spacing / LAYER
                    for wave, shown in zip(waves, folded) if shown], ".-",
                   color=COLOURS[i])
        right.axhline(case.thin_film[1], color=COLOURS[i], linestyle=":")
    left.set(xlabel="growth of lengths in the layer", ylabel="depth, µm")
    left.legend(title="stiffness, friction")
    right.set(xlabel="growth of lengths in the layer", ylim=(0, None),
              ylabel="spacing, layer thicknesses")
    path.parent.mkdir(parents=True, exist_ok=True)
    canvas.savefig(path)
    plt.close(canvas)
