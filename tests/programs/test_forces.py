# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""forces.csv and the forces of boundary points: what presses, holds and loads."""
import numpy as np
from morula.execute import overrides
from morula.run import Run
from tests.common.program import ProgramTest
from scipy.optimize import brentq

PLATES = """
set Dimension = 2
subsection Time
  set End time = 1
  set Step     = 0.25
end
subsection Tissue
  set Shape        = box
  set Size         = 100, 100
  set Cell spacing = 5
end
subsection Grid
  set Spacing = 20
end
subsection Material
  set Poisson's ratio = 0.3
  set Energy per      = grown volume
end
subsection Growth
  set Law = isotropic
  subsection Isotropic
    set Stretch = 1 + 0.2*t
  end
end
subsection Boundary conditions
  set Slip where = abs(Y) > 49.9
end
subsection Output
  set Formats  = csv
  set Interval = 0.5
end
"""
# Held at the left, drawn at the right, pressed from above, lifted by a body force.
PULLED = """
subsection Time
  set End time = 0.4
  set Step     = 0.2
end
subsection Tissue
  set Shape        = box
  set Size         = 80, 60, 60
  set Cell spacing = 10
end
subsection Grid
  set Spacing = 25
end
subsection Boundary conditions
  set Fixed where    = X < -39.9
  set Traction where = X > 39.9
  set Traction       = 0.03*t; 0.01; 0
  set Pressure where = Y > 29.9
  set Pressure       = 0.05
end
subsection Body force
  set Force density = 0; 1e-4; 0
end
subsection Solver
  set Newton tolerance = 1e-10
end
subsection Output
  set Formats  = csv
  set Interval = 0.2
end
"""
VECTORS = ["force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z"]


def force_between_plates(theta, width, E, nu):
    """Of neo-Hookean tissue in plane strain whose height stays, kPa um per um;
    energy per grown volume: theory, section 1."""
    mu, lame = E / 2 / (1 + nu), E * nu / (1 + nu) / (1 - 2 * nu)
    b = 1 / theta
    a = brentq(lambda a: mu * (a * a - 1) + lame * np.log(a * b), 0.5, 2)
    return -width * theta**2 * (mu * (b * b - 1) + lame * np.log(a * b))


