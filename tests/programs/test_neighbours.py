# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What cells know of their neighbours, and what they do by it: columns by closed
forms on a lattice, on one rank and on several, and resumed; lateral inhibition; that
scenes without them have nothing of it."""
import csv
import json

import numpy
from tests.common.program import TESTS, ProgramTest, overrides, read_csv

ALL = ("neighbours + neighbours_b + touching_b + unlike + free + around_x + "
       "around_type + around_c")
SCENE = """
set Dimension = 2
subsection Time
  set End time = 0.2
  set Step     = 0.1
end
subsection Tissue
  set Shape        = box
  set Size         = 120, 100
  set Cell spacing = 10
end
subsection Grid
  set Spacing = 30
end
subsection Fields
  set Names = c
  subsection c
    set Diffusion   = 1000
    set Fixed where = abs(X) > 59
    set Value       = 0.5 + X/120
  end
end
subsection Cell types
  set Names = a, b
  subsection b
    set Where = X > 0
    subsection Transitions
      set To a = 0*({all}) + 1e3*(slope_c > 0.0080 && slope_c < 0.0086)*(t > 0.1)
    end
  end
end
subsection Output
  set Formats  = csv
  set Interval = 0.1
end
"""
INHIBITION = TESTS.parent / "prm/examples/lateral-inhibition.prm"


class Neighbours(ProgramTest):
    def cells(self, output, number=0):
        return read_csv(output / f"cells-{number:04d}.csv")

    def test_on_a_lattice(self):
        scene = self.write("lattice.prm", SCENE.format(all=ALL))
        outputs = {}
        for ranks in (1, 2, 3):
            outputs[ranks] = self.work / f"on-{ranks}"
            self.execute(scene, ranks=ranks, output=outputs[ranks])
        cells = self.cells(outputs[1])
        x, y, kind = cells["x"], cells["y"], cells["type"]
        inside = (abs(x) < 50) & (abs(y) < 40)
        rim = abs(y) > 44
        numpy.testing.assert_array_equal(cells["neighbours"][inside], 4)
        numpy.testing.assert_array_equal(
            cells["neighbours"][rim & (abs(x) < 50)], 3)
        numpy.testing.assert_array_equal(
            cells["neighbours"][rim & (abs(x) > 54)], 2)
        left, right = inside & (x > -6) & (x < 0), inside & (x > 0) & (x < 6)
        for column, on_left, on_right in (
                ("neighbours_b", 1, 3), ("touching_b", 0.25, 0.75),
                ("unlike", 0.25, 0.25), ("around_type", 0.25, 0.75)):
            numpy.testing.assert_allclose(cells[column][left], on_left)
            numpy.testing.assert_allclose(cells[column][right], on_right)
        far = inside & (abs(x) > 6)
        numpy.testing.assert_array_equal(cells["unlike"][far], 0)
        numpy.testing.assert_array_equal(cells["neighbours_b"][far],
                                         4 * kind[far])
        # linear things are their own means
        numpy.testing.assert_allclose(cells["around_x"][inside], x[inside],
                                      atol=1e-9)
        numpy.testing.assert_allclose(cells["around_c"][inside],
                                      cells["c"][inside], atol=1e-6)
        numpy.testing.assert_array_equal(cells["free"][inside], 0)
        self.assertTrue((cells["free"][rim] > 0.1).all())
        # slopes have no column, but are known: all have changed by them
        self.assertNotIn("slope_c", cells.dtype.names)
        self.assertEqual(set(self.cells(outputs[1], 2)["type"]), {0})
        for number in (0, 1, 2):
            one = self.cells(outputs[1], number)
            for ranks in (2, 3):
                other = self.cells(outputs[ranks], number)
                for column in one.dtype.names:
                    numpy.testing.assert_allclose(other[column], one[column],
                                                  rtol=1e-8, atol=1e-8)

    def test_by_radius(self):
        scene = self.write("radius.prm", SCENE.format(all=ALL))
        output = self.work / "radius"
        self.execute(scene, *overrides({"Neighbours/Found by": "radius"}),
                     output=output)
        cells = self.cells(output)
        inside = (abs(cells["x"]) < 50) & (abs(cells["y"]) < 40)
        numpy.testing.assert_array_equal(cells["neighbours"][inside], 8)

    def test_lateral_inhibition(self):
        """Random sequential adsorption on the square lattice covers 0.3641 of it,
        whatever the rate times step; no two stand beside each other."""
        output = self.work / "inhibition"
        self.execute(INHIBITION, *overrides(
            {"Tissue/Size": "2000, 2000", "Output/Interval": "3", "Time/Step": 0.125,
             "Time/End time": 3}), output=output)
        cells = self.cells(output, 1)
        senders = cells["type"] == 1
        inside = (abs(cells["x"]) < 950) & (abs(cells["y"]) < 950)
        self.assertAlmostEqual(senders[inside].mean(), 0.3641, delta=0.002)
        self.assertEqual(cells["neighbours_sender"][senders].max(), 0)
        # each that is undecided stays so for a sender beside it, but for the
        # few that had no time
        free = ~senders & (cells["neighbours_sender"] == 0)
        self.assertLess(free.mean(), 1e-4)

    def test_inhibition_on_any_ranks(self):
        """The events of one rank, of steps of any length while rates are constant:
        each has its exact time."""
        tables = {}
        for ranks, step in ((1, 0.125), (2, 0.125), (3, 0.125), (2, 0.5)):
            output = self.work / f"ranks-{ranks}-{step}"
            self.execute(INHIBITION, *overrides(
                {"Tissue/Size": "300, 300", "Time/Step": step, "Time/End time": 1}),
                ranks=ranks, output=output)
            with open(output / "events.csv", encoding="utf-8") as file:
                tables[ranks, step] = zip(*sorted(
                    (int(row["id"]), float(row["time"]))
                    for row in csv.DictReader(file)))
        ids, times = tables.pop((1, 0.125))
        self.assertGreater(len(ids), 250)
        for other_ids, other_times in tables.values():
            numpy.testing.assert_array_equal(other_ids, ids)
            numpy.testing.assert_allclose(other_times, times, atol=1e-12)

    def test_absent(self):
        """A scene of types that asks for nothing has no column, no section."""
        text = SCENE.format(all="0").replace(
            "1e3*(slope_c > 0.0080 && slope_c < 0.0086)*(t > 0.1)", "1")
        output = self.work / "absent"
        self.execute(self.write("absent.prm", text), output=output)
        names = set(self.cells(output).dtype.names)
        self.assertFalse({name for name in names if name.startswith(
            ("neighb", "touch", "unlike", "free", "around", "slope"))})
        timings = (output / "timings.csv").read_text()
        self.assertIn("commit", timings)
        for section in ("neighbours", "rearrangement", "type tension"):
            self.assertNotIn(section, timings)
        self.assertNotIn("exchanges",
                         read_csv(output / "statistics.csv").dtype.names)
        said = self.execute(self.work / "absent.prm", "--explain").stdout
        self.assertIn("  time: about ", said)
        self.assertNotIn("    of it ", said)

    def test_time_is_told(self):
        """Before the run, where neighbours take a large part of it: found by
        distance they take less."""
        def seconds(*words):
            said = json.loads(self.execute(
                INHIBITION, "--explain=json", *words).stdout)["size"]
            self.assertLess(sum(said["seconds of effects"].values()),
                            said["seconds"])
            return said["seconds of effects"]
        facets = seconds()
        self.assertEqual(set(facets), {"neighbours", "transitions"})
        self.assertLess(seconds("-s", "Neighbours/Found by=radius")["neighbours"],
                        facets["neighbours"])
        self.assertIn("of it neighbours: ",
                      self.execute(INHIBITION, "--explain").stdout)

