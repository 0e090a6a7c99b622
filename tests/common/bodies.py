# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Scenes of bodies in contact: blocks, discs, rings."""
import math
import re

SCENE = {"Dimension": 2, "Time/End time": 0.4, "Time/Step": 0.1, "Tissue/Shape": "points",
         "Grid/Spacing": 10, "Cell types/Names": "a, b", "Contact/Between": "bodies",
         "Contact/Bodies": "cell type", "Material/Young's modulus": 1,
         "Material/Poisson's ratio": 0.4, "Output/Formats": "csv", "Output/Interval": 0.1}


def block(low, high, body, left=0, width=60):
    """Cells of 2 um in a block that is 60 um wide."""
    n = round((high - low) / 2)
    step = (high - low) / n
    return [(left + 1 + 2 * i, low + (j + 0.5) * step, 2 * step, body)
            for j in range(n) for i in range(width // 2)]


def rectangle(low, high, left=0, right=60):
    return [(left, low), (right, low), (right, high), (left, high), (left, low)]


def annulus(inner, outer, body, center=0.0):
    """Cells of about 4 um^2 in rings."""
    cells = []
    n = round((outer - inner) / 2)
    for k in range(n):
        a, b = inner + 2 * k, inner + 2 * k + 2
        m = max(3, round(math.pi * (b * b - a * a) / 4))
        r = 2 * (b**3 - a**3) / (3 * (b * b - a * a))
        for j in range(m):
            angle = 2 * math.pi * (j + 0.5 * (k % 2)) / m + 0.1 * k
            cells.append((r * math.cos(angle), center + r * math.sin(angle),
                          math.pi * (b * b - a * a) / m, body))
    return cells


def circle(radius, center=0.0, sign=1, n=400):
    """A polygon with the area of the circle."""
    r = radius * math.sqrt(2 * math.pi / n / math.sin(2 * math.pi / n))
    return [(r * math.cos(2 * math.pi * sign * i / n),
             center + r * math.sin(2 * math.pi * sign * i / n)) for i in range(n + 1)]


def points_files(runs, cells, polygons):
    """The keys for these cells, which may have a type, and for their surface.
    @param polygons lists of closed rings"""
    head = "x,y,volume,type" if len(cells[0]) == 4 else "x,y,volume"
    rows = [",".join(value if isinstance(value, str) else f"{value:.9f}" for value in cell)
            for cell in cells]
    rings = [["(" + ", ".join(f"{x:.9f} {y:.9f}" for x, y in ring) + ")" for ring in polygon]
             for polygon in polygons]
    surface = "MULTIPOLYGON(" + ", ".join(f"({', '.join(all)})" for all in rings) + ")\n"
    return {"Tissue/Points file": runs.write("cells.csv", "\n".join([head, *rows]) + "\n"),
            "Tissue/Points surface": runs.write("surface.wkt", surface)}


def points_scene(runs, cells, polygons):
    """A scene of bodies, which are the types."""
    return {**SCENE, **points_files(runs, cells, polygons)}


def blocks(runs, gap):
    """One above the other."""
    top = 30 + gap
    return points_scene(runs, block(0, 30, "a") + block(top, top + 30, "b"),
                        [[rectangle(0, 30)], [rectangle(top, top + 30)]])


def press(top, way):
    """Keys that move the upper side of the blocks down."""
    return {"Boundary conditions/Slip where": "X < 0.001 || X > 59.999 || Y < 0.001",
            "Boundary conditions/Fixed where": f"Y > {top - 0.001}",
            "Boundary conditions/Displacement": f"0; -({way})", "Tissue/Boundary points": 144}


def assert_pressure_adds_up(run):
    """The integral of the pressure over each body is the normal force on it, and
    the area of a contact that of its points which are pressed, but for patches that
    were split since, whose halves are bent."""
    rows = run.forces[run.forces["kind"] == "contact"]
    for time, at_once in rows.groupby("time"):
        points = run.at("surface", time).query("contact_pressure > 0")
        bodies = [[int(n) for n in re.findall(r"body (\d+)", name)] for name in at_once["name"]]
        for body, of_body in points.groupby("body"):
            force = sum(f for f, of in zip(at_once["force_inward"], bodies) if body in of)
            pressure = (of_body["contact_pressure"] * of_body["area"]).sum()
            assert abs(pressure / force - 1) <= 1e-6
            if body == bodies[0][-1] and len(at_once) == 1:
                assert abs(at_once["area"].iloc[0] / of_body["area"].sum() - 1) <= 1e-3


def contact_rows(run, name=None):
    """Rows of forces.csv of bodies on bodies, or those of a name."""
    rows = run.forces
    assert_pressure_adds_up(run)
    return rows[rows["kind"] == "contact"] if name is None else rows[rows["name"] == name]
