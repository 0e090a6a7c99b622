# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What other programs rely on: files, columns, number format, options,
and that effects which a scene does not call for are absent.
"""
import json
import re

import numpy as np
import pytest
from morula.prm import parse
from morula.scene import normal

from tests.common.program import SCENES, TESTS, assert_same_file

CUBE = TESTS / "programs/small-cube.prm"
SHORT = {"Time/End time": 0.25}
COLUMNS = {
    "statistics.csv":
        "step,time,dt,cells,total_volume,grown_volume,mean_energy_density,"
        "cell_mean_energy_density,max_energy_density,min_elastic_volume_ratio,"
        "max_elastic_volume_ratio,dividing,held_at_checkpoint,xmin,xmax,ymin,ymax,zmin,zmax,"
        "active_grid_cells,inner_splines,outer_splines,unknowns,newton_iterations,"
        "linear_iterations,rejected_steps,residual,wall_seconds,min_cells_per_spacing,turns,"
        "proximal_paths,close_neighbours,surface_distance,enclosed_volume",
    "cells-0000.csv":
        "time,id,parent,generation,phase,x,y,z,X,Y,Z,initial_volume,volume,growth_volume_ratio,"
        "elastic_volume_ratio,energy_density,sigma_xx,sigma_yy,sigma_zz,sigma_xy,sigma_yz,sigma_zx",
    "surface-0000.csv": "time,id,x,y,z,X,Y,Z,nx,ny,nz,area,condition,force_x,force_y,force_z",
    "forces.csv": "time,kind,name,points,area,force_x,force_y,force_z,moment_x,moment_y,moment_z,"
                  "force_inward",
    "lineage.csv": "id,parent,generation,birth_time,x,y,z",
    "timings.csv": "section,calls,wall_seconds,share",
    "condition.csv": "step,time,unknowns,smallest,largest,condition",
    "newton.csv": "step,attempt,turn,proximity,iteration,energy,residual,part,motion,curvature,"
                  "smallest_J,x,y,z"}
DEFAULTS = {"Dimension": "3", "Output directory": "", "Random seed": "1", "Time/End time": "1",
            "Time/Step": "0.05", "Time/Smallest step": "1e-4", "Time/Stop at cells": "0",
            "Tissue/Shape": "sphere", "Tissue/Center": "0, 0, 0", "Tissue/Radius": "250",
            "Tissue/Size": "200, 200, 200", "Tissue/Surface mesh": "", "Tissue/Points file": "",
            "Tissue/Cell spacing": "10", "Tissue/Lattice offset": "0, 0, 0",
            "Tissue/Boundary points": "0", "Grid/Spacing": "50", "Grid/Offset": "0, 0, 0",
            "Grid/Occupation parameter": "0.85", "Grid/Extension": "true",
            "Material/Young's modulus": "1.0", "Material/Poisson's ratio": "0.4",
            "Material/Energy per": "grown volume", "Growth/Law": "none",
            "Growth/Isotropic/Stretch": "1", "Proliferation/Law": "none",
            "Proliferation/Cell cycle/Start": "waiting", "Proliferation/Cell cycle/Duration": "1",
            "Proliferation/Cell cycle/G0 exit rate": "1",
            "Proliferation/Cell cycle/Size checkpoint": "0", "Proliferation/Cell cycle/Where": "1",
            "Proliferation/Cell cycle/Division axis": "random",
            "Proliferation/Cell cycle/Fixed axis": "0, 0, 1",
            "Proliferation/Cell cycle/Axis follows rotation": "false",
            "Boundary conditions/Fixed where": "", "Boundary conditions/Displacement": "0; 0; 0",
            "Boundary conditions/Slip where": "", "Boundary conditions/Slip normal": "",
            "Boundary conditions/Traction where": "", "Boundary conditions/Traction": "0; 0; 0",
            "Boundary conditions/Pressure where": "", "Boundary conditions/Pressure": "0",
            "Boundary conditions/Nitsche penalty": "20", "Body force/Force density": "0; 0; 0",
            "Solver/Newton tolerance": "1e-6", "Solver/Linear solver": "automatic",
            "Output/Interval": "0.25", "Output/Formats": "vtu", "Output/Snapshot interval": "0",
            "Output/Condition estimate": "false", "Output/Newton trace": "false",
            "Solver/Newton iterations": "400"}
ALWAYS = {"parameters.prm", "log.txt", "statistics.csv", "timings.csv", "lineage.csv",
          "snapshot.h5", "forces.csv", "provenance.json"}
WORDS = {"timings.csv": {0}, "forces.csv": {1, 2}}


@pytest.fixture(scope="module")
def cube(runs):
    """The small cube, on two ranks, with all tables on request."""
    return runs.run("cube", CUBE, {"Output/Condition estimate": "true",
                                   "Output/Newton trace": "true"}, ranks=2)


def files(run):
    return {path.name for path in run.directory.iterdir()}


def test_csv(cube):
    """Columns, no empty fields, %.10g, rows in id order."""
    names = ALWAYS | {"condition.csv", "newton.csv"} | {
        f"{kind}-{i:04}.csv" for kind in ("cells", "surface") for i in range(3)}
    assert files(cube) == names
    for name in (name for name in names if name.endswith(".csv")):
        header, *rows = (cube.directory / name).read_text().splitlines()
        assert header == COLUMNS[re.sub(r"[0-9]{4}", "0000", name)]
        rows = [row.split(",") for row in rows]
        assert rows
        assert {len(fields) for fields in rows} == {header.count(",") + 1}
        numbers = [field for fields in rows for k, field in enumerate(fields)
                   if k not in WORDS.get(name, ())]
        assert numbers == [f"{float(field):.10g}" for field in numbers]
        columns = header.split(",")
        if "id" in columns:
            ids = [float(fields[columns.index("id")]) for fields in rows]
            assert ids == sorted(set(ids))


def test_statistics(cube):
    """The rows agree with lineage and cells."""
    rows, lineage, cells = cube.statistics, cube.lineage.table, cube.cells(2)
    assert list(rows["step"]) == list(range(9))
    assert list(rows["time"]) == [k * 0.125 for k in range(9)]
    assert rows["dt"][0] == 0
    np.testing.assert_array_equal(np.diff(rows["cells"]), rows["dividing"][1:])
    assert len(lineage) == rows["cells"][0] + 2 * rows["dividing"].sum()
    np.testing.assert_array_equal(cells["id"], cube.lineage.living)
    last, initial = rows.iloc[-1], cells["initial_volume"]
    for name, exact in (
            ("total_volume", cells["volume"].sum()),
            ("grown_volume", (initial * cells["growth_volume_ratio"]).sum()),
            ("cell_mean_energy_density", cells["energy_density"].mean()),
            ("mean_energy_density", np.average(cells["energy_density"], weights=initial)),
            ("min_elastic_volume_ratio", cells["elastic_volume_ratio"].min())):
        assert abs(last[name] / exact - 1) <= 5e-9, name
    surface = cube.surface(2)
    for axis in "xyz":
        assert last[f"{axis}min"] == surface[axis].min()
        assert last[f"{axis}max"] == surface[axis].max()
    # V0 is the founder's / 2^generation, V = V0 det F_g J_e
    assert (initial * 2**cells["generation"] == 12**3).all()
    product = initial * cells["growth_volume_ratio"] * cells["elastic_volume_ratio"]
    assert abs(product / cells["volume"] - 1).max() < 1e-8


def test_lineage(cube):
    """Daughters side by side, the mother's birth before theirs."""
    born = cube.lineage.table.query("parent >= 0")
    mothers = cube.lineage.table.loc[born["parent"].astype(int)]
    np.testing.assert_array_equal(born["generation"], mothers["generation"] + 1)
    assert (born["birth_time"].to_numpy() >= mothers["birth_time"].to_numpy() + 0.5 - 1e-9).all()
    np.testing.assert_array_equal(born["parent"][::2], born["parent"][1::2])
    assert born["birth_time"].is_monotonic_increasing


