# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A disc whose rim grows and whose core fades, for some days: its size is that of
the equation and its surface stays with its cells, whatever the ranks, and resumed."""
import math

from tests.common.program import ProgramTest, overrides, read_csv

SPACING = 55.0  # um
RADIUS, WIDTH = 300.0, 60.0  # um
GROWTH, LOSS = 0.4, 0.15  # 1/day
SCENE = f"""
set Dimension = 2
subsection Time
  set End time = 6
  set Step     = 0.125
end
subsection Tissue
  set Shape           = sphere
  set Radius          = {RADIUS}
  set Cell spacing    = 18
  set Surface cells   = trimmed
  set Refine surface  = true
  set Coarsen surface = true
end
subsection Grid
  set Spacing = {SPACING}
end
subsection Growth
  set Law = rate
  subsection Rate
    set Rate = if(present_depth < {WIDTH}, {GROWTH}, -{LOSS})
  end
end
subsection Division by size
  set Volume = 324
  set Noise  = 0.2
end
subsection Death
  set When           = volume < 32
  set Shrinking time = 1
end
subsection Boundary conditions
  set Surface tension = 2
end
subsection Material
  set Poisson's ratio   = 0.48
  set Energy per        = grown volume
  set Volumetric strain = pooled
  set Relaxation time   = 0.1
end
subsection Output
  set Formats  = csv
  set Interval = 0.25
end
"""


def radius(days, steps=1000):
    """dR/dt = b (w - w²/2R) - c (R - w)²/2R, by the midpoint rule."""
    def speed(R):
        return (GROWTH * (WIDTH - WIDTH**2 / (2 * R))
                - LOSS * (R - WIDTH)**2 / (2 * R))
    R, dt = RADIUS, days / steps
    for _ in range(steps):
        R += dt * speed(R + 0.5 * dt * speed(R))
    return R


class UnevenGrowth(ProgramTest):
    def test_size_and_surface(self):
        """Without cells that spread they overlap below the surface: boundary
        points are left behind, until they are pulled back at h/2."""
        self.execute(self.write("disc.prm", SCENE), *overrides(
            {"Output/Formats": "none"}), output=self.work / "output")
        rows = read_csv(self.work / "output/statistics.csv")
        start = math.sqrt(rows["enclosed_volume"][0] / math.pi)
        for row in rows[8::8]:
            R = math.sqrt(row["enclosed_volume"] / math.pi)
            print("day", row["time"], "R off:",
                  R * RADIUS / start / radius(row["time"]) - 1,
                  "points off:", row["surface_distance"])
            self.assertLess(abs(R * RADIUS / start / radius(row["time"]) - 1),
                            0.02)
        self.assertLess(rows["surface_distance"].max(), 0.45 * SPACING)

    def test_ranks(self):
        scene = self.write("disc.prm", SCENE)
        cells = []
        for ranks in (1, 2, 3):
            output = self.work / f"ranks-{ranks}"
            self.execute(scene, *overrides({"Time/End time": "0.5"}), ranks=ranks,
                         output=output)
            cells.append(read_csv(output / "cells-0002.csv"))
        for other in cells[1:]:
            self.assertEqual(list(cells[0]["id"]), list(other["id"]))
            for name, scale in (("x", SPACING), ("y", SPACING), ("volume", 324)):
                difference = abs(cells[0][name] - other[name]).max() / scale
                print(name, "differs by", difference)
                self.assertLess(difference, 1e-6, name)

    def test_resumed(self):
        scene = self.write("disc.prm", SCENE)
        whole, parts = self.work / "whole", self.work / "parts"
        end = overrides({"Time/End time": "0.5"})
        self.execute(scene, *end, output=whole)
        self.execute(scene, *overrides({"Time/End time": "0.25"}), output=parts)
        self.execute(scene, *end, "--resume", output=parts)
        self.assertEqual((whole / "cells-0002.csv").read_bytes(),
                         (parts / "cells-0002.csv").read_bytes())
        self.assertEqual((whole / "surface-0002.csv").read_bytes(),
                         (parts / "surface-0002.csv").read_bytes())

