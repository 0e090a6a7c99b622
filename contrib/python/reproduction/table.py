# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Writes table.md: the paper's numbers and findings beside ours."""
from morula import fits
from morula.tables import markdown

from . import findings, outline, renewal
from .catalogue import GRIDS
from .numbers import CELLS_FIT, CUBE_CELLS, NUMBERS
from .paper_run import Runs


def expected_fit(step):
    """The fit to the expected N_p of Fig. 3's founders, as text."""
    fit = fits.fit_exponential(*renewal.expected_cells(step, fits.RANGE[1], CUBE_CELLS))
    return f"{fit.factor:.0f} e^{{{fit.rate:.3f}t}}"


def notes():
    return f"""Fits are over {fits.RANGE[0]:g} ≤ t ≤ {fits.RANGE[1]:g} days: exponentials by least squares of
the logarithm. The expected number of cells (theory.md, 6.4) grows by {renewal.rate():.4f} a day in the long run, and
fits {expected_fit(0.001)}. With phases that change at the ends of steps of 0.1 day it fits {expected_fit(0.1)}, as
the paper's {CELLS_FIT.factor:.0f} e^{{{CELLS_FIT.rate}t}} does.
"""


def grids(runs):
    """Outlines, volumes and energies of Fig. 2 (a-e), and those of the independent
    solution by finite elements at a stretch that it has."""
    if runs.lacking(GRIDS):
        return ""
    theta = runs["fig-2e"].stretch(-1)
    fine = outline.profile(runs["fig-2e"], -1)
    elements = outline.finite_element_outline(theta)
    rows = [grid_row(runs[scene], fine if scene != "fig-2e" else None, elements) for scene in GRIDS]
    values = outline.finite_element_values(theta)
    if values is not None:
        rows.append(["FE", *["–"] * 6, *last_values(values)])
    return f"""The grids of Fig. 2 at θ = {theta:.3g}, lengths in µm. Distances are those of the free
boundary points from the outline of (e) and from that of body-fitted finite elements (FE, an
independent solution). "Near" are the points that began less than {outline.NEAR_CLAMP:g} µm above
the clamp's edge, "away" the others.

""" + markdown(["panel", "h", "L_p", "near: rms, max", "away: rms, max", "near FE: rms",
                "away FE: rms", "apex z", "V_tot, 10⁶ µm³", "Ψ_ave, kPa"], rows) + "\n"


def grid_row(run, fine, elements):
    row = [run.name[-1], f"{run.number('Grid/Spacing'):g}",
           f"{run.number('Tissue/Cell spacing'):g}"]
    row += ["–"] * 2 if fine is None else [f"{outline.rms(off):.1f}, {off.max():.1f}"
                                           for off in outline.distances(run, -1, fine)]
    row += ["–"] * 2 if elements is None else [f"{outline.rms(off):.1f}" for off in
                                               outline.distances(run, -1, elements)]
    return row + last_values(run.statistics.iloc[-1])


def last_values(row):
    return [f"{row['zmax']:.1f}", f"{row['total_volume'] * 1e-6:.2f}",
            f"{row['mean_energy_density']:.4f}"]


def write_table(output):
    """Writes table.md from the runs that are there and finished, and returns it."""
    runs = Runs(output)
    rows = [number.row(runs) for number in NUMBERS]
    rows += [findings.row(runs, *finding) for finding in findings.FINDINGS]
    table = markdown(["where", "what", "paper", "ours", "ours / paper", "remark"], rows)
    text = "\n".join(filter(None, (table + "\n", notes(), grids(runs))))
    (output / "table.md").write_text(text, encoding="utf-8")
    return text
