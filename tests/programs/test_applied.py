# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What the program says before and in a run that a user may not have meant:
pieces that nothing holds, keys that do nothing, times between steps, units."""
import h5py
import numpy as np
from morula.execute import overrides
from morula.run import Run
from tests.common.program import ProgramTest

from tests.common.sealing import seal

BOX = {"Dimension": 2, "Tissue/Shape": "box", "Tissue/Size": "100, 100",
       "Tissue/Cell spacing": 10, "Grid/Spacing": 40, "Time/End time": 0.2,
       "Time/Step": 0.1, "Output/Formats": "none"}
FIXED = "Boundary conditions/Fixed where"
TRACTION = "Boundary conditions/Traction"
HELD = {**BOX, FIXED: "X < -49.9"}
PULLED = {**HELD, TRACTION + " where": "X > 49.9"}
CYCLE = {**BOX, "Proliferation/Law": "cell cycle"}
CUBE = """OFF
8 12 0
0 0 0
80 0 0
80 80 0
0 80 0
0 0 80
80 0 80
80 80 80
0 80 80
3 0 2 1
3 0 3 2
3 4 5 6
3 4 6 7
3 0 1 5
3 0 5 4
3 1 2 6
3 1 6 5
3 2 3 7
3 2 7 6
3 3 0 4
3 3 4 7
"""


def field(**keys):
    return {**BOX, "Fields/Names": "u",
            **{f"Fields/u/{key.replace('_', ' ')}": value
               for key, value in keys.items()}}


def columns_of(group):
    """The places of a snapshot's columns in the rows of its points."""
    places, first = {}, 0
    for line in group["columns"][()][0].decode().split("\n"):
        if line:
            name, n = line.split()
            places[name] = range(first, first + int(n))
            first += int(n)
    return places


def amounts(directory, *fields):
    """Amounts of fields in all cells of a 2-D run's snapshot, and the cells'
    volume: tables have too few digits."""
    with h5py.File(directory / "snapshot.h5") as file:
        rows = file["cells/properties"][()].T
        at = columns_of(file["cells"])
    F = rows[at["deformation"]].T.reshape(-1, 2, 2)
    volume = rows[at["initial_volume"]][0] * np.linalg.det(F)
    return *((volume * rows[at[name]][0]).sum() for name in fields), volume.sum()


