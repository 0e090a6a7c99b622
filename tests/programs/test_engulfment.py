# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Halves of a ball, of two types, by tension and exchange of places together: the
spreading coefficients say whether one engulfs the other, both share an interface, or
they part; the same on several ranks and after a resumption."""
import numpy
from scipy.spatial import cKDTree

from tests.common.program import ProgramTest, read_csv

SCENE = """
set Dimension = {dim}
subsection Time
  set End time = 1.5
  set Step     = 0.05
end
subsection Tissue
  set Radius          = {radius}
  set Cell spacing    = {spacing}
  set Refine surface  = true
  set Coarsen surface = true
  set Renew surface   = 0.25
end
subsection Grid
  set Spacing = {h}
  set Offset  = {offset}
end
subsection Material
  set Relaxation time   = 0.05
  set Energy per        = grown volume
  set Volumetric strain = pooled
end
subsection Cell types
  set Names = A, B
  subsection A
    subsection Tension
      set With surface = 2
    end
  end
  subsection B
    set Where = X > 0
    subsection Tension
      set With A       = {between}
      set With surface = {of_b}
    end
  end
end
subsection Rearrangement
  set Diffusion          = 100
  set Fluctuation energy = {energy}
end
subsection Output
  set Formats  = csv
  set Interval = 0.5
end
"""
SIZES = {
    2: dict(radius=70, spacing=5, h=15, offset="3, 7", energy=6),
    3: dict(radius=50, spacing=9, h=25, offset="3, 7, 1", energy=60)
}
# Ranks differ by what Newton's method leaves.
SHORT = ("-s", "Time/End time=0.5", "-s", "Output/Interval=0.25", "-s",
         "Solver/Newton tolerance=1e-10")
# By the tensions of B's surface and of the interface, with 2 of A's surface: A
# spreads on B if B's surface costs more than A's and the interface together; they
# part if the interface costs more than both surfaces.
ENGULF, SHARE, PART = (4, 1), (2, 2), (2, 6)


class Engulfment(ProgramTest):
    def run_scene(self, dim, case, name, *arguments, ranks=1):
        of_b, between = case
        scene = self.write(
            f"{name}.prm",
            SCENE.format(dim=dim,
                         of_b=of_b,
                         between=between,
                         **SIZES[dim]))
        output = self.work / name
        self.execute(scene, *arguments, ranks=ranks, output=output)
        return output

    def state(self, output):
        """Cells at the end; A's share of the surface; distance of the centres."""
        cells = read_csv(output / "cells-0003.csv")
        surface = read_csv(output / "surface-0003.csv")
        places, X = (numpy.column_stack([rows[axis] for axis in "xyz"])
                     for rows in (surface, cells))
        kind, area = cells["type"], surface["area"]
        is_a = kind[cKDTree(X).query(places)[1]] == 0
        centers = [X[kind == k].mean(0) for k in (0, 1)]
        return (cells, area[is_a].sum() / area.sum(),
                numpy.linalg.norm(centers[1] - centers[0]))

    def test_order_by_the_three_tensions(self):
        for dim in (2, 3):
            found = {}
            for case in (ENGULF, SHARE, PART):
                output = self.run_scene(dim, case,
                                        f"{dim}-{case[0]}-{case[1]}")
                _, share, distance = self.state(output)
                found[case] = share, distance / SIZES[dim]["radius"]
            print(dim, found)
            # Halves of a ball: 0.5; balls of half the size that touch: 1.41 and
            # 1.59 radii from centre to centre.
            self.assertGreater(found[ENGULF][0], 0.65)
            self.assertAlmostEqual(found[SHARE][0], 0.5, delta=0.03)
            self.assertAlmostEqual(found[PART][0], 0.5, delta=0.03)
            self.assertLess(found[ENGULF][1], found[SHARE][1] - 0.15)
            self.assertLess(found[SHARE][1], found[PART][1] - 0.3)
            self.assertGreater(found[PART][1], 1.41)

    def test_places_stay_even(self):
        """The flow over the core draws cells out and together; without their
        spreading 5 % of them would be nearer than half a spacing to another."""
        output = self.run_scene(2, ENGULF, "even")
        X, volume = (self.state(output)[0][name] for name in (["x", "y"], "volume"))
        X = numpy.column_stack([X["x"], X["y"]])
        nearest = cKDTree(X).query(X, 2)[0][:, 1] / numpy.sqrt(volume.mean())
        self.assertGreater(numpy.percentile(nearest, 5), 0.55)

    def test_ranks_and_resumption(self):
        for dim in (2, 3):
            outputs = [
                self.run_scene(dim, ENGULF, f"{dim}-on-{ranks}", *SHORT,
                               ranks=ranks) for ranks in (1, 2, 3)
            ]
            one, *others = [read_csv(output / "cells-0002.csv")
                            for output in outputs]
            for other in others:
                for column in ("id", "type"):
                    numpy.testing.assert_array_equal(one[column],
                                                     other[column])
                for axis in "xyz":
                    numpy.testing.assert_allclose(one[axis], other[axis],
                                                  rtol=0, atol=1e-7)
            name = f"{dim}-resumed"
            self.run_scene(dim, ENGULF, name, *SHORT, "-s",
                           "Time/End time=0.25")
            resumed = self.run_scene(dim, ENGULF, name, *SHORT, "--resume")
            self.assert_same_file(outputs[0] / "cells-0002.csv",
                                  resumed / "cells-0002.csv")

