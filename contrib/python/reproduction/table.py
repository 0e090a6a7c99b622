# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Writes table.md: the paper's numbers beside ours, and its findings."""
from morula import fits
from morula.tables import markdown

from . import outline, renewal, stated
from .catalogue import GRIDS
from .findings import FINDINGS, distances
from .numbers import NUMBERS, cells_of_row
from .outline_reference import finite_element_outline, finite_element_values
from .run_results import Runs


def numbers(runs):
    return "## Numbers\n\n" + markdown(
        ["where", "what", "paper", "ours", "ours / paper", "remark"],
        [cells_of_row(number, runs) for number in NUMBERS]) + f"""

Fits are over {fits.RANGE[0]:g} ≤ t ≤ {fits.RANGE[1]:g} days, all step ends \
alike: exponentials by least
squares of the logarithm, the line by least squares of the values.
"""


def expected_fit(step):
    """The fit to the expected N_p of Fig. 3's founders, as text."""
    fit = fits.fit_exponential(*renewal.expected_cells(
        step, fits.RANGE[1], stated.CUBE_CELLS))
    return f"{fit.factor:.0f} e^{{{fit.rate:.3f}t}}"


def rate():
    paper = stated.CELLS_FIT
    return f"""## The rate of the number of cells

A cell waits W ~ Exp(Λ), then takes T. Far from the start N_p grows as e^{{rt}}
with 2 e^{{-rT}} Λ/(Λ + r) = 1, which for T = 1 day and Λ = 1/day is
r = {renewal.exact():.4f}/day. Over 2 ≤ t ≤ 4 days the expected number of cells,
which began together, fits {expected_fit(0.001)}; Morula places every phase
change at its exact time and differs from that only by chance. Where phases
change at step ends, the wait is rounded up: r is {renewal.rounded_up(0.1):.3f} \
for steps of 0.1 day, and
the expected number fits {expected_fit(0.1)}. The paper's
{paper.factor:.0f} e^{{{paper.rate}t}} is what such rounding gives; its step is \
not stated.
"""


def grids(runs):
    """Outlines, volumes and energies of Fig. 2 (a-e) and, if it is there, of
    the independent solution by finite elements."""
    if not all(runs.has(scene) for scene in GRIDS):
        return ""
    theta = runs["fig-2e"].stretch(runs["fig-2e"].last_output)
    from_fine = distances(runs)
    reference = finite_element_outline(theta)
    from_elements = distances(runs, reference) if reference else {}
    rows = [grid_row(runs[scene], from_fine.get(scene),
                     from_elements.get(scene)) for scene in GRIDS]
    header = ["panel", "h", "L_p", "near: rms, max", "away: rms, max",
              "near FE: rms", "away FE: rms", "apex z", "V_tot, 10⁶ µm³",
              "Ψ_ave, kPa"]
    values = finite_element_values(theta)
    if values is not None:
        rows.append(["FE", *["–"] * 6, *three_values(
            values["apex"], values["total_volume"],
            values["mean_energy_density"])])
    return f"## The grids of Fig. 2, θ = {theta:.3g}\n\n" + markdown(
        header, rows) + f"""

Lengths in µm. Distances are those of the free boundary points from the outline
of (e) and from that of body-fitted finite elements (FE, an independent
solution). "Near" are the points that began less than {outline.NEAR_CLAMP:g} \
µm above the clamp's
edge, "away" the others.
"""


def grid_row(run, from_fine, from_elements):
    last = run.statistics.iloc[-1]
    row = [run.name[-1], f"{run.number('Grid/Spacing'):g}",
           f"{run.number('Tissue/Cell spacing'):g}"]
    row += ([f"{from_fine.near_rms:.1f}, {from_fine.near_max:.1f}",
             f"{from_fine.away_rms:.1f}, {from_fine.away_max:.1f}"]
            if from_fine else ["–"] * 2)
    row += ([f"{from_elements.near_rms:.1f}", f"{from_elements.away_rms:.1f}"]
            if from_elements else ["–"] * 2)
    return row + three_values(last["zmax"], last["total_volume"],
                              last["mean_energy_density"])


def three_values(apex, volume, energy):
    return [f"{apex:.1f}", f"{volume * 1e-6:.2f}", f"{energy:.4f}"]


def findings(runs):
    rows = []
    for scenes, function in FINDINGS:
        missing = [scene for scene in scenes if not runs.has(scene)]
        if missing:
            rows.append([function.__name__.replace("_", " "), "", "not run",
                         "missing: " + ", ".join(missing)])
            continue
        try:
            found = function(runs)
        except (fits.NothingToFit, ValueError) as error:
            rows.append([function.__name__.replace("_", " "), "",
                         "not tested", str(error)])
            continue
        rows.append([found.place, found.claim,
                     "holds" if found.holds else "**does not hold**",
                     found.evidence])
    return "## Findings\n\n" + markdown(
        ["where", "the paper finds", "ours", "by what"], rows) + "\n"


def write_table(output):
    """Writes table.md from the runs that are there and finished."""
    runs = Runs(output)
    parts = ["# The paper's numbers and ours\n", numbers(runs), rate(),
             grids(runs), findings(runs)]
    (output / "table.md").write_text("\n".join(filter(None, parts)),
                                     encoding="utf-8")