class Forces(ProgramTest):
    def run_text(self, text, keys=None, ranks=1, name="output", arguments=()):
        output = self.work / name
        self.execute(self.write(f"{name}.prm", text), *overrides(keys or {}),
                     *arguments, ranks=ranks, output=output)
        return output

    @staticmethod
    def rows(output):
        return Run(output).forces

    def test_plates(self):
        expected = force_between_plates(1.2, 100, 1, 0.3)
        self.assertAlmostEqual(expected, 25.858, delta=1e-3)
        for number, offset in enumerate(("0, 0", "3, 7", "10, 10", "17, 5")):
            output = self.run_text(PLATES, {"Grid/Offset": offset},
                                   name=f"offset-{number}", ranks=1 + number % 2)
            rows = self.rows(output)
            self.assertEqual([*rows["time"]], [0.5, 1])
            last = rows.iloc[-1]
            self.assertEqual((last["kind"], last["name"], last["points"]),
                             ("condition", "slip", 40))
            self.assertAlmostEqual(last["force_inward"] / 2 / expected, 1,
                                   delta=1e-3)
            self.assertAlmostEqual(last["force_y"], 0, delta=1e-3 * expected)
            surface = Run(output).surface(2)
            for side in (-1, 1):
                plate = surface[side * surface["Y"] > 49.9]
                self.assertEqual(len(plate), 20)
                self.assertAlmostEqual(
                    -side * plate["force_y"].sum() / expected, 1, delta=1e-3)
            free = surface[abs(surface["Y"]) < 49.9]
            self.assertEqual(abs(free[["force_x", "force_y"]]).max().max(), 0)

    def check_balance(self, rows, moments=True, tolerance=1e-6):
        for time, now in rows.groupby("time"):
            scale = abs(now[VECTORS]).max()
            sums = now[VECTORS].sum()
            self.assertLess(abs(sums[:3]).max(), tolerance * scale[:3].max(),
                            f"forces at {time}")
            if moments:
                self.assertLess(abs(sums[3:]).max(),
                                tolerance * scale[3:].max(),
                                f"moments at {time}")

    def test_loads_and_reactions_balance(self):
        """In space and in the plane, with the form of the paper, too; the same
        on ranks."""
        plane = {"Dimension": 2, "Tissue/Size": "80, 60",
                 "Boundary conditions/Traction": "0.03*t; 0.01",
                 "Body force/Force density": "0; 1e-4"}
        paper = {"Boundary conditions/Nitsche form": "symmetric"}
        for number, keys in enumerate(({}, plane, {**plane, **paper})):
            rows = self.rows(self.run_text(PULLED, keys, name=f"one-{number}"))
            self.assertEqual(len(rows), 8)
            # With the form of the paper the traction's variation has a moment
            # of its own, gap times traction.
            self.check_balance(rows, moments=number < 2)
            last = rows.iloc[-4:].set_index("name")
            volume = 80 * 60 * (1 if number else 60)
            width = 60 * (1 if number else 60)
            self.assertAlmostEqual(last.loc["body force", "force_y"],
                                   1e-4 * volume, delta=1e-9 * volume)
            self.assertAlmostEqual(last.loc["traction", "force_x"],
                                   0.012 * width, delta=1e-9 * width)
            # a pressure presses on the area of the day
            pressure = last.loc["pressure"]
            self.assertAlmostEqual(
                pressure["force_inward"] / pressure["area"], 0.05, delta=1e-10)
        other = self.rows(self.run_text(PULLED, ranks=2, name="two"))
        one = self.rows(self.work / "one-0")
        np.testing.assert_allclose(other[VECTORS], one[VECTORS], rtol=1e-6,
                                   atol=1e-4)
        self.assertEqual([*other["points"]], [*one["points"]])

    def test_resumed(self):
        """The table goes on, and a point has its force in every state."""
        whole = self.run_text(PULLED, {"Time/End time": 0.8}, name="whole")
        self.run_text(PULLED, name="part")
        part = self.run_text(PULLED, {"Time/End time": 0.8}, name="part",
                             arguments=("--resume",))
        for name in ("forces.csv", "surface-0003.csv", "surface-0004.csv"):
            self.assert_same_file(whole / name, part / name)

    def test_refined_surface(self):
        """Patches that are split share their force."""
        keys = {"Tissue/Refine surface": "true", "Time/End time": 1.5,
                "Tissue/Boundary points": 40}
        output = self.run_text(PLATES, keys, name="refined")
        rows = self.rows(output)
        for number, (_, row) in enumerate(rows.iterrows()):
            surface = Run(output).surface(number + 1)
            side = surface[surface["Y"] > 0]
            self.assertAlmostEqual(
                -side["force_y"].sum() / row["force_inward"], 0.5, delta=1e-3)
        self.assertGreater(len(surface), 40)

    def test_lumen(self):
        """Its pressure on all around, which adds up to nothing."""
        text = """
set Dimension = 2
subsection Time
  set End time = 0.2
  set Step     = 0.1
end
subsection Tissue
  set Radius       = 100
  set Inner radius = 60
  set Cell spacing = 5
end
subsection Grid
  set Spacing = 20
end
subsection Boundary conditions
  set Lumen where  = X^2 + Y^2 < 80^2
  set Lumen volume = 1 + 0.5*t
end
subsection Output
  set Formats = none
end
"""
        output = self.run_text(text)
        row = self.rows(output).iloc[-1]
        pressure = Run(output).statistics["lumen_pressure"].iloc[-1]
        self.assertEqual((row["kind"], row["name"]), ("lumen", "lumen"))
        self.assertGreater(pressure, 0)
        self.assertAlmostEqual(row["force_inward"] / row["area"] / pressure, 1,
                               delta=0.02)
        self.assertLess(abs(row["force_x"]), 0.02 * row["force_inward"])

    def test_nothing_without_conditions(self):
        text = PLATES.replace("set Slip where = abs(Y) > 49.9", "")
        output = self.run_text(text)
        self.assertFalse((output / "forces.csv").exists())
        self.assertNotIn("force_x", Run(output).surface(1).columns)

