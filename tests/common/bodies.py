# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Scenes of bodies in contact: blocks, discs, rings."""
import math

from morula.run import Run
from tests.common.program import ProgramTest, overrides, read_csv

SCENE = """
set Dimension = 2
subsection Time
  set End time = 0.4
  set Step     = 0.1
end
subsection Tissue
  set Shape          = points
  set Points file    = cells.csv
  set Points surface = surface.wkt
end
subsection Grid
  set Spacing = 10
end
subsection Cell types
  set Names = a, b
end
subsection Contact
  set Between = bodies
  set Bodies  = cell type
end
subsection Material
  set Young's modulus = 1
  set Poisson's ratio = 0.4
end
subsection Output
  set Formats  = csv
  set Interval = 0.1
end
"""


def block(low, high, body):
    """Cells of 2 um in a block that is 60 um wide."""
    n = round((high - low) / 2)
    step = (high - low) / n
    return [(1 + 2 * i, low + (j + 0.5) * step, 2 * step, body)
            for j in range(n) for i in range(30)]


def rectangle(low, high):
    return [(0, low), (60, low), (60, high), (0, high), (0, low)]


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
             center + r * math.sin(2 * math.pi * sign * i / n))
            for i in range(n + 1)]


class BodiesTest(ProgramTest):
    def scene(self, cells, polygons, text=SCENE):
        """Writes the files of a scene. @param polygons lists of rings"""
        lines = ["x,y,volume,type"] + [f"{x:.9f},{y:.9f},{v:.9f},{t}"
                                       for x, y, v, t in cells]
        self.write("cells.csv", "\n".join(lines) + "\n")
        self.write("surface.wkt", "MULTIPOLYGON(" + ", ".join(
            "(" + ", ".join("(" + ", ".join(f"{x:.9f} {y:.9f}" for x, y in ring)
                            + ")" for ring in polygon) + ")"
            for polygon in polygons) + ")\n")
        return self.write("scene.prm", text)

    def run_scene(self, scene, keys, ranks=1):
        self.execute(scene, "--replace", *overrides(keys), ranks=ranks)
        return read_csv(self.work / "output/statistics.csv")

    def forces(self):
        """The rows of bodies on bodies."""
        rows = Run(self.work / "output").forces
        return rows[rows["kind"] == "contact"]

    def blocks(self, gap):
        height = 30 + gap
        return self.scene(block(0, 30, "a") + block(height, height + 30, "b"),
                          [[rectangle(0, 30)], [rectangle(height, height + 30)]])

    @staticmethod
    def press(top, way):
        return {"Boundary conditions/Slip where":
                "X < 0.001 || X > 59.999 || Y < 0.001",
                "Boundary conditions/Fixed where": f"Y > {top - 0.001}",
                "Boundary conditions/Displacement": f"0; -({way})",
                "Tissue/Boundary points": "144"}
