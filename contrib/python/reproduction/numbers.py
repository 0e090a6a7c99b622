# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The numbers that the paper states, beside those of our runs."""
from dataclasses import dataclass

from morula import fits
from morula.columns import COMPONENTS

from .paper_run import PICTURE_RATIO

# Fig. 3 (c-e), fitted for 2 <= t <= 4 days: 1/day, µm³, kPa.
CELLS_FIT = fits.Exponential(7500.0, 0.36)
VOLUME_FIT = fits.Exponential(7.7e6, 0.31)
ENERGY_FIT = fits.Line(0.095, -0.029)
CUBE_CELLS = 8.0e3


@dataclass(frozen=True)
class Number:
    """One stated number: where, what, in which run, the paper's and ours (a function
    of that run); a relative or absolute tolerance, if one is asked."""

    place: str
    what: str
    scene: str
    paper: float
    ours: callable
    digits: str = ".4g"
    relative: float = None
    absolute: float = None
    remark: str = ""

    def verdict(self, ours):
        """What the tolerance, if there is one, says."""
        if self.relative:
            limit, off = f"{100 * self.relative:g} %", abs(ours / self.paper - 1) / self.relative
        elif self.absolute:
            limit, off = f"{self.absolute:g}", abs(ours - self.paper) / self.absolute
        else:
            return ""
        return f"within {limit}" if off <= 1 else f"**not within {limit}**"

    def row(self, runs):
        """The fields of the table, as text."""
        start = self.place, self.what, format(self.paper, self.digits)
        if runs.lacking([self.scene]):
            return *start, "not run", "", f"run `contrib/reproduce` for {self.scene}"
        try:
            ours = self.ours(runs[self.scene])
        except fits.NothingToFit as error:
            return *start, "none", "", str(error)
        ratio = (f"{ours / self.paper:.3f}" if self.paper else
                 f"difference {ours - self.paper:.1e}")
        remark = "; ".join(filter(None, (self.verdict(ours), self.remark)))
        return *start, format(ours, self.digits), ratio, remark


def over_first(values):
    return values.iloc[-1] / values.iloc[0]


def boundary_points(run):
    return len(run.surface(0))


def volume_over_cube_of_stretch(run):
    """Mean of V_p / (θ³ V⁰) in the last state: 1 for free growth."""
    cells = run.cells(-1)
    return (cells["volume"] / cells["initial_volume"] / cells["growth_volume_ratio"]).mean()


def residual_stress(run):
    """Largest component of any cell's Cauchy stress over E."""
    stress = run.cells(-1)[list(COMPONENTS["sigma"])]
    return stress.abs().to_numpy().max() / run.number("Material/Young's modulus")


def fitted(place, what, column, function, paper, *parts):
    """The numbers (name, unit, limits) of the fit of a column of Fig. 3's random proliferation."""
    def ours(name):
        return lambda run: getattr(function(run.statistics["time"], run.statistics[column]), name)
    return [Number(place, f"{what}: {name} {unit}".strip(), "fig-3b", getattr(paper, name),
                   ours(name), **limits) for name, unit, limits in parts]


def picture_cells(run):
    return run.count(run.picture_state)


NUMBERS = (
    Number("§2.3, Fig. 1 d", "N_p after the cycle / before", "fig-1d", 2.0,
           lambda run: over_first(run.statistics["cells"]), ".10g",
           remark="\"exactly doubled\""),
    Number("§2.3, Fig. 1 d", "V_p after the cycle / before", "fig-1d", 1.0,
           lambda run: over_first(run.statistics["total_volume"] / run.statistics["cells"]),
           ".10g", remark="\"the same\""),
    Number("§2.5", "cells of the sphere, L_p = 10 µm", "fig-2b", 6.6e4,
           lambda run: run.founders, ",.0f"),
    Number("§2.5", "cells of the sphere, L_p = 5 µm", "fig-2e", 5.2e5,
           lambda run: run.founders, ",.0f"),
    Number("§2.5", "boundary points of the sphere", "fig-2b", 2.6e3, boundary_points, ",.0f"),
    Number("§3.1", "cells of the cube", "fig-3a", CUBE_CELLS, lambda run: run.founders, ",.0f"),
    Number("§3.1", "boundary points of the cube", "fig-3a", 2.9e3, boundary_points, ",.0f",
           remark="6·22²: whole grids of points on the faces"),
    Number("§3.1, Fig. 3 a", "V_p / (θ³ V_p⁰), mean", "fig-3a", 1.0,
           volume_over_cube_of_stretch, ".10g", remark="\"isotropic growth\""),
    Number("§3.1, Fig. 3 a", "largest / smallest V_p", "fig-3a", 1.0,
           lambda run: run.cells(-1)["volume"].max() / run.cells(-1)["volume"].min(), ".10g",
           remark="\"uniform volume expansion\""),
    Number("§3.1, Fig. 3 a", "residual stress / E", "fig-3a", 0.0, residual_stress, ".1e",
           remark="\"negligible\"; largest component of any cell"),
    *fitted("Fig. 3 c", "N_p", "cells", fits.fit_exponential, CELLS_FIT,
            ("factor", "", {"relative": 0.05}),
            ("rate", "[1/day]", {"absolute": 0.02, "remark": "see below"})),
    *fitted("Fig. 3 d", "V_tot", "total_volume", fits.fit_exponential, VOLUME_FIT,
            ("factor", "[µm³]", {"relative": 0.05}), ("rate", "[1/day]", {"absolute": 0.02})),
    *fitted("Fig. 3 e", "Ψ_ave", "mean_energy_density", fits.fit_line, ENERGY_FIT,
            ("slope", "[kPa/day]", {"relative": 0.10}), ("constant", "[kPa]", {})),
    Number("§3.2, Fig. 4 b", "N_p shown, with checkpoint", "fig-4b", 2.2e5, picture_cells,
           ",.0f", remark="the output nearest to 1.5³ times the founders"),
    Number("§3.2, Fig. 4 c", "N_p shown, without checkpoint", "fig-4c", 2.2e5, picture_cells,
           ",.0f", remark="the same; an output every 0.1 day"),
    Number("§3.2, Fig. 4 b", "N_p shown / founders", "fig-4b", PICTURE_RATIO,
           lambda run: picture_cells(run) / run.founders),
    Number("Fig. 4 d", "θ", "fig-4d", 1.5, lambda run: run.stretch(-1), ".10g"),
)