def arrays(file):
    return sorted(name.decode() for name in re.findall(rb'Name="([^"]+)" NumberOfComponents',
                                                       file.read_bytes()))


def test_held_at_checkpoint(runs):
    """With a size checkpoint one more column, the last, whose sum is that
    of statistics.csv; a VTU file has every number once."""
    run = runs.run("held", CUBE, {"Proliferation/Cell cycle/Size checkpoint": 1,
                                  "Output/Formats": "csv, vtu"})
    for i in (1, 2):
        table = (run.directory / f"cells-000{i}.csv").read_text().splitlines()
        assert table[0] == COLUMNS["cells-0000.csv"] + ",held_at_checkpoint"
        cells = np.genfromtxt(table, delimiter=",", names=True)
        held = cells["held_at_checkpoint"] == 1
        assert 0 < held.sum() == run.statistics["held_at_checkpoint"][4 * i]
        assert (cells["phase"][held] == 0).all()
        assert (cells["elastic_volume_ratio"][held] <= 1).all()
        assert arrays(run.directory / f"cells-000{i}.vtu") == sorted(
            "Points connectivity offsets types id parent generation phase X Y Z initial_volume "
            "volume growth_volume_ratio elastic_volume_ratio energy_density held_at_checkpoint "
            "pressure principal_stress_1 principal_stress_2 principal_stress_3 displacement "
            "sigma".split())
    assert arrays(run.directory / "surface-0002.vtu") == sorted(
        "Points connectivity offsets types id X Y Z area condition normal displacement "
        "force".split())


