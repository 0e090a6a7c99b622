# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Cells that die, shrink and are removed: doc/theory.md, section 6.9."""
import csv

import numpy as np
from morula.run import Run
from tests.common.program import TESTS, ProgramTest, overrides, without_wall_time
from scipy.optimize import least_squares

EXAMPLES = TESTS.parent / "prm/examples"

# A few dozen cells in 2-D that divide, die and shrink.
DISC = """
set Dimension = 2
subsection Time
  set End time = 1
  set Step = 0.125
end
subsection Tissue
  set Shape = sphere
  set Radius = 60
  set Cell spacing = 10
end
subsection Grid
  set Spacing = 30
end
subsection Material
  set Energy per = grown volume
end
subsection Output
  set Formats = csv
  set Interval = 0.25
end
"""
DIVIDING = {"Proliferation/Law": "cell cycle",
            "Proliferation/Cell cycle/Duration": "0.5",
            "Proliferation/Cell cycle/G0 exit rate": "4"}
DYING = {"Death/Rate": "1.5", "Death/Shrinking time": "0.25"}


def rows(file):
    with open(file, newline="", encoding="utf-8") as table:
        return list(csv.DictReader(table))


def ring(inner, outer, spacing):
    """Cells of a ring, in circles: x, y, volume of the sector of each."""
    cells = []
    for i in range(round((outer - inner) / spacing)):
        a, b = inner + spacing * i, inner + spacing * (i + 1)
        n = 4 * round(np.pi * (a + b) / spacing / 4)
        half = np.pi / n
        r = 2 / 3 * (b**3 - a**3) / (b**2 - a**2) * np.sin(half) / half
        angle = 2 * half * (np.arange(n) + 0.5)
        cells.append(np.stack([r * np.cos(angle), r * np.sin(angle),
                               np.full(n, half * (b**2 - a**2))], axis=1))
    return np.concatenate(cells)


def wedge(founders, positions):
    """Of the ring that has opened without strain: by which factor angles have
    shrunk, and how far cells are from where this says (root mean square)."""
    radius = np.hypot(*founders.T)
    angle = np.arctan2(founders[:, 1], founders[:, 0]) % (2 * np.pi)

    def away(values):
        x, y, turn, factor = values
        return np.concatenate([
            x + radius * np.cos(turn + factor * angle) - positions[:, 0],
            y + radius * np.sin(turn + factor * angle) - positions[:, 1]])

    fit = least_squares(away, [0, 0, 0.3, 0.9], x_scale=[1, 1, 0.01, 0.01])
    return fit.x[3], np.sqrt((fit.fun**2).mean())


