# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Bodies that share splines, from the start or as they grow: the run says so,
once."""
import re

from tests.common.program import ProgramTest, overrides

SCENE = """\
set Dimension = 2
subsection Time
  set End time          = 1
  set Step              = 0.1
end
subsection Tissue
  set Shape       = points
  set Points file = {points}
end
subsection Grid
  set Spacing = 25
end
subsection Growth
  set Law = isotropic
  subsection Isotropic
    set Stretch = 1 + {rate} * t
  end
end
subsection Output
  set Interval          = 0
  set Snapshot interval = 0.1
  set Formats           = csv
end
"""

MESSAGE = re.compile(
    r"Warning: at t = ([0-9.]+) day two parts of the tissue have come within a "
    r"grid spacing of each other near \(([-0-9.e]+) ([-0-9.e]+)\) um\.")

AT_START = re.compile(r"the tissue is (\d+) bodies, and the grid makes (\d+) "
                      r"pieces? of them")


class Joining(ProgramTest):
    def bodies(self, gaps, rate):
        """A scene of bodies of 10 x 10 cells of 10 µm, with these gaps (µm)
        between them along x."""
        rows, left = ["x,y"], 0.0
        for gap in (0.0, *gaps):
            left += gap
            rows += [f"{left + 10 * i + 5},{10 * j + 5}"
                     for i in range(10) for j in range(10)]
            left += 100.0
        points = self.write("cells.csv", "\n".join(rows) + "\n")
        return self.write("bodies.prm", SCENE.format(points=points, rate=rate))

    def said(self, gaps, rate, *arguments, ranks=1):
        """The warnings of a run of such bodies."""
        scene = self.bodies(gaps, rate)
        text = self.execute(scene, *arguments, ranks=ranks).stdout
        found = MESSAGE.findall(text)
        log = (self.work / "output/log.txt").read_text()
        self.assertEqual(len(MESSAGE.findall(log)), len(found))
        return [[float(number) for number in one] for one in found]

    def test_once_with_time_and_place(self):
        """Two joints: the later one is not told of."""
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                said = self.said((60.0, 70.0), 0.6, ranks=ranks)
                self.assertEqual(len(said), 1, said)
                t, x, y = said[0]
                # each body grows by 30 t µm on either side
                gap = 60 - 60 * t
                self.assertGreater(gap, 0)
                self.assertLess(gap, 50)
                self.assertLess(abs(x - 130), 25)
                self.assertLess(abs(y - 50), 100)

    def test_not_of_bodies_that_stay_apart(self):
        self.assertEqual(self.said((60.0,), 0.05), [])

    def test_from_the_start(self):
        """Bodies that share a piece before anything has moved: of three one
        stands alone. A gap of a cell is no gap, and makes no body."""
        for gaps, counts in (((20.0, 70.0), [("3", "2")]), ((20.0,), [("2", "1")]),
                             ((60.0,), []), ((10.0,), [])):
            for ranks in (1, 2):
                with self.subTest(gaps=gaps, ranks=ranks):
                    text = self.execute(self.bodies(gaps, 0.0), "--explain",
                                        *overrides({"Grid/Spacing": 30}),
                                        ranks=ranks)
                    found = AT_START.findall(text.stdout + text.stderr)
                    self.assertEqual(found, counts)

    def test_resumed(self):
        """The first step after --resume has nothing to compare with."""
        self.said((60.0,), 0.6, *overrides({"Time/End time": 0.2}))
        said = self.execute(self.work / "bodies.prm", "--resume").stdout
        self.assertEqual(len(MESSAGE.findall(said)), 1)