def test_two_dimensions(runs):
    """All columns stay; z columns are 0, sigma_zz is true."""
    run = runs.run("flat", SCENES / "rigid-box-2d.prm")
    cells = run.cells(1)
    assert ",".join(cells.columns) == COLUMNS["cells-0000.csv"]
    assert not cells[["z", "Z", "sigma_yz", "sigma_zx"]].any().any()
    assert (cells["sigma_zz"] < -0.1).all()
    assert (cells["phase"] == 9).all()
    assert not run.surface(1)[["z", "Z", "nz"]].any().any()


def test_formats(runs):
    keys = {**SHORT, "Output/Formats": "none"}
    run = runs.run("formats", CUBE, keys)
    assert files(run) == ALWAYS
    runs.run("formats", CUBE, {**SHORT, "Output/Formats": "vtu, csv", "Output/Interval": 0})
    assert files(run) == ALWAYS | {
        "cells.pvd", "surface.pvd", *(f"{kind}-000{i}.{end}" for kind in ("cells", "surface")
                                      for i in (0, 1) for end in ("vtu", "csv"))}
    # a new run replaces the old one, files that are not its own stay
    (run.directory / "notes.txt").write_text("kept\n")
    runs.run("formats", CUBE, keys)
    assert files(run) == ALWAYS | {"notes.txt"}


def test_parameters_as_used(runs):
    """parameters.prm has every key of --parameters, and gives the same run."""
    run = runs.run("used", CUBE, {**SHORT, "Random seed": 9})
    printed = parse(runs.call([runs.options.morula, "--parameters"]).stdout)
    assert set(printed) <= set(run.keys)
    assert ({key: normal(printed[key]) for key in DEFAULTS}
            == {key: normal(DEFAULTS[key]) for key in DEFAULTS})
    assert run.keys["Random seed"] == "9"
    assert run.number("Time/End time") == 0.25
    again = runs.run("again", run.directory / "parameters.prm")
    assert_same_file(run.directory / "cells-0001.csv", again.directory / "cells-0001.csv")


def test_information(runs):
    help_text = runs.call([runs.options.morula, "--help"]).stdout
    for option in ("-s", "--resume", "--replace", "--explain", "--parameters", "--version"):
        assert option in help_text
    version = runs.call([runs.options.morula, "--version"]).stdout
    assert re.search(r"^Morula \d+\.\d+\.\d+", version)


