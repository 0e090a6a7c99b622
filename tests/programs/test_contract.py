# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What other programs rely on: files, columns, number format, keys, options,
and that effects which a scene does not call for are absent.
"""
import json
import re
from pathlib import Path

from tests.common.program import SCENES, ProgramTest, overrides, read_csv

from tests.common.results import read_keys

HERE = Path(__file__).resolve().parent
CUBE = HERE / "small-cube.prm"
SHORT = overrides({"Time/End time": "0.25"})

COLUMNS = {
    "statistics.csv":
        "step,time,dt,cells,total_volume,grown_volume,mean_energy_density,"
        "cell_mean_energy_density,max_energy_density,"
        "min_elastic_volume_ratio,max_elastic_volume_ratio,dividing,"
        "held_at_checkpoint,xmin,xmax,ymin,ymax,zmin,zmax,active_grid_cells,"
        "inner_splines,outer_splines,unknowns,newton_iterations,"
        "linear_iterations,rejected_steps,residual,wall_seconds,"
        "min_cells_per_spacing,turns,proximal_paths,surface_distance,"
        "enclosed_volume",
    "cells-0000.csv":
        "time,id,parent,generation,phase,x,y,z,X,Y,Z,initial_volume,volume,"
        "growth_volume_ratio,elastic_volume_ratio,energy_density,sigma_xx,"
        "sigma_yy,sigma_zz,sigma_xy,sigma_yz,sigma_zx",
    "surface-0000.csv": "time,id,x,y,z,X,Y,Z,nx,ny,nz,area,condition,"
                        "force_x,force_y,force_z",
    "forces.csv": "time,kind,name,points,area,force_x,force_y,force_z,"
                  "moment_x,moment_y,moment_z,force_inward",
    "lineage.csv": "id,parent,generation,birth_time,x,y,z",
    "timings.csv": "section,calls,wall_seconds,share",
    "condition.csv": "step,time,unknowns,smallest,largest,condition",
    "newton.csv": "step,attempt,turn,proximity,iteration,energy,residual,part,"
                  "motion,curvature,smallest_J,x,y,z",
}
ALWAYS = {"parameters.prm", "log.txt", "statistics.csv", "timings.csv",
          "lineage.csv", "snapshot.h5", "forces.csv"}

# The keys of the contract with their defaults.
DEFAULTS = {
    "Dimension": "3", "Output directory": "", "Random seed": "1",
    "Time/End time": "1", "Time/Step": "0.05", "Time/Smallest step": "1e-4",
    "Time/Stop at cells": "0", "Tissue/Shape": "sphere",
    "Tissue/Center": "0, 0, 0", "Tissue/Radius": "250",
    "Tissue/Size": "200, 200, 200", "Tissue/Surface mesh": "",
    "Tissue/Points file": "", "Tissue/Cell spacing": "10",
    "Tissue/Lattice offset": "0, 0, 0", "Tissue/Boundary points": "0",
    "Grid/Spacing": "50", "Grid/Offset": "0, 0, 0",
    "Grid/Occupation parameter": "0.85", "Grid/Extension": "true",
    "Material/Young's modulus": "1.0", "Material/Poisson's ratio": "0.4",
    "Material/Energy per": "initial volume", "Growth/Law": "none",
    "Growth/Isotropic/Stretch": "1", "Proliferation/Law": "none",
    "Proliferation/Cell cycle/Start": "waiting",
    "Proliferation/Cell cycle/Duration": "1",
    "Proliferation/Cell cycle/G0 exit rate": "1",
    "Proliferation/Cell cycle/Size checkpoint": "0",
    "Proliferation/Cell cycle/Where": "1",
    "Proliferation/Cell cycle/Division axis": "random",
    "Proliferation/Cell cycle/Fixed axis": "0, 0, 1",
    "Proliferation/Cell cycle/Axis follows rotation": "false",
    "Boundary conditions/Fixed where": "",
    "Boundary conditions/Displacement": "0; 0; 0",
    "Boundary conditions/Slip where": "",
    "Boundary conditions/Slip normal": "",
    "Boundary conditions/Traction where": "",
    "Boundary conditions/Traction": "0; 0; 0",
    "Boundary conditions/Pressure where": "",
    "Boundary conditions/Pressure": "0",
    "Boundary conditions/Nitsche penalty": "20",
    "Body force/Force density": "0; 0; 0",
    "Solver/Newton tolerance": "1e-6", "Solver/Linear solver": "automatic",
    "Output/Interval": "0.25", "Output/Formats": "vtu",
    "Output/Snapshot interval": "0", "Output/Condition estimate": "false",
    "Output/Newton trace": "false", "Solver/Newton iterations": "400",
}


def as_number(text):
    try:
        return float(text)
    except ValueError:
        return text


class Contract(ProgramTest):
    def files(self, directory="output"):
        return {path.name for path in (self.work / directory).iterdir()}

    def test_csv(self):
        """Columns, no empty fields, %.10g, rows in id order."""
        self.execute(CUBE, ranks=2)
        output = self.work / "output"
        names = ALWAYS | {f"{kind}-{i:04}.csv" for kind in ("cells", "surface")
                          for i in range(3)}
        self.assertEqual(self.files(), names)
        for name in sorted(names):
            if not name.endswith(".csv"):
                continue
            with self.subTest(name):
                header, *rows = (output / name).read_text().splitlines()
                first = re.sub(r"[0-9]{4}", "0000", name)
                self.assertEqual(header, COLUMNS[first])
                self.assertTrue(rows)
                for row in rows:
                    fields = row.split(",")
                    self.assertEqual(len(fields), header.count(",") + 1)
                    words = {"timings.csv": {0}, "forces.csv": {1, 2}}
                    for k, field in enumerate(fields):
                        if k in words.get(name, ()):
                            continue
                        self.assertEqual(field, f"{float(field):.10g}")
                if "id" in header.split(","):
                    ids = list(read_csv(output / name)["id"])
                    self.assertEqual(ids, sorted(set(ids)))

    def test_statistics(self):
        """The rows agree with lineage and cells."""
        self.execute(CUBE)
        output = self.work / "output"
        rows = read_csv(output / "statistics.csv")
        lineage = read_csv(output / "lineage.csv")
        self.assertEqual(list(rows["step"]), list(range(9)))
        self.assertEqual(list(rows["time"]), [k * 0.125 for k in range(9)])
        self.assertEqual(rows["dt"][0], 0)
        self.assertTrue((rows["cells"][1:] - rows["cells"][:-1] ==
                         rows["dividing"][1:]).all())
        self.assertEqual(len(lineage), rows["cells"][0]
                         + 2 * rows["dividing"].sum())
        cells = read_csv(output / "cells-0002.csv")
        parents = set(lineage["parent"])
        alive = [row["id"] for row in lineage if row["id"] not in parents]
        self.assertEqual(list(cells["id"]), alive)
        last = rows[-1]
        near = lambda a, b: self.assertAlmostEqual(a / b, 1.0, 8)
        near(last["total_volume"], cells["volume"].sum())
        near(last["grown_volume"], (cells["initial_volume"] *
                                    cells["growth_volume_ratio"]).sum())
        near(last["cell_mean_energy_density"], cells["energy_density"].mean())
        near(last["mean_energy_density"],
             (cells["initial_volume"] * cells["energy_density"]).sum()
             / cells["initial_volume"].sum())
        near(last["min_elastic_volume_ratio"],
             cells["elastic_volume_ratio"].min())
        surface = read_csv(output / "surface-0002.csv")
        for axis in "xyz":
            self.assertEqual(last[f"{axis}min"], surface[axis].min())
            self.assertEqual(last[f"{axis}max"], surface[axis].max())
        # V0 is the founder's / 2^generation, V = V0 det F_g J_e
        self.assertTrue((cells["initial_volume"] * 2**cells["generation"]
                         == 12**3).all())
        self.assertLess(abs(cells["initial_volume"]
                            * cells["growth_volume_ratio"]
                            * cells["elastic_volume_ratio"]
                            / cells["volume"] - 1).max(), 1e-8)
        # daughters side by side, the mother's birth before theirs
        births = {row["id"]: row for row in lineage}
        for row in lineage[lineage["parent"] >= 0]:
            mother = births[row["parent"]]
            self.assertEqual(row["generation"], mother["generation"] + 1)
            self.assertGreaterEqual(row["birth_time"],
                                    mother["birth_time"] + 0.5 - 1e-9)
        order = lineage[lineage["parent"] >= 0]
        self.assertTrue((order["parent"][::2] == order["parent"][1::2]).all())
        self.assertTrue((order["birth_time"][1:]
                         >= order["birth_time"][:-1]).all())

    def test_held_at_checkpoint(self):
        """With a size checkpoint one more column, the last, whose sum is that
        of statistics.csv; a VTU file has every number once."""
        self.execute(CUBE, *overrides({
            "Proliferation/Cell cycle/Size checkpoint": "1",
            "Output/Formats": "csv, vtu"}))
        output = self.work / "output"
        rows = read_csv(output / "statistics.csv")
        for i, row in ((1, rows[4]), (2, rows[8])):
            name = f"cells-000{i}"
            header = (output / f"{name}.csv").read_text().splitlines()[0]
            self.assertEqual(header, COLUMNS["cells-0000.csv"]
                             + ",held_at_checkpoint")
            cells = read_csv(output / f"{name}.csv")
            held = cells["held_at_checkpoint"]
            self.assertEqual(held.sum(), row["held_at_checkpoint"])
            self.assertGreater(held.sum(), 0)
            self.assertTrue((cells["phase"][held == 1] == 0).all())
            self.assertTrue((cells["elastic_volume_ratio"][held == 1]
                             <= 1).all())
            arrays = re.findall(rb'Name="([^"]+)" NumberOfComponents',
                                (output / f"{name}.vtu").read_bytes())
            self.assertEqual(sorted(a.decode() for a in arrays), sorted(
                "Points connectivity offsets types id parent generation phase "
                "X Y Z initial_volume volume growth_volume_ratio "
                "elastic_volume_ratio energy_density held_at_checkpoint "
                "pressure principal_stress_1 principal_stress_2 "
                "principal_stress_3 displacement sigma".split()))
        arrays = re.findall(rb'Name="([^"]+)" NumberOfComponents',
                            (output / "surface-0002.vtu").read_bytes())
        self.assertEqual(sorted(a.decode() for a in arrays), sorted(
            "Points connectivity offsets types id X Y Z area condition normal "
            "displacement force".split()))

    def test_two_dimensions(self):
        """All columns stay; z columns are 0, sigma_zz is true."""
        self.execute(SCENES / "rigid-box-2d.prm")
        output = self.work / "output"
        cells = read_csv(self.work / "output/cells-0001.csv")
        header = (output / "cells-0001.csv").read_text().splitlines()[0]
        self.assertEqual(header, COLUMNS["cells-0000.csv"])
        for name in ("z", "Z", "sigma_yz", "sigma_zx"):
            self.assertFalse(cells[name].any(), name)
        self.assertTrue((cells["sigma_zz"] < -0.1).all())
        self.assertTrue((cells["phase"] == 9).all())
        surface = read_csv(output / "surface-0001.csv")
        for name in ("z", "Z", "nz"):
            self.assertFalse(surface[name].any(), name)

    def test_formats(self):
        self.execute(CUBE, *SHORT, *overrides({"Output/Formats": "none"}))
        self.assertEqual(self.files(), ALWAYS)
        self.execute(CUBE, *SHORT, *overrides({"Output/Formats": "vtu, csv",
                                               "Output/Interval": "0"}))
        self.assertEqual(self.files(), ALWAYS | {
            "cells.pvd", "surface.pvd",
            *(f"{kind}-000{i}.{end}" for kind in ("cells", "surface")
              for i in (0, 1) for end in ("vtu", "csv"))})
        # a new run replaces the old one, files that are not its own stay
        self.write("output/notes.txt", "kept\n")
        self.execute(CUBE, *SHORT, *overrides({"Output/Formats": "none"}))
        self.assertEqual(self.files(), ALWAYS | {"notes.txt"})

    def test_parameters_as_used(self):
        """parameters.prm has every key, and gives the same run."""
        self.execute(CUBE, *SHORT, *overrides({"Random seed": "9"}))
        keys = read_keys(self.work / "output/parameters.prm")
        self.assertLessEqual(set(DEFAULTS), set(keys))
        self.assertEqual(keys["Random seed"], "9")
        self.assertEqual(float(keys["Time/End time"]), 0.25)
        self.execute(self.work / "output/parameters.prm",
                     output=self.work / "again")
        self.assert_same_file(self.work / "output/cells-0001.csv",
                              self.work / "again/cells-0001.csv")

    def test_parameters_option(self):
        """--parameters: every key of the contract with its default."""
        printed = self.run_words([self.options.morula, "--parameters"]).stdout
        keys = read_keys(self.write("all.prm", printed))
        for key, default in DEFAULTS.items():
            with self.subTest(key):
                self.assertIn(key, keys)
                self.assertEqual(
                    [as_number(part) for part in
                     keys[key].replace(";", ",").split(",")],
                    [as_number(part) for part in
                     default.replace(";", ",").split(",")])

    def test_information(self):
        help_text = self.run_words([self.options.morula, "--help"]).stdout
        for option in ("-s", "--resume", "--replace", "--explain",
                       "--parameters", "--version"):
            self.assertIn(option, help_text)
        version = self.run_words([self.options.morula, "--version"]).stdout
        self.assertRegex(version, r"^Morula \d+\.\d+\.\d+")

    def rows_of_timings(self):
        rows = (self.work / "output/timings.csv").read_text().splitlines()[1:]
        return {row.split(",")[0] for row in rows}

    def explained(self, scene):
        text = self.execute(scene, "--explain").stdout
        self.assertFalse((self.work / "output").exists())
        found = dict(re.findall(r"^  (\S.*?)  +(on|off)\b", text,
                                re.MULTILINE))
        said = json.loads(self.execute(scene, "--explain=json").stdout)
        for effect in said["effects"]:
            self.assertIn(f"  {effect['name']:<24}" + (
                f"on   {effect['description']}" if effect["on"] else "off"),
                text)
        for column in said["columns"]:
            self.assertIn(column["meaning"], text)
        self.assertIn(f" {said['cells']} cells, {said['boundary points']} "
                      "boundary points", text)
        for warning in said["warnings"]:
            self.assertIn(warning, text)
        return found

    def test_explain_counts_founders(self):
        """Those that proliferate, and where."""
        for where, said in (
                ("1", "all 125 founders\n"),
                ("Z > 40", "50 of 125 founders, where Z > 40\n"),
                ("X*Y", "40 of 125 founders, where X*Y\n")):
            text = self.execute(CUBE, "--explain", *overrides(
                {"Proliferation/Cell cycle/Where": where})).stdout
            self.assertIn(f" day, Lambda = 2 /day, {said}", text)

    def test_condition_estimate(self):
        """A row a step, with the time at its beginning; on request only."""
        self.execute(CUBE, *overrides({"Output/Condition estimate": "true"}))
        rows = read_csv(self.work / "output/condition.csv")
        self.assertEqual(",".join(rows.dtype.names), COLUMNS["condition.csv"])
        steps = read_csv(self.work / "output/statistics.csv")
        self.assertEqual(list(rows["step"]), list(steps["step"][1:]))
        self.assertEqual(list(rows["time"]), list(steps["time"][:-1]))
        self.assertEqual(list(rows["unknowns"]), list(steps["unknowns"][1:]))
        self.assertTrue((rows["smallest"] > 0).all())
        self.assertTrue((rows["largest"] > 1).all())
        self.assertTrue((rows["condition"] < 1e6).all())
        self.assertIn("condition estimate", self.rows_of_timings())
        self.execute(CUBE)  # which replaces that run
        self.assertNotIn("condition.csv", self.files())
        self.assertNotIn("condition estimate", self.rows_of_timings())

    def test_newton_trace(self):
        """Every state of every solve; on request only."""
        self.execute(CUBE, *overrides({"Output/Newton trace": "true"}))
        rows = read_csv(self.work / "output/newton.csv")
        self.assertEqual(",".join(rows.dtype.names), COLUMNS["newton.csv"])
        steps = read_csv(self.work / "output/statistics.csv")
        for step, taken, turns, part in zip(
                steps["step"], steps["newton_iterations"], steps["turns"],
                steps["residual"]):
            of_step = rows[rows["step"] == step]
            iterations = []
            for turn in range(1, int(turns) + 1):
                of_turn = list(of_step["iteration"][of_step["turn"] == turn])
                self.assertEqual(of_turn, list(range(len(of_turn))))
                iterations += of_turn[1:]
            self.assertEqual(len(iterations), taken)
            if step > 0:
                self.assertAlmostEqual(
                    of_step["residual"][-1] / of_step["residual"][0] / part, 1,
                    places=6)
        self.assertTrue((rows["smallest_J"] > 0).all())
        self.assertTrue((rows["proximity"] == 0).all())
        self.execute(CUBE)  # which replaces that run
        self.assertNotIn("newton.csv", self.files())

    def test_condition_of_a_failing_step(self):
        """Its row stands there, and is written anew when resumed."""
        scene = SCENES / "without-extension-fails.prm"
        keys = overrides({"Output/Condition estimate": "true"})
        self.execute(scene, *keys, code=2)
        before = (self.work / "output/condition.csv").read_text()
        self.assertEqual(len(before.splitlines()), 2)
        self.execute(scene, *keys, "--resume", code=2)
        self.assertEqual((self.work / "output/condition.csv").read_text(),
                         before)

    def test_absent_effects(self):
        """An effect that a scene does not call for has no row in timings.csv,
        and --explain says that it is off."""
        effects = {"division", "growth", "nitsche", "traction", "pressure",
                   "body force", "rigid motion"}
        scenes = {SCENES / "free-growth-offset.prm": {"growth",
                                                      "rigid motion"},
                  SCENES / "rigid-motion-2d.prm": {"nitsche"},
                  SCENES / "self-weight-h40.prm": {"nitsche", "body force"},
                  SCENES / "balance-traction.prm": {"traction",
                                                    "rigid motion"},
                  SCENES / "mesh-pressure.prm": {"growth", "nitsche",
                                                 "pressure"},
                  CUBE: {"division", "growth", "nitsche", "rigid motion"}}
        names = {"proliferation": "growth", "division (Voronoi)": "division",
                 "fixed points (Nitsche)": "nitsche",
                 "slip (Nitsche)": "nitsche"}
        for scene, present in scenes.items():
            with self.subTest(scene.name):
                on = {names.get(name, name) for name, state
                      in self.explained(scene).items() if state == "on"}
                self.assertEqual(on & effects, present - {"rigid motion"})
                self.execute(scene)
                self.assertEqual(self.rows_of_timings() & effects, present)
                (self.work / "output").rename(self.work / scene.stem)

