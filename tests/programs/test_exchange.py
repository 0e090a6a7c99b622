# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Cells of two sizes that exchange their places in a closed box: each place keeps its
space, so that both halves stay full while large and small cells mix."""
import numpy
from scipy.spatial import Voronoi

from tests.common.program import ProgramTest, read_csv

EDGE = 120  # of a half, um
SCENE = """
set Dimension = 2
subsection Time
  set End time = 12
  set Step     = 0.1
end
subsection Tissue
  set Shape          = points
  set Points file    = cells.csv
  set Points surface = outline.wkt
end
subsection Grid
  set Spacing = 30
  set Offset  = {offset}
end
subsection Material
  set Energy per        = grown volume
  set Volumetric strain = pooled
end
subsection Boundary conditions
  set Slip where = 1
end
subsection Cell types
  set Names = small, large
end
subsection Rearrangement
  set Diffusion = 100
end
subsection Output
  set Formats  = csv
  set Interval = 0
end
"""


class Exchange(ProgramTest):
    def write_cells(self):
        """Left cells of 100, right ones of 144 um^2."""
        rows = ["x,y,volume,type"]
        for side, n in ((-1, 12), (1, 10)):
            middles = (numpy.arange(n) + 0.5) * EDGE / n
            rows += [f"{side * x:.9g},{y - EDGE / 2:.9g},{(EDGE / n)**2:.9g},"
                     f"{int(side > 0)}" for x in middles for y in middles]
        self.write("cells.csv", "\n".join(rows) + "\n")
        a, b = EDGE, EDGE / 2
        self.write("outline.wkt", f"POLYGON((-{a} -{b}, {a} -{b}, {a} {b}, "
                   f"-{a} {b}, -{a} -{b}))\n")

    def fill(self, cells, side):
        """Volumes of the cells well inside a half over their regions' areas."""
        x = numpy.column_stack([cells["x"], cells["y"]])
        images = [x]
        for axis, wall in ((0, -EDGE), (0, EDGE), (1, -EDGE / 2), (1, EDGE / 2)):
            image = x.copy()
            image[:, axis] = 2 * wall - image[:, axis]
            images.append(image)
        diagram = Voronoi(numpy.concatenate(images))
        volume = area = 0
        for k in numpy.nonzero((side * x[:, 0] > 30) & (side * x[:, 0] < 90) &
                               (abs(x[:, 1]) < 40))[0]:
            px, py = diagram.vertices[diagram.regions[
                diagram.point_region[k]]].T
            area += abs(numpy.dot(px, numpy.roll(py, 1)) -
                        numpy.dot(py, numpy.roll(px, 1))) / 2
            volume += cells["volume"][k]
        return volume / area

    def test_halves_stay_full(self):
        for offset in ("0, 0", "7, 11"):
            self.write_cells()
            output = self.work / f"at-{offset[0]}"
            self.execute(self.write("halves.prm", SCENE.format(offset=offset)),
                         output=output)
            before, after = (read_csv(output / f"cells-{k:04d}.csv")
                             for k in (0, 1))
            exchanges = read_csv(output / "statistics.csv")["exchanges"].sum()
            self.assertGreater(2 * exchanges, 36 * len(before))
            right = after["x"] > 0
            self.assertGreater((after["type"][right] == 0).mean(), 0.1)
            for side in (-1, 1):
                self.assertAlmostEqual(self.fill(before, side), 1, delta=1e-4)
                self.assertAlmostEqual(self.fill(after, side), 1, delta=0.02)

