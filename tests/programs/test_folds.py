# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tissue that touches itself: a slit that closes and opens, the arms of a hairpin
that are pressed together and drawn apart."""
import math
import random

import numpy as np
import pytest

from tests.common.bodies import SCENE as BODIES
from tests.common.bodies import contact_rows, points_files, rectangle
from tests.common.program import TESTS, assert_same_run

FIXED, MOVES = "Boundary conditions/Fixed where", "Boundary conditions/Displacement"
SLIP = "Boundary conditions/Slip where"
SCENE = {key: value for key, value in BODIES.items() if key not in (
    "Cell types/Names", "Contact/Bodies")} | {"Contact/Between": "all"}
SNAP = {"Dimension": 2, "Time/Step": 0.05, "Tissue/Refine surface": "true",
        "Tissue/Coarsen surface": "true", "Grid/Spacing": 8, "Contact/Between": "all",
        "Material/Poisson's ratio": 0.45, "Material/Energy per": "grown volume",
        "Material/Volumetric strain": "pooled", "Growth/Law": "rate",
        "Growth/Rate/Share along": 0, "Division by size/Volume": 18,
        "Division by size/Noise": 0.1, "Output/Formats": "csv", "Output/Interval": 0.05}


def polygon(runs, cells, ring):
    return {**SCENE, **points_files(runs, cells, [[[*ring, ring[0]]]])}


class Strip:
    """A strip that is bent by 180 degrees around a gap, along x."""

    def __init__(self, thickness, gap, length):
        self.inner, self.outer = gap / 2, gap / 2 + thickness
        self.length, self.thickness = length, thickness

    def cells(self, side):
        """x, y and area of cells with edges of about this length (um)."""
        n = max(2, round(self.thickness / side))
        across = self.thickness / n
        for k in range(n):
            r = self.inner + (k + 0.5) * across
            for i in range(round(self.length / side)):
                for sign in (-1, 1):
                    yield (i + 0.5) * side, sign * r, side * across
            m = max(3, round(math.pi * r / side))
            for j in range(m):
                angle = math.pi / 2 + (j + 0.5) * math.pi / m
                yield r * math.cos(angle), r * math.sin(angle), math.pi * r / m * across

    def side(self, r, n):
        """One side of the strip, from the lower arm's end to the upper one's."""
        turn = [(r * math.cos(a), r * math.sin(a)) for a in
                (-math.pi / 2 - math.pi * j / n for j in range(1, n))]
        return [(self.length, -r), (0, -r), *turn, (0, r), (self.length, r)]

    def scene(self, runs):
        """In 2-D, closed by 12 um and opened again."""
        scene = polygon(runs, list(self.cells(2)), self.side(self.inner, 24)
                        + self.side(self.outer, 48)[::-1])
        points = round((160 + math.pi * (self.inner + self.outer)) / 2)
        return {**scene, **self.moves(), "Tissue/Boundary points": points}

    def moves(self):
        return {"Time/End time": 2, FIXED: f"X > 10 && abs(Y) > {self.outer - 0.001}",
                MOVES: "0; if(Y > 0, -if(t < 1, 12*t, 12*(2 - t)), 0)"}


def slit(runs, width, noise=0.0):
    """A block of 60 um, slit from its left side to its middle, with cells of
    2 um that are moved by up to this part of that."""
    generator = random.Random(1)
    cells = [(*(1 + 2 * i + 2 * noise * generator.uniform(-1, 1) for i in place), 4)
             for place in ((i, j) for j in range(30) for i in range(30))]
    mouth = [(0, 30 + width / 2), (30, 30), (0, 30 - width / 2)]
    return polygon(runs, cells, [(0, 0), (60, 0), (60, 60), (0, 60)]
                   + (mouth if width > 0 else []))


@pytest.mark.parametrize("offset, noise", [("0, 0", 0), ("3, 7", 0), ("0, 5", 0.2)])
def test_a_slit_carries_pressure_and_no_tension(runs, offset, noise):
    found = {}
    for width, points in ((0, 240), (1e-4, 300)):
        scene = {**slit(runs, width, noise), SLIP: "Y < 0.001", FIXED: "Y > 59.999",
                 "Grid/Offset": offset, "Tissue/Boundary points": points}
        for way in (-10, 10):
            run = runs.run("slit", scene, {MOVES: f"0; {way}*t"})
            found[width, way] = contact_rows(run, "fixed").iloc[-1]["force_y"]
            if width == 0:
                continue
            points_of = run.surface(4)
            at_slit = points_of[(abs(points_of["Y"] - 30) < 0.01)
                                & points_of["X"].between(1, 29)].sort_values("x")
            lower, upper = (np.interp(np.arange(2, 28), side["x"], side["y"]) for side in (
                at_slit[at_slit["ny"] > 0], at_slit[at_slit["ny"] < 0]))
            # p/kappa is 0.009 um
            if way < 0:
                assert np.min(upper - lower) > -0.05
                assert np.max(upper - lower) < 0.01
            else:
                assert np.max(upper - lower) > 2.5
    assert abs(found[1e-4, -10] / found[0, -10] - 1) <= 3e-3
    assert found[1e-4, 10] < 0.9 * found[0, 10]


def check_closing_and_opening(run, dim):
    """Contact begins when the gap of 10 um is used up, and ends when it is
    back, with the same forces on the way in and out."""
    rows = contact_rows(run, "body 0 on itself")
    times = rows["time"].round(6)
    assert times.iloc[0] >= 0.7
    assert times.iloc[-1] <= 1.3
    inward = dict(zip(times, rows["force_inward"]))
    assert abs(inward[0.9] - inward[1.1]) <= (0.03 if dim == 2 else 0.1) * inward[1.0]
    assert inward[1.0] > 5 * inward.get(0.8, 0.0)
    for name in ("force_x", "force_y"):
        assert abs(rows[name]).max() < 1e-9 * inward[1.0]
    if dim == 3:
        assert np.hypot(*rows[["moment_y", "moment_z"]].iloc[-1]) < 0.1 * inward[1.0]


@pytest.mark.parametrize("thickness", [20, 6])
def test_a_hairpin_closes_and_opens(runs, thickness):
    """on any ranks, and resumed in contact bit for bit."""
    scene = Strip(thickness, 10, 40).scene(runs)
    whole = runs.run("hairpin", scene)
    check_closing_and_opening(whole, 2)
    if thickness == 6:
        assert_same_run(whole, runs.resumed("parts", scene, {}, 1.1))
        three = runs.run("three", scene, {"Time/End time": 1}, ranks=3)
        one, other = (run.cells(10) for run in (whole, three))
        np.testing.assert_allclose(one[["x", "y"]], other[["x", "y"]], rtol=0, atol=1e-5)


def test_a_hairpin_in_3d(runs):
    strip, width, side = Strip(10, 10, 40), 10, 2.5
    cells = [(x, y, (k + 0.5) * side, area * side)
             for x, y, area in strip.cells(side) for k in range(4)]
    corners, triangles, rows = [], [], []
    for r in (strip.inner, strip.outer):
        for z in (0, width):
            rows.append(range(len(corners), len(corners) + len(strip.side(r, 12))))
            corners += [(x, y, z) for x, y in strip.side(r, 12)]
    n = len(rows[0])

    def quad(a, b, c, d):
        triangles.extend([(a, b, c), (a, c, d)])
    # around the cross-section, and its two ends
    for one, other in ((0, 1), (1, 3), (3, 2), (2, 0)):
        for i in range(n - 1):
            quad(rows[one][i], rows[one][i + 1], rows[other][i + 1], rows[other][i])
    quad(*(rows[k][0] for k in (0, 1, 3, 2)))
    quad(*(rows[k][n - 1] for k in (2, 3, 1, 0)))
    surface = ["OFF", f"{len(corners)} {len(triangles)} 0",
               *("%.9g %.9g %.9g" % corner for corner in corners),
               *("3 %d %d %d" % triangle for triangle in triangles)]
    rows = ["x,y,z,volume", *("%.9f,%.9f,%.9f,%.9f" % cell for cell in cells)]
    run = runs.run("hairpin-3d", {**SCENE, **strip.moves()}, {
        "Dimension": 3, "Tissue/Points file": runs.write("cells.csv", "\n".join(rows) + "\n"),
        "Tissue/Points surface": runs.write("surface.off", "\n".join(surface) + "\n"),
        "Tissue/Boundary points": 900, MOVES: strip.moves()[MOVES] + "; 0"})
    check_closing_and_opening(run, 3)


def two_blocks(runs):
    """Blocks of 60 um by 30 um, 2 um apart."""
    cells = [(1 + 2 * i, y + 1 + 2 * j, 4) for y in (0, 32) for j in range(15) for i in range(30)]
    return {**SCENE, **points_files(runs, cells, [[rectangle(0, 30)], [rectangle(32, 62)]])}


def test_bodies_touch_as_with_bodies_alone(runs):
    """Two blocks press on each other as where only bodies can touch."""
    scene = {**two_blocks(runs), SLIP: "X < 0.001 || X > 59.999 || Y < 0.001", FIXED: "Y > 61.999",
             MOVES: "0; -15*t", "Tissue/Boundary points": 144}
    one, other = (contact_rows(runs.run("blocks", scene, {"Contact/Between": between}),
                               "body 0 on body 1").iloc[-1]["force_y"]
                  for between in ("bodies", "all"))
    assert abs(one - other) <= 1e-3 * one


@pytest.mark.parametrize("offset", ["0, 0", "3, 7"])
def test_strands_fuse(runs, offset):
    """The sides of a slit, and two blocks, that have been pressed on each
    other for some time are one tissue: it is drawn as if there had been no
    surface."""
    drawn = []
    for make, top, points in ((lambda: slit(runs, 0), 60, 240), (lambda: slit(runs, 1e-4), 60, 300),
                              (lambda: two_blocks(runs), 62, 360)):
        run = runs.run("strands", make(), {
            SLIP: "Y < 0.001", FIXED: f"Y > {top - 0.001}",
            MOVES: f"0; {60 - top} + if(t < 0.35, -3*min(10*t, 1), -3 + 15*(t - 0.35))",
            "Tissue/Boundary points": points, "Tissue/Refine surface": "true",
            "Time/End time": 0.75, "Time/Step": 0.05, "Grid/Offset": offset,
            "Contact/Fusion time": 0.2})
        drawn.append(contact_rows(run, "fixed").iloc[-1]["force_y"])
        rows = run.surface(7)
        assert set(rows["body"]) == {0}
        for axis in "xy":
            assert abs((rows["area"] * rows[f"n{axis}"]).sum()) < 1e-3 * rows["area"].sum()
    np.testing.assert_allclose(np.array(drawn) / drawn[0], 1, atol=3e-3, rtol=0)


def most_crowded(cells):
    """The largest part of a square of 16 um that cells fill: 2 where tissue
    has passed through itself."""
    edges = np.arange(-160, 161, 16)
    filled, _, _ = np.histogram2d(cells["x"], cells["y"], bins=[edges, edges],
                                  weights=cells["volume"])
    return np.max(filled) / 256


def deepest_overlap(points):
    """How deep a point of the surface is in what faces it (um). Between two
    points the other surface is the mean of the chord and of their tangents,
    which is exact for an arc: g of (4.8k) is not where bulges meet."""
    x, n = (points[[name + "x", name + "y"]].to_numpy() for name in ("", "n"))
    deepest = 0.0
    for i in range(len(x)):
        away = x - x[i]
        facing = (n @ n[i] < -0.3) & (np.linalg.norm(away, axis=1) < 10)
        along = away @ np.array([-n[i][1], n[i][0]])
        before, after = facing & (along <= 0), facing & (along > 0)
        if not before.any() or not after.any():
            continue
        one = np.argmax(np.where(before, along, -np.inf))
        other = np.argmin(np.where(after, along, np.inf))
        if along[other] - along[one] > 6:
            continue
        weight = along[other] / (along[other] - along[one])
        gap = sum(w * (away[j] @ n[i] - away[j] @ n[j]) / 2
                  for j, w in ((one, weight), (other, 1 - weight)))
        deepest = max(deepest, -gap)
    return deepest


def test_a_surface_that_snaps_into_folds(runs):
    """A growing layer is smooth, and then has sulci whose sides press on each
    other: nothing faced them before the step in which they met."""
    scene = {**SNAP, "Time/End time": 1, "Tissue/Radius": 80, "Tissue/Cell spacing": 3,
             "Growth/Rate/Rate": "normal(1, 0.01)*(X^2 + Y^2 > 60^2)",
             "Growth/Rate/Direction": "radial"}
    run = runs.run("snaps", scene, {"Friction/Coefficient": 1e-5})
    assert most_crowded(run.cells(16)) < 1.35
    assert run.statistics["rejected_steps"].sum() > 0
    assert run.surface(16)["contact_pressure"].max() > 0.05
    assert deepest_overlap(run.surface(20)) < 0.03 * 8
    # With less friction it snaps within a step.
    alone = runs.run("alone", scene, {
        "Contact/Between": "none", "Friction/Coefficient": 1e-6, "Time/End time": 0.8})
    assert "It may pass through itself there" in alone.said
    assert most_crowded(alone.cells(16)) > 1.7


@pytest.mark.release
def test_a_snap_in_slow_steps(runs):
    """A drag holds a layer back for some steps, also in a resumed run."""
    scene = {**SNAP, "Time/End time": 0.45, "Tissue/Shape": "box", "Tissue/Size": "80, 60",
             "Tissue/Cell spacing": 2.5, "Friction/Coefficient": 1e-6,
             "Growth/Rate/Rate": "normal(1.5, 0.02)*(Y > 10)", "Growth/Rate/Direction": "0; 1",
             SLIP: "abs(X) > 39.999", FIXED: "Y < -29.999"}
    whole = runs.run("slow", scene)
    assert whole.statistics["proximal_paths"].sum() > 3
    assert most_crowded(whole.cells(9)) < 1.35
    assert_same_run(whole, runs.resumed("slow-parts", scene, {}, 0.4))


@pytest.mark.release
def test_creases_close_and_open(runs):
    """A layer grows until it has creases, and shrinks until it has none.
    Planes stand behind the slip walls, which no point of the surface above
    them keeps in its place."""
    planes = {f"Obstacles/{name}/{key}": value for name, side in (("left", 1), ("right", -1))
              for key, value in (("Shape", "plane"), ("Center", f"{-200 * side}, 0"),
                                 ("Normal", f"{side}; 0"))}
    run = runs.run("creases", TESTS.parent / "prm/hard/growing-layer.prm", {
        "Time/End time": 1.36, "Grid/Spacing": 12, "Tissue/Cell spacing": 4,
        "Tissue/Refine surface": "true", "Tissue/Coarsen surface": "true",
        "Contact/Between": "all", "Growth/Isotropic/Stretch": "if(t < 0.85, 1 + t, 2.7 - t)",
        "Obstacles/Names": "left, right", **planes})
    times = contact_rows(run, "body 0 on itself")["time"]
    assert len(times) > 5
    assert max(times) < 1.1

    def depth(time):
        points = run.surface(round(time / 0.02))
        return np.ptp(points["y"][points["Y"] > 79.9])
    assert depth(0.84) > 40
    assert depth(1.36) < 0.2 * depth(0.84)


@pytest.mark.parametrize("n, side", [(2, 2.5), (3, 2.5), (1, 5), (2, 5)])
def test_sheets_do_not_touch_themselves(runs, n, side):
    """The two faces of a bent sheet of few cells are no pair: it moves as
    without contact, whose turns are solved less exactly."""
    cells = [((i + 0.5) * side, (j + 0.5) * side, side * side)
             for i in range(round(100 / side)) for j in range(n)]
    width = n * side
    scene = polygon(runs, cells, [(0, 0), (100, 0), (100, width), (0, width)])
    one, other = (runs.run("sheet", scene, {
        "Contact/Between": between, "Grid/Offset": "3, 7",
        "Tissue/Boundary points": round((200 + 2 * width) / side), FIXED: "X < 0.001",
        "Body force/Force density": f"0; -{4e-7 * width**2}*t"}).cells(4)
        for between in ("all", "none"))
    assert (other["Y"] - other["y"]).max() > 1
    np.testing.assert_allclose(one[["x", "y"]], other[["x", "y"]], atol=1e-6)


def test_what_is_said(runs):
    assert "1 body; folds have contact, too" in runs.explain(slit(runs, 1e-4))