class Death(ProgramTest):
    def run_disc(self, keys, *arguments, name="output", **more):
        scene = self.write("disc.prm", DISC)
        output = self.work / name
        process = self.execute(scene, *overrides(keys), *arguments,
                               output=output, **more)
        return output, process

    def test_cut(self):
        """A ring with F_g = diag(1, 0.9) along R and Theta opens by 36 degrees,
        and less than a millionth of the energy before is left. Measured: 9e-7,
        and 9e-6 with twice the spacings."""
        np.savetxt(self.work / "ring.csv", ring(150, 300, 1.25),
                   delimiter=",", header="x,y,volume", comments="",
                   fmt="%.12g")
        output = self.work / "output"
        self.execute(EXAMPLES / "cut-and-opening.prm", *overrides({
            "Tissue/Shape": "points", "Grid/Spacing": "6.25",
            "Grid/Points per cell": "2",
            "Tissue/Points file": self.work / "ring.csv",
            "Tissue/Cell spacing": "1.25", "Output/Interval": "0",
            "Output/Formats": "csv",
            "Death/When": "t >= 1 && X > 0 && abs(Y) < 30"}), output=output)
        run = Run(output)
        cells, born = run.cells(-1), run.lineage.table
        factor, error = wedge(born.loc[cells["id"], ["x", "y"]].to_numpy(),
                              cells[["x", "y"]].to_numpy())
        energy = run.statistics["mean_energy_density"]
        print("opening:", 360 * (1 - factor), "energy:",
              energy.iloc[-1] / energy[10])
        self.assertLess(abs(360 * (1 - factor) - 36), 0.01)
        self.assertLess(error, 0.0002)
        self.assertGreater(energy[10], 2e-4)
        self.assertLess(energy.iloc[-1], 1e-6 * energy[10])
        removed = run.events[run.events["event"] == "removal"]
        self.assertEqual({*removed["time"]}, {1.0})
        self.assertEqual(run.statistics["removed"].sum(), len(removed))

    def test_ranks(self):
        """Cells, deaths and removals are the same, byte for byte."""
        keys = {**DIVIDING, **DYING}
        one, _ = self.run_disc(keys, name="1")
        for ranks in (2, 3):
            several, _ = self.run_disc(keys, name=f"{ranks}", ranks=ranks)
            self.assert_same_file(one / "events.csv", several / "events.csv")
            for a, b in zip(rows(one / "lineage.csv"),
                            rows(several / "lineage.csv"), strict=True):
                for name in ("id", "parent", "birth_time"):
                    self.assertEqual(a[name], b[name])
        kinds = [row["event"] for row in rows(one / "events.csv")]
        self.assertGreater(kinds.count("death"), 50)
        self.assertGreater(kinds.count("removal"), 30)

    def test_resume(self):
        keys = {**DIVIDING, **DYING,
                "Death/When": "abs(X) < 5 && t >= 0.3"}
        whole, _ = self.run_disc(keys, name="whole")
        self.run_disc({**keys, "Time/End time": "0.5"}, name="parts")
        parts, _ = self.run_disc(keys, "--resume", name="parts")
        names = sorted(path.name for path in whole.glob("*.csv"))
        self.assertIn("events.csv", names)
        for name in names:
            if name not in ("statistics.csv", "timings.csv"):
                self.assert_same_file(whole / name, parts / name)
        self.assertEqual(without_wall_time(whole), without_wall_time(parts))

    def test_numbers(self):
        """Every table tells the same."""
        output, _ = self.run_disc({**DIVIDING, **DYING,
                                   "Death/When": "X > 35 && t >= 0.5"})
        run = Run(output)
        table = run.statistics
        np.testing.assert_array_equal(
            np.diff(table["cells"]), (table["dividing"] - table["removed"])[1:])
        np.testing.assert_array_equal(
            np.diff(table["dying"]), (table["deaths"] - table["removed"])[1:])
        lineage, last = run.lineage, run.cells(-1)
        self.assertEqual(np.isfinite(lineage.death_time).sum(),
                         table["deaths"].sum())
        there = last["death_time"] < 0
        np.testing.assert_array_equal(lineage.living, last["id"][there])
        for _, cell in last[~there].iterrows():
            died = lineage.death_time[int(cell["id"])]
            self.assertAlmostEqual(cell["death_time"], died, 9)
            self.assertAlmostEqual(cell["remaining_volume"],
                                   1 - 0.95 * (1 - died) / 0.25, 6)
        causes = run.events[run.events["event"] == "death"]["cause"]
        self.assertEqual({*causes}, {"rate", "when"})
        gone = np.isfinite(lineage.removal_time)
        np.testing.assert_allclose(
            lineage.removal_time[gone] - lineage.death_time[gone], 0.25)
        self.assertEqual({*last["phase"][~there]}, {9})

    def test_all_die(self):
        output, process = self.run_disc({"Death/Rate": "15"})
        self.assertIn("Finished: all cells are dead", process.text)
        run = Run(output)
        self.assertEqual(run.statistics["cells"].iloc[-1], 0)
        self.assertLess(run.statistics["time"].iloc[-1], 1)
        self.assertEqual(run.statistics["total_volume"].iloc[-1], 0)
        self.assertTrue(np.isfinite(run.lineage.removal_time).all())
        _, again = self.run_disc({"Death/Rate": "15"}, "--resume")
        self.assertIn("nothing to resume", again.text)

    def test_last_of_a_piece(self):
        """A cut parts the disc; when the smaller part dies its surface goes
        with it, and nothing of it is pulled to the other part."""
        output, _ = self.run_disc({
            "Tissue/Radius": "150", "Death/Shrinking time": "0",
            "Death/When": "abs(X - 50) < 35 || (X > 50 && t >= 0.4)"})
        run = Run(output)
        self.assertGreater(run.surface(1)["x"].max(), 140)
        self.assertGreater(run.cells(1)["x"].max(), 130)
        for kind in (run.cells, run.surface):
            self.assertLess(kind(-1)["x"].max(), 40)
        # the surface of the part that stays has not moved
        np.testing.assert_array_equal(
            run.surface(1)[run.surface(1)["x"] < 40]["x"],
            run.surface(-1)["x"])

    def test_last_cells(self):
        """Cells die until one is left of each piece, and then of all: also one
        cell has a state of equilibrium, and the run ends without any."""
        output, process = self.run_disc({
            "Death/Shrinking time": "0",
            "Death/When": "abs(X) > 10 || abs(Y) > 10"
                          " || t >= 0.4*(noise > 0.5) + 0.4*(X > 0)"})
        self.assertIn("Finished: all cells are dead", process.text)
        table = Run(output).statistics
        self.assertIn(1, {*table["cells"]} | {*table["pieces"]})
        self.assertEqual(table["cells"].iloc[-1], 0)
        self.assertEqual(table["rejected_steps"].sum(), 0)

    def test_with_obstacles_and_coarsening(self):
        """Half of the cells on a plate die. The rest is as large as it was, and
        under little stress: what was left of its dead neighbours has stretched
        it beside them. Its surface is closed where they were."""
        box = {"Tissue/Shape": "box", "Tissue/Size": "120, 60, 60",
               "Tissue/Cell spacing": "10", "Tissue/Refine surface": "true",
               "Tissue/Coarsen surface": "true",
               "Tissue/Renew surface": "0.5",
               "Material/Relaxation time": "0.05",
               "Obstacles/Names": "plate"}
        plate = "Obstacles/plate/"
        output, _ = self.run_disc({
            **box, plate + "Shape": "plane", plate + "Center": "0, -29.5, 0",
            plate + "Normal": "0, 1, 0", "Time/End time": "1.5",
            "Death/When": "X > 0 && t >= 0.25"})
        run = Run(output)
        last = run.statistics.iloc[-1]
        self.assertEqual(last["cells"], 36)
        self.assertEqual(last["dying"], 0)
        self.assertAlmostEqual(last["total_volume"] / 3600, 1, delta=0.02)
        self.assertLess(last["mean_energy_density"], 0.02)
        surface = run.surface(-1)
        self.assertLess(surface["x"].max(), run.cells(-1)["x"].max() + 10)
        self.assertLess(abs((surface["nx"] * surface["area"]).sum()), 1e-6)

    def test_pieces(self):
        """A bar is cut: two pieces, which the user is told once."""
        output, process = self.run_disc({
            "Tissue/Shape": "box", "Tissue/Size": "300, 50, 50",
            "Death/Shrinking time": "0",
            "Death/When": "abs(X) < 50 && t >= 0.25"})
        self.assertEqual([*Run(output).statistics["pieces"]],
                         [1, 1, 1, 2, 2, 2, 2, 2, 2])
        self.assertEqual(process.text.count("the tissue has parted"), 1)
        self.assertIn("it has 2 pieces now, and had 1", process.text)

    def test_rates_that_become_negative(self):
        keys = {"Death/Rate": "0.35 - t"}
        for more in ((), ("--resume",)):
            output, process = self.run_disc(keys, *more, code=2)
            self.assertIn("Death/Rate", process.text)
            self.assertIn("snapshot.h5", process.text)
        self.assertAlmostEqual(float(
            rows(output / "statistics.csv")[-1]["time"]), 0.375)

