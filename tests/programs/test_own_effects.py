# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A program with an effect of its own of each kind, tests/own_effects: its
results by closed forms and against the library's own effects, on one rank and
on two, and resumed.
"""
from pathlib import Path

import numpy

from morula.run import Run
from tests.common.bodies import SCENE as BODIES, BodiesTest, block, rectangle
from tests.common.program import overrides, read_csv, without_wall_time

SCENE = Path(__file__).resolve().parents[1] / "own_effects" / "own.prm"
LIBRARY = overrides({
    "Pull/Density": "0; 0", "Body force/Force density": "0; 1e-4*t*volume/100",
    "Boundary conditions/Drag/Where": "", "Boundary conditions/Drag/Load":
    "0; 0", "Boundary conditions/Traction where": "Y > 49",
    "Boundary conditions/Traction": "0.01*t; 0"})
# Nitsche's penalty is a multiple of Young's modulus, whatever the law.
DOUBLED = overrides({
    "Material/Law": "neo-Hookean", "Material/Young's modulus": "2",
    "Boundary conditions/Nitsche penalty": "1000",
    "Solver/Newton tolerance": "1e-10"})
TWOFOLD = overrides({
    "Material/Young's modulus": "1",
    "Boundary conditions/Nitsche penalty": "2000",
    "Solver/Newton tolerance": "1e-10"})
DIVISION = 0.5  # day
DEATH = 0.3  # day
FOUNDERS, LOST = 100, 9
STEP = 0.125  # day


class OwnProgram(BodiesTest):
    """Runs the program of tests/own_effects."""
    def setUp(self):
        super().setUp()
        library = Path(self.options.morula)
        self.program = library.parent / "tests" / "own-effects"

    def execute(self, *arguments, **options):
        library, self.options.morula = self.options.morula, str(self.program)
        try:
            return super().execute(*arguments, **options)
        finally:
            self.options.morula = library


class OwnEffects(OwnProgram):
    def execute(self, *arguments, **options):
        return super().execute(SCENE, *arguments, **options)

    def check_closed_forms(self, output):
        rows = read_csv(output / "statistics.csv")
        t = rows["time"]
        # the swelling, the law's dose, and the cycle: all whatever the stress is
        left = numpy.where(t < DEATH, FOUNDERS, FOUNDERS - LOST)
        expected = ((1 + 0.04 * t) * (1 + 0.1 * 0.5 * t))**2 * (1 + t)
        numpy.testing.assert_allclose(
            rows["grown_volume"] / rows["grown_volume"][0],
            expected * left / FOUNDERS, rtol=1e-9)  # of ten digits
        self.assertEqual(list(rows["cells"]),
                         list(numpy.where(t < DIVISION - 1e-9, 1, 2) * left))
        self.assertEqual(list(rows["lost"]), [0] * 3 + [LOST] + [0] * 3)
        # cells that live through steps
        numpy.testing.assert_allclose(
            rows["cell_days"], numpy.cumsum(rows["cells"] * rows["dt"]),
            rtol=1e-9)
        events = (output / "events.csv").read_text().splitlines()
        self.assertEqual(events[0], "time,id,event,from,to,cause")
        self.assertEqual(sorted(line.split(",", 2)[2] for line in events[1:]),
                         ["anoikis,,,no hold"] * LOST + ["removal,,,"] * LOST)
        self.assertEqual({line.split(",")[0] for line in events[1:]}, {"0.3"})
        for number, time in enumerate(t):
            cells = read_csv(output / f"cells-{number:04d}.csv")
            # Daughters grow old twice as fast: the pace is 1 + generation.
            age = time if time < DIVISION - 1e-9 else 2 * (time - DIVISION)
            numpy.testing.assert_allclose(cells["age"], age, atol=1e-12)
            # An effect sees what others had at the beginning of the step.
            numpy.testing.assert_allclose(
                cells["earlier_dose"], 0.5 * max(0, time - STEP), atol=1e-12)
            # Growth dilutes both fields alike, and no cell makes any.
            numpy.testing.assert_allclose(
                cells["made"] / (cells["raw"] + cells["made"]),
                -numpy.expm1(-2 * time), rtol=1e-9)
        # Its amount stays, whatever grows, divides and moves, but for that of
        # lost cells, which stood where X > 0; cells of a grid cell share it.
        numpy.testing.assert_allclose(
            rows["amount_shared"] / 100,
            numpy.where(t < DEATH, 1.5 * FOUNDERS, 1.5 * FOUNDERS - 2 * LOST),
            rtol=1e-9)
        first = read_csv(output / "cells-0000.csv")
        self.assertLess(len(set(first["shared"])), FOUNDERS / 4)
        self.assertGreater(first["shared"].max(), 1.5 * first["shared"].min())
        # every cell has divided along y
        cells = read_csv(output / "cells-0004.csv")
        self.assertEqual(len(set(cells["parent"])), FOUNDERS - LOST)
        for mother in set(cells["parent"]):
            pair = cells[cells["parent"] == mother]
            self.assertEqual(len(pair), 2)
            self.assertLess(abs(pair["x"][0] - pair["x"][1]), 1e-9)
            self.assertGreater(abs(pair["y"][0] - pair["y"][1]), 1)

    def test_closed_forms(self):
        for ranks in (1, 2):
            output = self.work / f"ranks-{ranks}"
            self.execute(ranks=ranks, output=output)
            self.check_closed_forms(output)

    def test_force_and_condition_are_the_librarys(self):
        own, library = self.work / "own", self.work / "library"
        self.execute(output=own)
        self.execute(*LIBRARY, output=library)
        self.assertEqual(without_wall_time(own), without_wall_time(library))
        self.assertGreater(read_csv(own / "statistics.csv")["xmax"][-1], 50.5)
        timings = (own / "timings.csv").read_text()
        for section in ("pull", "drag"):
            self.assertIn(section, timings)
        for section in ("body force", "traction"):
            self.assertNotIn(section, timings)

    def test_material_is_twice_as_stiff(self):
        own, library = self.work / "twofold", self.work / "doubled"
        self.execute(*TWOFOLD, output=own)
        self.execute(*DOUBLED, output=library)
        own, library = (read_csv(run / "statistics.csv")
                        for run in (own, library))
        for name in ("mean_energy_density", "total_volume", "xmax", "ymax"):
            numpy.testing.assert_allclose(own[name], library[name], rtol=1e-8,
                                          err_msg=name)
        self.assertGreater(own["mean_energy_density"][-1], 0)

    def test_melting_takes_the_shear(self):
        # Tissue that does not grow, sheared evenly by its whole surface and then
        # held: nothing but the shear is in it.
        still = overrides({
            "Growth/Dose/Uptake": "0", "Swelling/Stretch": "1",
            "Proliferation/Cell cycle/Start": "waiting",
            "Anoikis/Where": "", "Anoikis/After": "0",
            "Boundary conditions/Drag/Load": "0; 0", "Pull/Density": "0; 0",
            "Boundary conditions/Fixed where": "1",
            "Boundary conditions/Displacement": "0.4*Y*min(t, 0.5); 0"})
        shear = []
        for when in ("t > 0.7", "t > 9"):
            output = self.work / when.replace(" ", "")
            self.execute(*still, "-s", f"Melting/When={when}", output=output)
            cells = read_csv(output / "cells-0006.csv")
            shear.append(numpy.abs(cells["sigma_xy"]).mean())
        self.assertLess(shear[0], 0.01 * shear[1])

    def test_resumed(self):
        for ranks in (1, 2):
            whole = self.work / f"whole-{ranks}"
            resumed = self.work / f"resumed-{ranks}"
            self.execute(ranks=ranks, output=whole)
            self.execute("-s", "Time/End time=0.25", ranks=ranks,
                         output=resumed)
            self.execute("--resume", ranks=ranks, output=resumed)
            self.assertEqual(without_wall_time(whole),
                             without_wall_time(resumed))
            for number in range(7):
                name = f"cells-{number:04d}.csv"
                self.assert_same_file(whole / name, resumed / name)

    def test_explained_and_refused(self):
        text = self.execute("--explain").text
        for line in ("dose, Uptake = 0.5, Response = 0.1",
                     "axis = along, Direction = 0, 1, 0",
                     ", Record = true, Pace = 1 + generation",
                     ", Density = 0; 1e-4*t*volume/100",
                     ", Stretch = 1 + 0.04*t", ", When = t > 0.7",
                     ", Where = X > 40 && Y > -40, After = 0.3",
                     ", Rate = 2", ", Take = true",
                     "at 10 boundary points, where Y > 49"):
            self.assertIn(line, text)
        text = self.execute("-s", "Boundary conditions/Drag/Where=Y > 999",
                            code=1).text
        self.assertIn("Boundary conditions/Drag/Where = 'Y > 999'", text)
        # Forces and fates are asked at all founders, before the run.
        for key, value in (("Pull/Density", "log(J_e - 1); 0"),
                           ("Ageing/Pace", "log(J_e - 1)")):
            text = self.execute("-s", f"{key}={value}", code=1).text
            self.assertIn(f"{key} = '{value}'", text)
            self.assertIn("a finite value", text)
        text = self.execute("-s", "Growth/Dose/Uptake=t", code=1).text
        self.assertIn("Growth/Dose/Uptake = 't'", text)


class OwnInteraction(OwnProgram):
    def test_springs_between_blocks(self):
        """Springs hold a block at another one: against its load, and summed up
        over the points; on any ranks, and resumed."""
        k, reach, load = 1e-3, 8.0, 0.05
        scene = self.scene(
            block(0, 30, "a") + block(33, 63, "b"),
            [[rectangle(0, 30)], [rectangle(33, 63)]],
            BODIES.replace("""subsection Contact
  set Between = bodies
  set Bodies  = cell type
