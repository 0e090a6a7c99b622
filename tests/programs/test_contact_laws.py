# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What contact must keep to in any scene: forces that balance, sliding without
friction and without a ripple, no memory after a release, the same in any frame;
and balls that press as elasticity says."""
import math

import numpy as np
import pytest

from tests.common.bodies import (annulus, block, blocks, circle, contact_rows, points_scene, press,
                                 rectangle)
from tests.verification import pressed_ball

FIXED, MOVES = "Boundary conditions/Fixed where", "Boundary conditions/Displacement"
BALLS = {"Time/End time": 9, "Time/Step": 1, "Tissue/Shape": "mesh", "Tissue/Cell spacing": 5,
         "Tissue/Boundary points": 6000, "Grid/Spacing": 10,
         "Grid/Offset": "3, 7, 4", "Contact/Between": "bodies", "Material/Young's modulus": 1,
         "Material/Poisson's ratio": 0.4, "Obstacles/Names": "upper, lower",
         "Obstacles/upper/Shape": "plane", "Obstacles/upper/Center": "0, 0, 122.5",
         "Obstacles/upper/Normal": "0, 0, -1", "Obstacles/upper/Velocity": "0; 0; -1",
         "Obstacles/lower/Shape": "plane", "Obstacles/lower/Center": "0, 0, -122.5",
         "Obstacles/lower/Normal": "0, 0, 1", "Obstacles/lower/Velocity": "0; 0; 1",
         "Output/Formats": "csv", "Output/Interval": 1}


def icosphere(radius, center, fineness=4):
    """Corners and triangles of a closed polyhedron with the volume of the ball."""
    g = (1 + math.sqrt(5)) / 2
    corners = [(x, y * g, 0) for x in (-1, 1) for y in (-1, 1)]
    corners += [(0, x, y * g) for x in (-1, 1) for y in (-1, 1)]
    corners += [(y * g, 0, x) for x in (-1, 1) for y in (-1, 1)]
    corners = np.array(corners, dtype=float)
    triangles = [t for i in range(12) for j in range(i) for k in range(j)
                 for t in [(k, j, i)]
                 if all(abs(np.linalg.norm(corners[a] - corners[b]) - 2) < 1e-9
                        for a, b in ((i, j), (j, k), (k, i)))]
    for _ in range(fineness):
        middles, finer, corners = {}, [], list(corners)

        def middle(a, b):
            key = min(a, b), max(a, b)
            if key not in middles:
                middles[key] = len(corners)
                corners.append((corners[a] + corners[b]) / 2)
            return middles[key]
        for a, b, c in triangles:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        triangles = finer
        corners = np.array([x / np.linalg.norm(x) for x in corners])
    volume, outward = 0.0, []
    for a, b, c in triangles:
        six = np.dot(corners[a], np.cross(corners[b], corners[c]))
        volume += abs(six) / 6
        outward.append((a, b, c) if six > 0 else (a, c, b))
    scale = radius * (4 * math.pi / 3 / volume) ** (1 / 3)
    return corners * scale + np.array(center), np.array(outward)


def test_a_block_slides(runs):
    """A block of 40 um that is pressed on a longer one slides over four grid spacings:
    its weight on the other one stays, and none of it is friction."""
    cells = (block(0, 30, "a", left=-60, width=180)
             + block(30.001, 60.001, "b", left=-10, width=40))
    scene = points_scene(runs, cells, [[rectangle(0, 30, -60, 120)],
                                       [rectangle(30.001, 60.001, -10, 30)]])
    run = runs.run("block", scene, {
        FIXED: "Y < 0.001 || Y > 60",
        MOVES: "if(Y > 30, 40*max(t - 0.2, 0), 0); if(Y > 30, -2*min(t/0.2, 1), 0)",
        "Tissue/Boundary points": 224, "Time/End time": 1.2, "Time/Step": 0.05,
        "Output/Interval": 0.05})
    assert run.statistics["rejected_steps"].sum() == 0
    sliding = contact_rows(run).query("time > 0.201")
    normal = sliding["force_y"]
    assert len(normal) == 20
    assert np.std(normal) / np.mean(normal) < 1e-2
    assert abs(sliding["force_x"]).max() / np.mean(normal) < 1e-2


def test_a_long_layer_slides(runs):
    """A layer of 120 grid spacings that is squeezed out from under another
    one, up to a third of a spacing in a step: the drag that keeps surfaces
    together in a turn does not hold it back."""
    scene = points_scene(runs, block(0, 36, "a", width=1200)
                         + block(36.0001, 72.0001, "b", width=1200),
                         [[rectangle(y, y + 36, 0, 1200)] for y in (0, 36.0001)])
    run = runs.run("layer", scene, {
        "Boundary conditions/Slip where": "X < 0.001 || Y < 0.001", FIXED: "Y > 72",
        MOVES: "0; -7.2*t", "Tissue/Boundary points": 1978, "Grid/Offset": "3.1, 4.7",
        "Time/End time": 0.2, "Time/Step": 0.05})
    assert run.statistics["rejected_steps"].sum() == 0
    assert run.statistics["turns"].max() <= 10
    last = contact_rows(run).iloc[-1]
    assert abs(last["force_x"]) < 6e-3 * abs(last["force_y"])


def test_pressed_and_released(runs):
    """Two blocks that were pressed together by a tenth of their height, and
    released, are as before: no force is left, and no cell is deformed."""
    run = runs.run("released", blocks(runs, 1e-4), {
        **press(60, "6*min(5*t, 2 - 5*t) - 0.5*(t > 0.3)"), "Output/Interval": 0.2})
    assert list(contact_rows(run)["time"]) == [0.2]
    pressed, cells = run.cells(1), run.cells(2)
    assert abs(cells["elastic_volume_ratio"] - 1).max() < 1e-2
    left = abs(cells[["sigma_xx", "sigma_yy", "sigma_xy"]]).max().max()
    assert left < 1e-2 * abs(pressed["sigma_yy"]).max()


def test_frames(runs):
    """Two unequal discs, pressed together aslant, seen in a mirror and turned
    by a quarter, with the grid: the same forces."""
    cells = annulus(0, 20, "a", 20.02) + [(x + 5, y, v, t)
                                          for x, y, v, t in annulus(0, 26, "b", -26.02)]
    rings = [circle(20, 20.02), [(x + 5, y) for x, y in circle(26, -26.02)]]
    found = []
    for frame in (np.array([[1, 0], [0, 1]]), np.array([[-1, 0], [0, 1]]),
                  np.array([[0, -1], [1, 0]])):
        turned = [[tuple(frame @ x) for x in ring] for ring in rings]
        if np.linalg.det(frame) < 0:
            turned = [ring[::-1] for ring in turned]
        across, (one, other) = frame.T
        height = f"({one}*X + {other}*Y)"
        way = f"if({height} > 0, -5*t, 0)"
        scene = points_scene(runs, [(*(frame @ (x, y)), v, t) for x, y, v, t in cells],
                             [[ring] for ring in turned])
        run = runs.run("frame", scene, {
            "Tissue/Boundary points": 300, "Output/Interval": 0.4,
            "Grid/Offset": ", ".join(map(str, frame @ (3, 7))), "Solver/Newton tolerance": 1e-9,
            FIXED: f"abs({height}) > 37", MOVES: f"{one}*{way}; {other}*{way}"})
        force = contact_rows(run).iloc[-1][["force_x", "force_y"]].to_numpy(float)
        found.append(force @ frame)
    np.testing.assert_allclose(found[1:], [found[0]] * 2, rtol=0, atol=1e-4 * abs(found[0][1]))


def test_forces_balance(runs):
    """What the two sides of a slit do to each other is no force on the body."""
    slit = [(0, 0), (60, 0), (60, 60), (0, 60), (0, 30.00005), (30, 30), (0, 29.99995), (0, 0)]
    run = runs.run("slit", points_scene(runs, block(0, 60, "a"), [[slit]]), {
        "Tissue/Boundary points": 300, "Contact/Between": "all",
        "Boundary conditions/Slip where": "Y < 0.001", FIXED: "Y > 59.999", MOVES: "0; -10*t"})
    last = contact_rows(run).iloc[-1]
    assert last["name"] == "body 0 on itself"
    assert last["force_inward"] > 2
    for axis in "xy":
        assert abs(last[f"force_{axis}"]) < 1e-12 * last["force_inward"]


@pytest.mark.release
def test_two_balls_press_as_elasticity_says(runs):
    """Two balls between planes are two times one ball."""
    R, h, gap = 60, 10, 5
    balls = [icosphere(R, (0, 0, sign * (R + gap / 2))) for sign in (1, -1)]
    corners = np.concatenate([x for x, _ in balls])
    triangles = np.concatenate([balls[0][1], balls[1][1] + len(balls[0][0])])
    mesh = runs.write("balls.off", "\n".join(
        ["OFF", f"{len(corners)} {len(triangles)} 0"] + ["%.9f %.9f %.9f" % tuple(x)
                                                         for x in corners]
        + ["3 %d %d %d" % tuple(t) for t in triangles]) + "\n")
    last = runs.run("balls", BALLS, {"Tissue/Surface mesh": mesh}).forces.query("time == 9")
    # A plane gives way by p/kappa, the other ball by half of it.
    ball = pressed_ball.Ball((0.4 / (1.4 * 0.2), 1 / 2.8))
    exact = R**2 * pressed_ball.force(ball, (2 * 9 - gap) / 4 / R, 0.75 * h / 100 / R)
    contact = abs(last[last["kind"] == "contact"].iloc[0]["force_z"])
    walls = abs(last[last["kind"] == "obstacle"]["force_z"])
    np.testing.assert_allclose(walls / contact, 1, atol=1e-2, rtol=0)
    assert abs(contact / exact - 1) <= 3e-2
