# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Live extrusion and the present depth: homeostatic pressure, growth in a rim that stays
at the surface; the same on several ranks and after a resumption."""
import csv

import numpy

from tests.common.program import ProgramTest, overrides, without_wall_time

# A closed box. Cells grow at the rate b and are extruded at the rate k p/p0: at
# rest p = p0 b/k, here 0.5 kPa, in the mean over what they have grown to.
BOX = """
set Dimension = 2
subsection Time
  set End time = 4
  set Step     = 0.1
end
subsection Tissue
  set Shape        = box
  set Size         = 320, 320
  set Cell spacing = 8
end
subsection Grid
  set Spacing = 32
end
subsection Material
  set Energy per        = grown volume
  set Volumetric strain = pooled
  set Relaxation time   = 0.1
end
subsection Growth
  set Law = rate
  subsection Rate
    set Rate = 0.5
  end
end
subsection Division by size
  set Volume = 92
  set Noise  = 0.2
end
subsection Extrusion
  set Rate = max(0, pressure)
end
subsection Boundary conditions
  set Slip where = 1
end
subsection Output
  set Formats  = csv
  set Interval = 0.5
end
"""

# A ball that grows by 0.5 a day in a rim of 20 um, from a radius of 100 um.
RIM = """
set Dimension = {dim}
subsection Time
  set End time = 2
  set Step     = {step}
end
subsection Tissue
  set Shape           = sphere
  set Radius          = 100
  set Cell spacing    = {spacing}
  set Surface cells   = trimmed
  set Refine surface  = true
  set Coarsen surface = true
end
subsection Grid
  set Spacing = {h}
end
subsection Material
  set Energy per        = grown volume
  set Volumetric strain = pooled
  set Relaxation time   = 0.05
end
subsection Growth
  set Law = rate
  subsection Rate
    set Rate = 0.5*(1 - ramp(present_depth, {low}, {high}))
  end
end
subsection Output
  set Formats = csv
end
"""


def rows(path):
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(file))


def column(rows_, name):
    return numpy.array([float(row[name]) for row in rows_])


class Extrusion(ProgramTest):
    def test_homeostatic_pressure(self):
        scene = self.write("box.prm", BOX)
        output = self.work / "output"
        self.execute(scene, output=output)
        pressures = []
        for file in sorted(output.glob("cells-*.csv")):
            cells = rows(file)
            if float(cells[0]["time"]) >= 1.5:
                grown = (column(cells, "volume")
                         / column(cells, "elastic_volume_ratio"))
                trace = sum(column(cells, f"sigma_{axis * 2}") for axis in "xyz")
                pressures.append((-trace / 3 * grown).sum() / grown.sum())
        print("pressure", numpy.mean(pressures), "of 0.5 kPa")
        self.assertAlmostEqual(numpy.mean(pressures) / 0.5, 1, delta=0.05)
        events = rows(output / "events.csv")
        self.assertEqual({event["cause"] for event in events
                          if event["event"] == "death"}, {"extruded"})
        statistics = rows(output / "statistics.csv")
        self.assertEqual(column(statistics, "deaths").sum(),
                         column(statistics, "removed").sum())

    def rim(self, dim, **values):
        scene = self.write(f"rim-{dim}.prm", RIM.format(dim=dim, **values))
        output = self.work / f"rim-{dim}"
        self.execute(scene, output=output)
        last = rows(output / "statistics.csv")[-1]
        volume = float(last["grown_volume"])
        return ((volume / numpy.pi) ** 0.5 if dim == 2 else
                (volume / numpy.pi * 3 / 4) ** (1 / 3))

    def test_rim_in_2d(self):
        # dR/dt = b (w - w^2/2R). By the founder's depth it would be 127.223.
        radius = self.rim(2, spacing=4, h=14, step=0.05, low=18, high=22)
        self.assertAlmostEqual(radius, 118.162, delta=0.4)

    def test_rim_in_3d(self):
        # dR/dt = b (R^3 - (R-w)^3)/3R^2. By the founder's depth: 122.506.
        radius = self.rim(3, spacing=10, h=30, step=0.1, low=15, high=25)
        self.assertAlmostEqual(radius, 116.526, delta=0.5)

    def test_ranks_and_resumption(self):
        scene = self.write("box.prm", BOX)
        short = overrides({"Time/End time": "1.5", "Time/Step": "0.125",
                           "Extrusion/Rate": "0.8*(present_depth < 40)",
                           "Output/Interval": "0"})
        outputs = []
        for ranks in (1, 2, 3):
            outputs.append(self.work / f"ranks-{ranks}")
            self.execute(scene, *short, ranks=ranks, output=outputs[-1])
        first = [(row["id"], row["event"], row["time"])
                 for row in rows(outputs[0] / "events.csv")]
        self.assertGreater(len(first), 100)
        for output in outputs[1:]:
            self.assertEqual(first, [(row["id"], row["event"], row["time"])
                                     for row in rows(output / "events.csv")])
        resumed = self.work / "resumed"
        self.execute(scene, *short, "-s", "Time/End time=0.75", output=resumed)
        self.execute(scene, *short, "--resume", output=resumed)
        self.assertEqual(without_wall_time(outputs[0]), without_wall_time(resumed))
        for table in ("events.csv", "lineage.csv"):
            self.assert_same_file(outputs[0] / table, resumed / table)