class Applied(ProgramTest):
    def run_keys(self, keys, name="output", ranks=1, code=0, arguments=()):
        """The run of these keys, and what it has printed."""
        result = self.execute(self.write(f"{name}.prm", ""), *overrides(keys),
                              *arguments, ranks=ranks, code=code,
                              output=self.work / name)
        return Run(self.work / name) if code == 0 else None, result.text

    def explain(self, keys, name="output"):
        return self.run_words(self.command(
            self.write(f"{name}.prm", ""), "--explain", *overrides(keys))).text

    def points(self, places, name="cells", head="x,y,volume"):
        return self.write(f"{name}.csv", "\n".join(
            [head, *(",".join(f"{x:.12g}" for x in row) for row in places)]))

    def check_words(self, cases):
        """Each scene says its word, and a scene without fault says none."""
        for name, keys, word in cases:
            _, said = self.run_keys(keys, name=name)
            self.assertIn(word, said, name)
        for name, keys in (("plain", HELD), ("pulled", {
                **PULLED, TRACTION: "0.01*t; 0"})):
            self.assertNotIn("Warning", self.run_keys(keys, name=name)[1])

    def test_pieces(self):
        """Of two bodies one is held; the other one is pulled and flies."""
        rows = [(x, y, 25) for y in np.arange(-22.5, 25, 5)
                for x in (*np.arange(-97.5, -20, 5), *np.arange(42.5, 90, 5))]
        keys = {"Dimension": 2, "Time/End time": 0.2, "Time/Step": 0.1,
                "Tissue/Shape": "points", "Tissue/Points file":
                self.points(rows), "Grid/Spacing": 20, "Output/Formats": "none",
                FIXED: "X < -97", TRACTION + " where": "X > 87",
                TRACTION: "0.02*t; 0"}
        held = "160 cells around (-60 0) um: held at 11 boundary points"
        free = ("100 cells around (65 0) um: held nowhere; loads add up to a "
                "force of (0.")
        for ranks in (1, 2):
            run, said = self.run_keys(keys, ranks=ranks, name=f"n{ranks}")
            for text in (said, (run.directory / "log.txt").read_text()):
                self.assertIn("Tissue: 2 bodies in 2 pieces", text)
                self.assertIn("Piece: " + held + "\n", text)
                self.assertIn("Piece: " + free, text)
            self.assertIn("nothing holds the piece of 100 cells", said)
        explained = self.explain(keys)
        self.assertIn(held, explained)
        self.assertIn(free, explained)
        rubbed = {**keys, "Friction/Coefficient": 0.01}
        _, said = self.run_keys(rubbed, name="rubbed")
        self.assertIn("100 cells around (65 0) um: held by friction\n", said)
        self.assertNotIn("nothing holds", said)

    def test_what_inertia_balances(self):
        """Weight, a moment, and a slip plane that does not hold what slides."""
        for name, keys, load in (
                ("weight", {"Body force/Force density": "0; -1e-5"},
                 "a force of (0 -0.1) kPa um and a moment of 0 kPa um^2"),
                # Σ V (x² + y²) c over the lattice's points
                ("turn", {"Body force/Force density": "-1e-6*Y; 1e-6*X"},
                 "a force of (0 0) kPa um and a moment of 16.5 kPa um^2"),
                ("slide", {"Boundary conditions/Slip where": "Y < -49.9",
                           TRACTION + " where": "X > 49.9",
                           TRACTION: "0.01; 0"},
                 "a force of (1 0) kPa um and a moment of 0 kPa um^2")):
            _, said = self.run_keys({**BOX, **keys}, name=name)
            self.assertIn(load, said, name)
            self.assertIn("inertia balances them", said, name)
        for name, keys in (
                ("carried", {"Boundary conditions/Slip where": "Y < -49.9",
                             "Body force/Force density": "0; -1e-5"}),
                ("pressed", {"Boundary conditions/Pressure where": 1,
                             "Boundary conditions/Pressure": 0.01})):
            _, said = self.run_keys({**BOX, **keys}, name=name)
            self.assertNotIn("inertia balances", said, name)

    def test_drift_against_an_obstacle(self):
        plane = {**BOX, "Obstacles/Names": "o", "Obstacles/o/Shape": "plane",
                 "Obstacles/o/Center": "0, -50, 0",
                 "Obstacles/o/Normal": "0, 1, 0"}
        _, said = self.run_keys({**plane, "Body force/Force density":
                                 "0; 1e-6"}, name="up")
        self.assertIn("drag (4.8f) balances", said)
        self.assertIn("drifts until an obstacle stops it", said)
        _, said = self.run_keys({**plane, "Body force/Force density":
                                 "0; -1e-6"}, name="down")
        self.assertNotIn("drifts until", said)

    def test_closed_gap(self):
        """A cavity of 5 x 5 cells in cells of 10 um."""
        inside = 25
        rows = [(x, y, 100) for x in np.arange(-95, 100, 10)
                for y in np.arange(-95, 100, 10)
                if max(abs(x), abs(y)) > inside]
        keys = {"Dimension": 2, "Time/End time": 0.1, "Time/Step": 0.1,
                "Tissue/Shape": "points",
                "Tissue/Points file": self.points(rows), "Grid/Spacing": 40,
                "Tissue/Points surface": "always", "Output/Formats": "csv"}
        word = "the surface around the cells has closed gaps or cavities"
        _, said = self.run_keys({**keys, "Tissue/Closed gap": 8}, name="wide")
        self.assertIn(word, said)
        room = float(said.split("it encloses about ")[1].split(" ")[0])
        self.assertAlmostEqual(room / 3600, 1, delta=0.25)
        run, said = self.run_keys({**keys, "Tissue/Closed gap": 3},
                                  name="narrow")
        self.assertNotIn(word, said)
        surface = run.surface(0)
        self.assertGreater(len(surface[(abs(surface["x"]) < 60) &
                                       (abs(surface["y"]) < 60)]), 10)

    def test_faces_turned_round(self):
        lines = CUBE.splitlines()
        for number, faces in enumerate(((10,), (10, 15, 20), range(10, 22))):
            text = [" ".join([*line.split()[:1], *line.split()[:0:-1]])
                    if i in faces else line for i, line in enumerate(lines)]
            keys = {"Tissue/Shape": "mesh", "Tissue/Surface mesh":
                    self.write(f"cube-{number}.off", "\n".join(text) + "\n"),
                    "Tissue/Cell spacing": 10, "Grid/Spacing": 40,
                    "Time/End time": 0.1, "Time/Step": 0.1,
                    "Output/Formats": "none"}
            run, said = self.run_keys(keys, name=f"turned-{number}")
            self.assertIn(f"{len(faces)} of its 12 faces were turned round",
                          said)
            self.assertIn("Surface mesh: 1 closed surface\n", said)
            self.assertAlmostEqual(run.statistics["total_volume"][0], 80**3)
        keys["Tissue/Surface mesh"] = self.write("cube.off", CUBE)
        self.assertNotIn("turned round", self.run_keys(keys, name="good")[1])

    def test_points_in_metres(self):
        places = [(x, y, 100) for x in np.arange(-45, 50, 10)
                  for y in np.arange(-45, 50, 10)]
        for name, scale in (("m", 1e-6), ("mm", 1e-3)):
            rows = [(x * scale, y * scale, V * scale**2) for x, y, V in places]
            _, said = self.run_keys({
                "Dimension": 2, "Tissue/Shape": "points", "Grid/Spacing": 40,
                "Tissue/Points file": self.points(rows, name),
                "Time/End time": 0.1, "Time/Step": 0.1,
                "Output/Formats": "none"}, name=name)
            self.assertIn("such as m, mm or nm?", said, name)

    def test_loads_that_do_nothing(self):
        idle = "its load is zero at the end of every step."
        self.check_words((
            ("none", PULLED, idle),
            ("zero", {**PULLED, TRACTION: "0; 0"}, idle),
            ("late", {**PULLED, TRACTION: "0.1*(t > 5); 0"}, idle),
            ("behind", {**PULLED, TRACTION + " where": "X < -49.9",
                        TRACTION: "0.1; 0"}, "it acts nowhere: at all 10"),
            ("slides", {**BOX, TRACTION + " where": "X > 49.9",
                        TRACTION: "0.1; 0",
                        "Boundary conditions/Slip where": 1},
             "it acts nowhere: at all 10"),
            ("both", {**PULLED, TRACTION: "0*t; 0*X"}, idle)))
        pull = {**PULLED, TRACTION: "0.01*t; 0", "Time/Smallest step": 0.1}
        for name, keys in (("pull", {TRACTION: "50; 0"}),
                           ("weight", {"Body force/Force density": "0; -1"})):
            said = self.explain({**pull, **keys}, name)
            self.assertIn("times the stiffest cell's E. Is it in Pa?", said)
        said = self.explain({**pull, TRACTION: "1e-7; 0"}, "megapascal")
        self.assertIn("Is it in MPa?", said)

    def test_between_steps(self):
        word = "what happens between the ends of steps is not seen"
        pulse = "(t > 0.12 && t < 0.18)"
        wave = "sin(2*pi*t/0.1)"
        O = {**BOX, "Obstacles/Names": "o", "Obstacles/o/Shape": "plane",
             "Obstacles/o/Center": "0, -60, 0", "Obstacles/o/Normal":
             "0, 1, 0", "Obstacles/o/Velocity": f"0; 10*{wave}; 0"}
        self.check_words((
            ("load", {**PULLED, TRACTION: f"0.01*{pulse}; 0"}, word),
            ("wave", {**PULLED, TRACTION: f"0.01*{wave}; 0"}, word),
            ("rate", {**BOX, "Growth/Law": "rate", "Growth/Rate/Rate":
                      f"2*{pulse}"}, word),
            ("shake", {**HELD, FIXED: "abs(X) > 49.9",
                       "Boundary conditions/Displacement":
                       f"(X > 0)*{wave}; 0"}, word),
            ("value", field(Time="transient", Diffusion=100, Fixed_where="X > "
                            "49.9", Value=f"10*{pulse}"), word),
            ("source", field(Time="transient", Diffusion=100, Initial=1,
                             Production=f"u*{pulse}"), word),
            ("kill", {**BOX, "Death/When": f"X > 0 && {pulse}",
                      "Death/Shrinking time": 0}, word),
            ("obstacle", O, word)))
        types = {**BOX, "Cell types/Names": "a, b", "Cell types/b/Where":
                 "X > 0", "Growth/Law": "rate", "Growth/Rate/Rate": 0.1,
                 "Cell types/b/Growth/Rate/Rate": wave}
        self.assertEqual(self.explain(types, "types").count(word), 1)
        slow = {**PULLED, "Time/Step": 0.01, TRACTION: "0.01*sin(2*pi*t/0.1); 0"}
        for keys in (slow, {**PULLED, TRACTION: "0.01*(t > 0.15); 0"}):
            self.assertNotIn(word, self.run_keys(keys, name="slow")[1])

    def test_keys_that_do_nothing(self):
        alone = "it does nothing without "
        types = {**BOX, "Cell types/Names": "a, b"}
        self.check_words((
            ("yield", {**BOX, "Material/Yield stress": 1}, alone),
            ("rest", {**BOX, "Growth/Law": "rate",
                      "Growth/Rate/Homeostatic stress": -1}, alone),
            ("share", {**BOX, "Growth/Law": "rate", "Growth/Rate/Rate": 0.1,
                       "Growth/Rate/Share along": 0.5}, alone),
            ("tension", {**BOX, "Boundary conditions/Surface tension where":
                         "X > 0"}, alone),
            ("contact", {**BOX, "Contact/Friction": 0.1}, alone),
            ("nitsche", {**BOX, "Boundary conditions/Nitsche penalty": 50},
             alone),
            ("absent", types, "no founder is of this type"),
            ("daughters", {**types, "Cell types/b/Where": "X > 0",
                           "Cell types/a/Daughter types": "a, b"},
             "no cell divides"),
            ("waits", {**CYCLE, "Proliferation/Cell cycle/G0 exit rate": 0},
             "none ever leaves it"),
            ("checked", {**CYCLE, "Proliferation/Cell cycle/Size checkpoint":
                         1.5}, "only stretched cells enter S"),
            ("halves", {**BOX, "Growth/Law": "rate", "Growth/Rate/Rate": 0.1,
                        "Division by size/Volume": 50}, "divide at once"),
            ("enough", {**CYCLE, "Time/Stop at cells": 50},
             "the run ends at its first step"),
            ("step", {**BOX, "Time/Step": 1}, "it is longer than the run"),
            ("interval", {**BOX, "Output/Interval": 6},
             "only its begin and its end are written"),
            ("seconds", {**BOX, "Time/End time": 86400, "Time/Step": 3600},
             "Is it in hours or seconds?"),
            ("nothing", field(Diffusion=100, Consumption=1, Initial=5),
             "it is 0 everywhere"),
            ("shut", field(Diffusion=100, Consumption=1, Transfer=0, Value=1),
             "it is 0 everywhere"),
            ("both", field(Diffusion=1e4, Consumption=1, Fixed_where=1, Value=1,
                           Transfer=5), "Fixed where holds at all"),
            ("corner", field(Diffusion=1e4, Consumption=1, Value=1,
                             Fixed_where="X + Y > 90"), "by a whole patch"),
            ("shallow", field(Diffusion=100, Consumption=1e4, Value=1,
                              Fixed_where=1), "the field reaches only 0.1 um"),
            ("soft", {**BOX, "Material/Young's modulus": "1000*(1 + X/100)"},
             "Is it in Pa or MPa?"),
            ("jump", {**BOX, "Growth/Law": "isotropic",
                      "Growth/Isotropic/Stretch": 1.5},
             "by a factor of up to 1.5"),
            ("still", {**BOX, "Growth/Law": "rate"}, "no cell grows: it"),
            ("nobody", {**BOX, "Death/When": "X > 500", "Death/Shrinking time":
                        0}, "no cell dies by it"),
            ("never", {**BOX, "Death/When": "t > 5", "Death/Shrinking time":
                       0}, "no cell dies by it"),
            ("lattice", {**BOX, "Tissue/Cell spacing": 7},
             "the lattice does not fit the shape")))

    def test_expressions_of_transient_fields(self):
        """A source that begins in mid-run acts in the step that ends there, and
        one that rises has the error of Euler's implicit method."""
        run, _ = self.run_keys(field(Time="transient", Diffusion=100,
                                     Production="t > 0.15"))
        self.assertAlmostEqual(run.statistics["u_mean"].iloc[-1], 0.1)
        run, _ = self.run_keys(field(Time="transient", Diffusion=100,
                                     Production="2*t"), name="ramp")
        self.assertAlmostEqual(run.statistics["u_mean"].iloc[-1], 0.06)

    def test_fields_without_a_state(self):
        for name, keys in (
                ("self", field(Diffusion=100, Production="5*u", Consumption=1,
                               Fixed_where=1, Value=1)),
                ("cycle", {**BOX, "Fields/Names": "a, b",
                           "Fields/a/Diffusion": 100, "Fields/b/Diffusion": 100,
                           "Fields/a/Production": "3*b", "Fields/a/Value": 1,
                           "Fields/b/Production": "3*a",
                           "Fields/a/Consumption": 1, "Fields/b/Consumption": 1,
                           "Fields/a/Fixed where": 1})):
            _, said = self.run_keys(keys, name=name, code=1)
            self.assertIn("has no steady state", said, name)

    def test_amounts_of_fields_that_read_each_other(self):
        keys = {**BOX, "Fields/Names": "a, b", "Time/End time": 1}
        for one, other in ("ab", "ba"):
            keys |= {f"Fields/{one}/Time": "transient",
                     f"Fields/{one}/Diffusion": 100,
                     f"Fields/{one}/Initial": "2*(X > 0)",
                     f"Fields/{one}/Consumption": 3 if one == "a" else 1,
                     f"Fields/{one}/Production":
                     f"{1 if one == 'a' else 3}*{other}"}
        for diffusion in (100, 1e5):
            for one in "ab":
                keys[f"Fields/{one}/Diffusion"] = diffusion
            run, _ = self.run_keys(keys)
            a, b, volume = amounts(run.directory, "a", "b")
            self.assertAlmostEqual((a + b) / (2 * volume), 1, delta=1e-11)
            self.assertLess(a / volume, 0.6)

    def test_amounts_at_removal(self):
        """Cells that go leave the field that they carry, to rounding."""
        keys = {**field(Time="transient", Diffusion=10, Initial=1),
                "Tissue/Size": "96, 96", "Tissue/Cell spacing": 8,
                "Grid/Spacing": 32, "Time/End time": 0.5,
                "Material/Energy per": "grown volume",
                "Material/Volumetric strain": "pooled",
                "Material/Relaxation time": 0.05, "Death/When": "noise < 0.5",
                "Death/Shrinking time": 0.3, "Death/Final volume": 0.05}
        for ranks in (1, 2):
            run, _ = self.run_keys(keys, ranks=ranks, name=f"gone-{ranks}")
            amount, _ = amounts(run.directory, "u")
            self.assertLess(run.statistics["cells"].iloc[-1], 90)
            self.assertAlmostEqual(amount / 96**2, 1, delta=1e-10)

    def test_separate_pieces_of_a_field(self):
        """A value at one of two bodies: nothing tells the level in the other."""
        rows = [(x, y, 100) for y in np.arange(-25, 30, 10)
                for x in (*np.arange(-95, -40, 10), *np.arange(45, 100, 10))]
        keys = {"Dimension": 2, "Time/End time": 0.1, "Time/Step": 0.1,
                "Tissue/Shape": "points", "Tissue/Points file":
                self.points(rows), "Grid/Spacing": 30, "Output/Formats": "none",
                "Fields/Names": "u", "Fields/u/Diffusion": 1000,
                "Fields/u/Fixed where": "X < 0", "Fields/u/Value": 1}
        _, said = self.run_keys(keys)
        self.assertIn("has neither source nor sink of the steady field 'u'",
                      said)
        _, said = self.run_keys({**keys, "Fields/u/Production": 1}, name="made",
                                code=1)
        self.assertIn("of each separate piece of the tissue", said)
        _, said = self.run_keys({**keys, "Fields/u/Consumption": 1},
                                name="used")
        self.assertNotIn("neither source", said)

    def test_obstacles_that_nothing_feels(self):
        ball = {**BOX, "Obstacles/Names": "o", "Obstacles/o/Shape": "sphere",
                "Obstacles/o/Radius": 10}
        _, said = self.run_keys(ball, name="inside")
        self.assertIn("4 cells stand in it", said)
        plane = {**BOX, "Obstacles/Names": "o", "Obstacles/o/Shape": "plane",
                 "Obstacles/o/Center": "0, -500, 0",
                 "Obstacles/o/Normal": "0, 1, 0"}
        for velocity, is_far in (("0; 0.001; 0", True), ("0; 2000; 0", False),
                                 ("0; 5000*cos(400*t); 0", False)):
            said = self.explain({**plane, "Obstacles/o/Velocity": velocity})
            self.assertEqual("they do not meet unless the tissue" in said,
                             is_far, velocity)
        # A plate of 8 um comes 10 um in each step: it must not pass the
        # surface.
        plate = {**HELD, FIXED: "Y > 49.9", "Obstacles/Names": "o",
                 "Obstacles/o/Shape": "box", "Obstacles/o/Size": "200, 8, 8",
                 "Obstacles/o/Center": "0, -60, 0",
                 "Obstacles/o/Velocity": "0; 100; 0", "Output/Formats": "csv"}
        run, _ = self.run_keys(plate, name="plate")
        self.assertGreater(run.surface(1)["y"].min(), -37)

    def test_bodies_that_chance_keeps_apart(self):
        """The same word at every offset: these stick, or may."""
        rows = [(x, y, 25) for y in np.arange(-22.5, 25, 5)
                for x in (*np.arange(-97.5, -20, 5), *np.arange(12.5, 90, 5))]
        for number, offset in enumerate((0, 3, 10, 17)):
            said = self.explain({
                "Dimension": 2, "Tissue/Shape": "points", "Grid/Spacing": 20,
                "Tissue/Points file": self.points(rows),
                "Tissue/Points surface": "always",
                "Grid/Offset": f"{offset}, 0"}, f"offset-{number}")
            self.assertIn("(doc/faq.md, bodies that stick)", said)

    def test_snapshot_without_forces(self):
        """One of a version without this column goes on, and says so."""
        keys = {**PULLED, TRACTION: "0.01*t; 0", "Output/Interval": 0.1}
        whole, _ = self.run_keys({**keys, "Time/End time": 0.4}, name="whole")
        part, _ = self.run_keys(keys, name="part")
        path = part.directory / "snapshot.h5"
        with h5py.File(path, "r+") as file:
            group = file["boundary points"]
            places = columns_of(group)
            left = np.delete(group["properties"][()], places["force"], axis=1)
            less = "".join(f"{name} {len(place)}\n"
                           for name, place in places.items() if name != "force")
            for name, data in (("properties", left),
                               ("columns", np.array([less.encode()]))):
                del group[name]
                group.create_dataset(name, data=data)
        seal(path)
        part, said = self.run_keys({**keys, "Time/End time": 0.4}, name="part",
                                   arguments=["--resume"])
        self.assertIn("lacks the columns force of boundary points", said)
        np.testing.assert_array_equal(part.statistics["xmax"],
                                      whole.statistics["xmax"])

