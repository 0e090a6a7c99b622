# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Growth to three times the width, withering, growth without room, twelve
generations, and steps far too long or too short."""
import numpy

from tests.cases.case import Case, Finding, Limit, Trial

E, NU = 1.0, 0.4
LAMBDA = E * NU / ((1 + NU) * (1 - 2 * NU))
MU = E / (2 * (1 + NU))

DIVISIONS = Limit("Division loses no initial volume: after twelve "
                  "generations the difference is {at_most:g}.", at_most=0)
GROWN = Limit("Their grown volume is right to {at_most:g} of it.",
              at_most=1e-7)
STEPS = Limit("Very short steps, and one long step, end where usual ones do, "
              "to {at_most:g} of volume, energy and height.", at_most=0.02)
CLAMP = Limit("Held points stay within {at_most:g} grid spacings of their "
              "places when tissue grows to three times its width or withers "
              "(Method = paper).", at_most=0.1)
SOFT_CLAMP = Limit("With Method = consistent, whose penalty is a fiftieth, and "
                   "whose energy is nearer to that of finite elements, they "
                   "stay within {at_most:g} grid spacings.", at_most=0.15)


def energy(stretches):
    """Energy density where growth by these stretches has no room: F_e is their
    inverse, in 3-D or, with two stretches, in plane strain."""
    stretches = numpy.asarray(stretches, dtype=float)
    log_J = -numpy.log(stretches).sum()
    return (LAMBDA / 2 * log_J**2 +
            MU / 2 * ((stretches**-2.0 - 1).sum() - 2 * log_J))


def relative(value, right):
    return abs(value / right - 1)


def enclosed(runs):
    # Stretched by more than 1/0.75 the tissue has lost its ellipticity: the
    # pressure falls with the volume, and cells tear apart.
    # Wider at the full size, by what was measured there (doc/hard-cases.md).
    for name, rate, until, limit in (("enclosed", 0.1, 20, 8e-3),
                                     ("enclosed-withering", -0.1, 2, 0.03)):
        small = runs[name].results.number("Tissue/Radius") <= 50
        rows = runs[name].results.statistics()
        row = rows[rows["time"] <= until][-1]
        theta = 1 + rate * row["time"]
        yield Finding(f"{name}: mean energy at a stretch of {theta:g} against "
                      "the closed form [relative]",
                      relative(row["mean_energy_density"],
                               energy([theta] * 3)),
                      at_most=3e-3 if small else limit, error=True,
                      trial=name)
    last = runs["enclosed-cycles"].results.statistics()[-1]
    growth = 8 * 1.4  # three cycles and 0.4 of the fourth one
    yield Finding("enclosed-cycles: mean energy against the closed form "
                  "[relative]",
                  relative(last["mean_energy_density"], energy([1, 1, growth])),
                  at_most=5e-3, error=True, trial="enclosed-cycles")
    yield Finding("enclosed-cycles: smallest J_e",
                  runs["enclosed-cycles"].figures.smallest_J, at_most=0.1)
    founders = runs["enclosed-cycles"].results.statistics()["cells"][0]
    yield Finding("enclosed-cycles: cells for each founder",
                  last["cells"] / founders, equals=(8, 0))


# The half-fixed sphere by finite elements, build/half-fixed-sphere with 'Edge
# quadrature points' = 0 for the growth: volume / R³ and mean energy density in
# kPa. With 1 to 4 levels of refinement at the edge, or twice as fine all over,
# the volume at a stretch of 3 varies by 0.4 %, the energy by 3 %.
GROWN_SPHERE = (92.5, 0.636)
HALF_FIXED = {"growth": GROWN_SPHERE, "growth-consistent": GROWN_SPHERE,
              "withering": (0.411, 2.218)}


def half_fixed(runs):
    limits = {"growth": (0.04, 0.2), "growth-consistent": (0.04, 0.1),
              "withering": (0.15, 0.25)}
    for name, (volume, energy_density) in HALF_FIXED.items():
        results = runs[name].results
        last = results.statistics()[-1]
        radius = results.number("Tissue/Radius")
        yield Finding(f"{name}: volume against finite elements [relative]",
                      relative(last["total_volume"] / radius**3, volume),
                      at_most=limits[name][0], error=True, trial=name)
        yield Finding(f"{name}: energy against finite elements [relative]",
                      relative(last["mean_energy_density"], energy_density),
                      at_most=limits[name][1], error=True, trial=name)
        surface = results.last_surface()
        fixed = surface[surface["condition"] == 1]
        gap = max(numpy.abs(fixed[x] - fixed[x.upper()]).max() for x in "xyz")
        clamp = SOFT_CLAMP if name.endswith("consistent") else CLAMP
        yield clamp.found(f"{name}: largest gap of a fixed point / h",
                          gap / results.number("Grid/Spacing"))


def generations(runs):
    for name, n in (("twelve-generations", 12), ("thread", 8)):
        run = runs[name]
        first, last = (run.results.statistics()[k] for k in (0, -1))
        cells = run.results.last_cells()
        yield Finding(f"{name}: cells for each founder",
                      last["cells"] / first["cells"], equals=(2**n, 0))
        yield DIVISIONS.found(
            f"{name}: V⁰ of a cell against its founder's [relative]",
            numpy.abs(cells["initial_volume"] * 2**n / 100 - 1).max())
        growth = 2**(n - 1) * 1.75  # a quarter of a cycle after the division
        yield GROWN.found(f"{name}: grown volume [relative]",
                          relative(last["grown_volume"],
                                   first["total_volume"] * growth),
                          error=True, trial=name)
    last = runs["thread"].results.statistics()[-1]
    yield Finding("thread: total volume against the grown one [relative]",
                  relative(last["total_volume"], last["grown_volume"]),
                  at_most=1e-5, error=True, trial="thread")
    yield Finding("thread: mean energy, which is 0 [E]",
                  last["mean_energy_density"], at_most=1e-6)
    # ΣW tr τ = ΣV tr σ in the plane vanishes without loads and supports.
    cells = runs["twelve-generations"].results.last_cells()
    stress = cells["sigma_xx"] + cells["sigma_yy"]
    yield Finding("twelve-generations: virial / Σ|·|",
                  abs((cells["volume"] * stress).sum())
                  / numpy.abs(cells["volume"] * stress).sum(), at_most=1e-3,
                  error=True, trial="twelve-generations")


def steps(runs):
    def end(name):
        return runs[name].results.statistics()[-1]
    fine, usual, one = (end(name) for name in
                        ("short-steps", "usual-steps", "one-step"))
    for quantity in ("total_volume", "mean_energy_density", "ymax"):
        for name, last in (("short-steps", fine), ("one-step", one)):
            yield STEPS.found(
                f"{name}: {quantity} against usual steps [relative]",
                relative(last[quantity], usual[quantity]),
                error=quantity == "ymax", trial=name)
    surfaces = {name: runs[name].results.last_surface()
                for name in ("short-steps", "usual-steps")}
    gaps = {}
    for name, surface in surfaces.items():
        fixed = surface[surface["condition"] == 1]
        gaps[name] = max(numpy.abs(fixed[x] - fixed[x.upper()]).max()
                         for x in "xy")
    yield Finding("short-steps: largest gap of a fixed point against usual "
                  "steps", gaps["short-steps"] / gaps["usual-steps"],
                  at_most=1.5)


def judge(runs):
    for part in (enclosed, half_fixed, generations, steps):
        yield from part(runs)


THREAD = {"Proliferation/Cell cycle/Division axis": "fixed",
          "Proliferation/Cell cycle/Fixed axis": "1, 0",
          "Grid/Spacing": "25", "Time/Step": "0.25", "Time/End time": "7.75"}
WITHER = {"Growth/Isotropic/Stretch": "1 - 0.1 * t", "Time/End time": "6"}
TRIMMED = {"Tissue/Surface cells": "trimmed"}
SMALL = {"Tissue/Radius": "100", "Tissue/Cell spacing": "12.5",
         "Tissue/Boundary points": "600"}
EACH = {"Output/Interval": "1", **TRIMMED}

CASE = Case(
    title="Large growth, and growth without room",
    judge=judge, limits=(DIVISIONS, GROWN, STEPS, CLAMP, SOFT_CLAMP),
    trials=[
        Trial("growth", "large-growth.prm", keys=EACH, quick=SMALL),
        Trial("growth-consistent", "large-growth.prm",
              keys={**EACH, "Method": "consistent"}, quick=SMALL),
        Trial("withering", "large-growth.prm", keys={**EACH, **WITHER},
              quick=SMALL),
        Trial("enclosed", "enclosed-sphere.prm", keys=TRIMMED,
              quick={"Tissue/Radius": "50", "Time/Step": "4"}),
        Trial("enclosed-withering", "enclosed-sphere.prm",
              keys={**TRIMMED, **WITHER}, exit=(0, 2),
              message="the step failed even at",
              quick={"Tissue/Radius": "50", "Time/Step": "2"}),
        Trial("enclosed-cycles", "enclosed-proliferation.prm", keys=TRIMMED,
              quick={"Tissue/Radius": "40", "Grid/Spacing": "25",
                     "Time/Step": "0.25"}),
        Trial("enclosed-random", "enclosed-proliferation.prm", full_only=True,
              keys={**TRIMMED,
                    "Proliferation/Cell cycle/Division axis": "random"},
              exit=(0, 2), message="the step failed even at"),
        Trial("half-fixed-cycles", "half-fixed-proliferation.prm",
              full_only=True, keys=TRIMMED, exit=(0, 2),
              message="the step failed even at"),
        # The tissue creases at 256 cells and amplifies what Newton's method
        # leaves over a hundred thousand times. At a tolerance of 1e-6 it is a
        # matter of luck where two ranks end beside one: of six random seeds
        # two to four are less than 0.1 µm apart, the others up to 1.8 mm,
        # whichever of equally good extension blocks is taken.
        Trial("twelve-generations", "twelve-generations.prm", ranks=(1, 2),
              keys={"Solver/Newton tolerance": "1e-10"}, agreement=0.1),
        Trial("thread", "twelve-generations.prm", keys=THREAD),
        Trial("short-steps", "growth-steps.prm",
              quick={"Time/Step": "0.002"}),
        Trial("usual-steps", "growth-steps.prm", keys={"Time/Step": "0.25"}),
        Trial("one-step", "growth-steps.prm", keys={"Time/Step": "1"}),
    ])