""", f"""subsection Tethers
  set Stiffness = {k}
  set Reach     = {reach}
"""))
        keys = {"Boundary conditions/Fixed where": "Y < 0.001",
                "Boundary conditions/Traction where": "Y > 62.999",
                "Boundary conditions/Traction": f"0; 0.02 + {load}*t",
                "Tissue/Boundary points": "144",
                "Output/Snapshot interval": "0.2",
                "Solver/Newton tolerance": "1e-10"}
        output, found = self.work / "output", []
        for ranks in (1, 2, 3):
            self.run_scene(scene, keys, ranks)
            rows = Run(output).forces
            rows = rows[rows["kind"] == "tethers"]
            self.assertEqual(set(rows["name"]), {"body 0 on body 1"})
            numpy.testing.assert_allclose(
                rows["force_y"], -60 * (0.02 + load * rows["time"]), rtol=1e-6)
            found.append(rows["force_y"].iloc[-1])
            before, after = (read_csv(output / f"surface-000{i}.csv")
                             for i in (3, 4))
            force = 0.0
            lower, upper = (before["body"] == body for body in (0, 1))
            for b in numpy.flatnonzero(upper):
                d = numpy.hypot(before["x"][b] - before["x"],
                                before["y"][b] - before["y"])
                faces = (before["nx"][b] * before["nx"]
                         + before["ny"][b] * before["ny"]) < 0
                for c in numpy.flatnonzero(lower & faces & (d <= reach)):
                    force -= (k * before["area"][b] * before["area"][c]
                              * (after["y"][b] - after["y"][c]))
            self.assertAlmostEqual(force / found[-1], 1, delta=1e-5)
        numpy.testing.assert_allclose(found, found[0], rtol=1e-8)
        whole = without_wall_time(output)
        self.run_scene(scene, {**keys, "Time/End time": "0.2"}, 3)
        self.execute(scene, "--resume", *overrides(keys), ranks=3)
        self.assertEqual(whole, without_wall_time(output))
        self.assertIn("tethers", (output / "timings.csv").read_text())
        text = self.execute(
            scene, "-s", "Contact/Between=bodies", code=1).text
        self.assertIn("Tethers/Stiffness = '0.001'", text)
        self.assertIn("bodies have contact already", text)