@pytest.mark.parametrize("where, said", [
    ("1", "all 125 founders\n"), ("Z > 40", "50 of 125 founders, where Z > 40\n"),
    ("X*Y", "40 of 125 founders, where X*Y\n")])
def test_explain_counts_founders(runs, where, said):
    """Those that proliferate, and where."""
    text = runs.explain(CUBE, {"Proliferation/Cell cycle/Where": where})
    assert f"G0 exit rate = 2 1/day, Cell cycle/Where = {where}, {said}" in text


def test_condition_estimate(cube):
    """A row a step, with the time at its beginning."""
    rows = np.genfromtxt(cube.directory / "condition.csv", delimiter=",", names=True)
    steps = cube.statistics
    np.testing.assert_array_equal(rows["step"], steps["step"][1:])
    np.testing.assert_array_equal(rows["time"], steps["time"][:-1])
    np.testing.assert_array_equal(rows["unknowns"], steps["unknowns"][1:])
    assert (rows["smallest"] > 0).all()
    assert (rows["largest"] > 1).all()
    assert (rows["condition"] < 1e6).all()
    assert "condition estimate" in cube.timings.index


def test_newton_trace(cube):
    """Every state of every solve."""
    rows = np.genfromtxt(cube.directory / "newton.csv", delimiter=",", names=True)
    for _, step in cube.statistics.iterrows():
        of_step = rows[rows["step"] == step["step"]]
        iterations = []
        for turn in range(1, int(step["turns"]) + 1):
            of_turn = list(of_step["iteration"][of_step["turn"] == turn])
            assert of_turn == list(range(len(of_turn)))
            iterations += of_turn[1:]
        assert len(iterations) == step["newton_iterations"]
        if step["step"] > 0:
            part = of_step["residual"][-1] / of_step["residual"][0]
            assert abs(part / step["residual"] - 1) <= 5e-7
    assert (rows["smallest_J"] > 0).all()
    assert (rows["proximity"] == 0).all()


def test_condition_of_a_failing_step(runs):
    """Its row stands there, and is written anew when resumed."""
    scene, keys = SCENES / "without-extension-fails.prm", {"Output/Condition estimate": "true"}
    run = runs.run("fails", scene, keys, code=2)
    before = (run.directory / "condition.csv").read_text()
    assert len(before.splitlines()) == 2
    runs.run("fails", scene, keys, "--resume", code=2)
    assert (run.directory / "condition.csv").read_text() == before


NAMES = {"proliferation": "growth", "division (Voronoi)": "division",
         "fixed points (Nitsche)": "nitsche", "slip (Nitsche)": "nitsche"}
EFFECTS = {"division", "growth", "nitsche", "traction", "pressure", "body force"}


@pytest.mark.parametrize("scene, present, is_free", [
    ("free-growth-offset", {"growth"}, True), ("rigid-motion-2d", {"nitsche"}, False),
    ("self-weight-h40", {"nitsche", "body force"}, False),
    ("balance-traction", {"traction"}, True),
    ("mesh-pressure", {"growth", "nitsche", "pressure"}, False),
    ("../programs/small-cube", {"division", "growth", "nitsche"}, True)])
def test_absent_effects(runs, scene, present, is_free):
    """An effect that a scene does not call for has no row in timings.csv,
    nor in --explain, as text and as JSON."""
    file = SCENES / f"{scene}.prm"
    text = runs.explain(file)
    said = json.loads(runs.explain(file, {}, "--explain=json"))
    effects = {effect["name"]: effect["description"] for effect in said["effects"]}
    assert {NAMES.get(name, name) for name in effects} & EFFECTS == present
    for name, description in effects.items():
        assert f"  {name:<24}{description}" in text
    for warning in said["warnings"]:
        assert warning in text
    sections = {*runs.run(file.stem, file).timings.index}
    assert sections & (EFFECTS | {"rigid motion"}) == (
        present | {"rigid motion"} if is_free else present)
