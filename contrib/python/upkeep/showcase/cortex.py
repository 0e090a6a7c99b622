# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A ball whose outer layer grows within the surface: how far its folds are from each
other, and how much surface they hide."""
import numpy
from morula.style import COLOURS, plt
from scipy.special import eval_gegenbauer, gammaln

from . import SCENES, Case

SCENE = SCENES / "cortex.prm"
LAYER = 20.0  # um, thickness of the layer at the start
DEGREES = numpy.arange(3, 41)  # of waves on the ball; 0 to 2 are its shape
FOLDED = 0.1 * LAYER  # um, depth from which on the surface has folds

HEADER = ["stiffness, of the core", "friction, 10⁻⁶ kPa day/µm²", "folds at a growth of",
          "squeezed to", "thin film", "apart, thicknesses", "thin film", "at a growth of",
          "apart, thicknesses", "depth, µm", "surface over that of a ball", "minutes"]


def cases():
    return [Case(f"cortex, {ratio} times as stiff, {friction:g}",
                 {"Material/Young's modulus":
                  f"1 + {ratio - 1}/(1 + exp(10*(depth/20 - 1)))",
                  "Friction/Coefficient": f"{friction:g}", "Time/End time": f"{end:g}"},
                 (ratio, friction)) for ratio, friction, end in (
                     (10, 1e-5, 1), (10, 1e-4, 1), (3, 1e-4, 1.2))]


def thin_film(ratio):
    """Of a film on a half-space, both without change of volume: to which part of its length
    it is squeezed when it folds, and how far its folds are apart, in thicknesses."""
    return 1 - (3 / ratio)**(2 / 3) / 4, 2 * numpy.pi * (ratio / 3)**(1 / 3)


def growth(day):  # of a length in the surface of the outermost cells
    return numpy.exp(0.5 * day)


class Waves:
    """The surface of a ball as its height above the mean, by degrees of spherical
    harmonics, from boundary points that had equal parts of the ball at the start.
    `power`: mean square of the height in each of DEGREES, um^2."""

    def __init__(self, surface):
        start = surface[["X", "Y", "Z"]].to_numpy()
        start /= numpy.linalg.norm(start, axis=1)[:, None]
        now = surface[["x", "y", "z"]].to_numpy()
        height = ((now - now.mean(axis=0)) * start).sum(axis=1)
        self.radius = height.mean()
        self.power = numpy.array([power_of(height - self.radius, start, degree)
                                  for degree in DEGREES])
        self.area_ratio = surface["area"].sum() / (4 * numpy.pi * self.radius**2)

    @property
    def depth(self):
        """Root of the mean square of the height's part in DEGREES, um."""
        return numpy.sqrt(self.power.sum())

    @property
    def spacing(self):
        """2 pi over the mean wave number, weighted by power, um."""
        number = numpy.sqrt(DEGREES * (DEGREES + 1.0)) / self.radius
        return 2 * numpy.pi * self.power.sum() / (number * self.power).sum()


def power_of(height, place, degree):
    """Mean square of the part of this degree in a height that is known at many
    even places on the unit sphere. Associated Legendre functions by Gegenbauer's
    polynomials: scipy's own take five times as long."""
    angle = numpy.arctan2(place[:, 1], place[:, 0])
    cosine = numpy.clip(place[:, 2], -1, 1)
    total = 0.0
    for order in range(degree + 1):
        n, index = degree - order, order + 0.5
        values = (1 - cosine**2)**(order / 2) * eval_gegenbauer(n, index, cosine)
        mean = numpy.mean(height * values * numpy.exp(1j * order * angle))
        norm = (n + index) * numpy.exp(2 * index * numpy.log(2) + gammaln(n + 1) + 2
                                       * gammaln(index) - gammaln(n + 2 * index)) / numpy.pi
        total += (2 if order else 1) * norm * abs(mean)**2
    return total


def course(run):
    return run.times, [Waves(run.surface(i)) for i in range(len(run.times))]


def onset(times, waves):
    """The time at which the depth passes FOLDED, which it does by a rate, and the
    number of the first state after it; none if it stays below."""
    depths = [wave.depth for wave in waves]
    first = next((i for i, depth in enumerate(depths) if depth > FOLDED), None)
    if not first:
        return None, None
    there = slice(first - 1, first + 1)
    return numpy.interp(numpy.log(FOLDED), numpy.log(depths[there]), times[there]), first


def row(case, run):
    times, waves = course(run)
    time, first = onset(times, waves)
    ratio, friction = case.values
    squeezed, apart = thin_film(ratio)
    folds = ["none", "", f"{squeezed:.2f}", ""]
    if first:
        radius = numpy.interp(time, times, [wave.radius for wave in waves])
        folds = [f"{growth(time):.2f}", f"{radius / (waves[0].radius * growth(time)):.2f}",
                 f"{squeezed:.2f}", f"{waves[first].spacing / LAYER:.1f}"]
    return [f"{ratio}", f"{1e6 * friction:g}", *folds, f"{apart:.1f}",
            f"{growth(times[-1]):.2f}", f"{waves[-1].spacing / LAYER:.1f}",
            f"{waves[-1].depth:.1f}", f"{waves[-1].area_ratio:.2f}"]


def draw(pairs):
    canvas, (left, right) = plt.subplots(1, 2, layout="constrained", figsize=(7.4, 2.8))
    for i, (case, run) in enumerate(pairs):
        times, waves = course(run)
        depths = numpy.array([wave.depth for wave in waves])
        spacings = numpy.array([wave.spacing for wave in waves]) / LAYER
        left.plot(growth(times), depths, ".-", color=COLOURS[i],
                  label=f"{case.values[0]}, {1e6 * case.values[1]:g}")
        right.plot(growth(times)[depths > FOLDED], spacings[depths > FOLDED], ".-",
                   color=COLOURS[i])
        right.axhline(thin_film(case.values[0])[1], color=COLOURS[i], linestyle=":")
    left.set(xlabel="growth of lengths in the layer", ylabel="depth, µm")
    left.legend(title="stiffness, friction")
    right.set(xlabel="growth of lengths in the layer", ylim=(0, None),
              ylabel="spacing, layer thicknesses")
    return canvas
