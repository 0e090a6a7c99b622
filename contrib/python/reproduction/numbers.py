# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The numbers that the paper states, beside those of our runs."""
from dataclasses import dataclass

import numpy as np
from morula import fits
from morula.columns import COMPONENTS

from . import figure_4, stated


@dataclass(frozen=True)
class Number:
    """One stated number: where, what, in which run, the paper's and ours (a
    function of that run); a relative or absolute tolerance, if one is asked."""

    place: str
    what: str
    scene: str
    paper: float
    ours: callable
    digits: str = ".4g"
    relative: float = None
    absolute: float = None
    remark: str = ""


def boundary_points(run):
    return len(run.read("surface", 0.0)[0])


def growth_of_number(run):
    cells = run.statistics["cells"]
    return cells.iloc[-1] / cells.iloc[0]


def mean_volume_ratio(run):
    """Mean cell volume at the end over that of the start."""
    rows = run.statistics
    volume = rows["total_volume"] / rows["cells"]
    return volume.iloc[-1] / volume.iloc[0]


def volume_over_cube_of_stretch(run):
    """Mean of V_p / (θ³ V⁰) in the last state: 1 for free growth."""
    columns = run.read("cells", run.last_output)[1]
    return float(np.mean(columns["volume"] / columns["initial_volume"]
                         / columns["growth_volume_ratio"]))


def volume_spread(run):
    """Largest over smallest cell volume in the last state."""
    volume = run.read("cells", run.last_output)[1]["volume"]
    return float(volume.max() / volume.min())


def residual_stress(run):
    """Largest component of any cell's Cauchy stress over E."""
    columns = run.read("cells", run.last_output)[1]
    largest = max(np.abs(columns[name]).max() for name in COMPONENTS["sigma"])
    return float(largest / run.number("Material/Young's modulus"))


def fit(column, function):
    """The fitted function of a column of Fig. 3's random proliferation."""
    return lambda run: function(run.statistics["time"], run.statistics[column])


CELLS_OF = fit("cells", fits.fit_exponential)
VOLUME_OF = fit("total_volume", fits.fit_exponential)
ENERGY_OF = fit("mean_energy_density", fits.fit_line)


def picture_cells(run):
    return run.cells_at(figure_4.picture_time(run))


NUMBERS = (
    Number("§2.3, Fig. 1 d", "N_p after the cycle / before", "fig-1d", 2.0,
           growth_of_number, ".10g", remark="\"exactly doubled\""),
    Number("§2.3, Fig. 1 d", "V_p after the cycle / before", "fig-1d", 1.0,
           mean_volume_ratio, ".10g", remark="\"the same\""),
    Number("§2.5", "cells of the sphere, L_p = 10 µm", "fig-2b",
           stated.SPHERE_CELLS, lambda run: run.founders, ",.0f"),
    Number("§2.5", "cells of the sphere, L_p = 5 µm", "fig-2e",
           stated.FINE_SPHERE_CELLS, lambda run: run.founders, ",.0f"),
    Number("§2.5", "boundary points of the sphere", "fig-2b",
           stated.SPHERE_BOUNDARY_POINTS, boundary_points, ",.0f"),
    Number("§3.1", "cells of the cube", "fig-3a", stated.CUBE_CELLS,
           lambda run: run.founders, ",.0f"),
    Number("§3.1", "boundary points of the cube", "fig-3a",
           stated.CUBE_BOUNDARY_POINTS, boundary_points, ",.0f",
           remark="6·22²: whole grids of points on the faces"),
    Number("§3.1, Fig. 3 a", "V_p / (θ³ V_p⁰), mean", "fig-3a", 1.0,
           volume_over_cube_of_stretch, ".10g", remark="\"isotropic growth\""),
    Number("§3.1, Fig. 3 a", "largest / smallest V_p", "fig-3a", 1.0,
           volume_spread, ".10g", remark="\"uniform volume expansion\""),
    Number("§3.1, Fig. 3 a", "residual stress / E", "fig-3a", 0.0,
           residual_stress, ".1e", remark="\"negligible\"; largest component "
           "of any cell"),
    Number("Fig. 3 c", "N_p: factor", "fig-3b", stated.CELLS_FIT.factor,
           lambda run: CELLS_OF(run).factor, relative=stated.FACTOR_TOLERANCE),
    Number("Fig. 3 c", "N_p: rate [1/day]", "fig-3b", stated.CELLS_FIT.rate,
           lambda run: CELLS_OF(run).rate, absolute=stated.RATE_TOLERANCE,
           remark="see *The rate of the number of cells*"),
    Number("Fig. 3 d", "V_tot: factor [µm³]", "fig-3b",
           stated.VOLUME_FIT.factor, lambda run: VOLUME_OF(run).factor,
           relative=stated.FACTOR_TOLERANCE),
    Number("Fig. 3 d", "V_tot: rate [1/day]", "fig-3b", stated.VOLUME_FIT.rate,
           lambda run: VOLUME_OF(run).rate, absolute=stated.RATE_TOLERANCE),
    Number("Fig. 3 e", "Ψ_ave: slope [kPa/day]", "fig-3b",
           stated.ENERGY_FIT.slope, lambda run: ENERGY_OF(run).slope,
           relative=stated.SLOPE_TOLERANCE),
    Number("Fig. 3 e", "Ψ_ave: constant [kPa]", "fig-3b",
           stated.ENERGY_FIT.constant, lambda run: ENERGY_OF(run).constant),
    Number("§3.2, Fig. 4 b", "N_p shown, with checkpoint", "fig-4b",
           stated.PICTURE_CELLS, picture_cells, ",.0f",
           remark="the output nearest to 1.5³ times the founders"),
    Number("§3.2, Fig. 4 c", "N_p shown, without checkpoint", "fig-4c",
           stated.PICTURE_CELLS, picture_cells, ",.0f",
           remark="the same; an output every 0.1 day"),
    Number("§3.2, Fig. 4 b", "N_p shown / founders", "fig-4b",
           stated.PICTURE_RATIO,
           lambda run: picture_cells(run) / run.founders),
    Number("Fig. 4 d", "θ", "fig-4d", 1.5,
           lambda run: run.stretch(run.last_output), ".10g"),
)


def verdict(number, ours):
    """What the tolerance, if there is one, says."""
    if number.relative is not None:
        limit = f"{100 * number.relative:g} %"
        good = abs(ours / number.paper - 1) <= number.relative
    elif number.absolute is not None:
        limit = f"{number.absolute:g}"
        good = abs(ours - number.paper) <= number.absolute
    else:
        return ""
    return f"within {limit}" if good else f"**not within {limit}**"


def cells_of_row(number, runs):
    """The row's fields as text."""
    paper = format(number.paper, number.digits)
    if not runs.has(number.scene):
        return (number.place, number.what, paper, "not run", "",
                f"run `contrib/reproduce` for {number.scene}")
    try:
        ours = number.ours(runs[number.scene])
    except fits.NothingToFit as error:
        return number.place, number.what, paper, "none", "", str(error)
    ratio = (f"{ours / number.paper:.3f}" if number.paper else
             f"difference {ours - number.paper:.1e}")
    remark = "; ".join(filter(None, (verdict(number, ours), number.remark)))
    return (number.place, number.what, paper, format(ours, number.digits),
            ratio, remark)
