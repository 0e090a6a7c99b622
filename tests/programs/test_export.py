# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""contrib/export: tracks give back the lineage that they were made of; what others
read is after their specifications; labels fill the cells' regions."""
import json

import h5py
import numpy as np
import pytest
import zarr
from morula.export import geff
from morula.export.rasters import filled, raster_around
from morula.export.tracks import tracks_of
from morula.shapes.polyhedra import FLAT
from morula.shapes.regions import regions_of_state
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from tests.common.program import SCENES, TESTS

CONTRIB = TESTS.parent / "contrib"
CUBE, DISC = (TESTS / f"programs/{name}.prm" for name in ("small-cube", "disc"))

# Cells in 2-D that divide, die, and are of two types; days 0.3 of the output lie
# between divisions, and some cells live between two of them.
DYING = {"Time/End time": 0.9, "Time/Step": 0.1, "Tissue/Radius": 50,
         "Grid/Spacing": 30, "Cell types/Names": "stem, other",
         "Cell types/stem/Where": "X > 0", "Cell types/stem/Transitions/To other": 1,
         "Proliferation/Cell cycle/Duration": 0.25,
         "Proliferation/Cell cycle/G0 exit rate": 10, "Death/Rate": 0.8,
         "Death/Shrinking time": 0.2,
         "Boundary conditions/Fixed where": "Y < -40", "Output/Formats": "csv",
         "Output/Interval": 0.3}


@pytest.fixture(scope="module")
def cube(runs):
    return runs.run("cube", CUBE)


@pytest.fixture(scope="module")
def disc(runs):
    return runs.run("disc", DISC, DYING)


@pytest.fixture(params=["cube", "disc"])
def run(request):
    return request.getfixturevalue(request.param)


@pytest.fixture
def export(runs, tmp_path):
    """Runs the tool in an empty directory; what it says."""
    def call(run, *words, code=0):
        done = runs.call([CONTRIB / "export", run.directory, *words], code,
                         cwd=tmp_path)
        return done.stdout + done.stderr
    return call


def test_lineage_comes_back(run, export, tmp_path):
    """Exactly, with places and times of birth, types, deaths and removals."""
    assert f"{len(run.lineage)} cells" in export(run, "a.geff")
    found, right = geff.read_lineage(tmp_path / "a.geff"), run.lineage
    assert len(right) > 1.5 * right.founders
    assert set(found.table) == set(right.table)
    for column in right.table:
        np.testing.assert_array_equal(found.table[column], right.table[column], column)
    for name in ("death_time", "removal_time"):
        times = getattr(right, name)
        np.testing.assert_array_equal(getattr(found, name), times)
        assert np.isfinite(times).any() == (run.name == "disc")


def test_a_run_without_states(runs, export, tmp_path):
    run = runs.run("none", CUBE, {"Output/Formats": "none"})
    export(run, "births.geff")
    assert len(geff.read(tmp_path / "births.geff")) == len(run.lineage)
    np.testing.assert_array_equal(
        geff.read_lineage(tmp_path / "births.geff").parent, run.lineage.parent)


def test_graph(run):
    """Nodes are births and states; time goes on along edges; lineages are what
    hangs together, tracklets the longest paths without a branch."""
    tracks = tracks_of(run)
    cell, t = (tracks.properties[k].values for k in ("cell", "t"))
    wanted = {(i, time) for i, time in enumerate(run.lineage.birth_time)}
    for i, time in enumerate(run.times):
        wanted |= {(cell, time) for cell in run.cells(i)["id"]}
    assert sorted(zip(cell, t)) == sorted(wanted)
    source, target = tracks.edges.T
    assert (t[target] > t[source]).all()
    graph = coo_matrix((np.ones(len(source)), (source, target)), (len(t), len(t)))
    n, part = connected_components(graph, directed=False)
    assert n == run.lineage.founders
    assert len(set(zip(part, tracks.properties["lineage"].values))) == n
    leave, enter = (np.bincount(ends, minlength=len(t)) for ends in (source, target))
    assert leave.max() <= 2 and enter.max() <= 1
    simple = (leave[source] == 1) & (enter[target] == 1)
    np.testing.assert_array_equal(simple, cell[source] == cell[target])


def test_columns(disc, export, tmp_path):
    """Of the states, and missing at births that none of them shows."""
    export(disc, "disc.geff")
    tracks = geff.read(tmp_path / "disc.geff")
    cell, t = (tracks.properties[k].values for k in ("cell", "t"))
    missing = tracks.properties["volume"].missing
    assert missing.any()
    shown = 0
    for i, time in enumerate(disc.times):
        cells = disc.cells(i).set_index("id")
        here = np.flatnonzero(t == time)
        here = here[np.isin(cell[here], cells.index)]
        shown += len(here)
        assert len(here) == len(cells) and not missing[here].any()
        for name in ("volume", "energy_density", "x", "y", "type", "phase"):
            np.testing.assert_array_equal(tracks.properties[name].values[here],
                                          cells.loc[cell[here], name].to_numpy(), name)
    assert shown == (~missing).sum()
    assert tracks.type_names == ("stem", "other")


def test_after_the_specification(run, export, tmp_path):
    """What a reader of GEFF 1.0 demands of the groups and of what they say of
    themselves."""
    export(run, "a.geff")
    root = zarr.open_group(str(tmp_path / "a.geff"), mode="r")
    assert (tmp_path / "a.geff/.zgroup").is_file()
    said = json.loads((tmp_path / "a.geff/.zattrs").read_text())["geff"]
    assert said["geff_version"] == "1.0" and said["directed"] is True
    ids, edges = root["nodes/ids"][:], root["edges/ids"][:]
    assert ids.dtype == edges.dtype == np.uint64
    assert len(set(ids)) == len(ids) and np.isin(edges, ids).all()
    assert len({*map(tuple, edges)}) == len(edges)
    known = said["node_props_metadata"]
    assert {*root["nodes/props"].group_keys()} == {*known}
    for prop, about in known.items():
        group = root[f"nodes/props/{prop}"]
        assert about["identifier"] == prop
        assert group["values"].dtype == np.dtype(about["dtype"])
        assert group["values"].shape == ids.shape
        if "missing" in group:
            assert group["missing"].dtype == np.dtype(bool)
            assert group["missing"].shape == ids.shape
    assert "".join(axis["name"] for axis in said["axes"]) == {
        2: "tyx", 3: "tzyx"}[run.dimension]
    for axis in said["axes"]:
        group = root[f"nodes/props/{axis['name']}"]
        assert "missing" not in group
        assert [axis["min"], axis["max"]] == [group["values"][:].min(),
                                              group["values"][:].max()]


def test_annotated_data(disc, export, tmp_path):
    export(disc, "all.h5ad", "--all")
    cells = [disc.cells(i) for i in range(len(disc.times))]
    with h5py.File(tmp_path / "all.h5ad") as file:
        kinds = {}
        file.visititems(lambda name, element: kinds.update(
            {name: element.attrs.get("encoding-type")}))
        assert None not in kinds.values()
        assert file.attrs["encoding-type"] == "anndata"
        obs, names = file["obs"], list(file["var/_index"].asstr()[:])
        assert {*obs} - {"_index"} == {*obs.attrs["column-order"]}
        np.testing.assert_array_equal(
            file["X"][:, names.index("volume")],
            np.concatenate([state["volume"] for state in cells]))
        assert len(set(obs["_index"].asstr()[:])) == sum(map(len, cells))
        types = obs["type/categories"].asstr()[:][obs["type/codes"][:]]
        np.testing.assert_array_equal(types, np.concatenate(
            [np.array(disc.type_names)[state["type"]] for state in cells]))
        assert len(file["uns/type_colors"]) == 2
        assert file["obsm/spatial"].shape[1] == 2
    anndata = pytest.importorskip("anndata")
    read = anndata.read_h5ad(tmp_path / "all.h5ad")
    assert read.shape == (sum(map(len, cells)), len(names))
    assert set(read.obs["type"]) == {"stem", "other"}


def test_points_over_time(disc, export, tmp_path):
    """Every state is a step, and begins where its offsets say."""
    said = export(disc, "cells.vtkhdf")
    states = [disc.cells(i) for i in range(len(disc.times))]
    assert f"{sum(map(len, states))} rows" in said
    with h5py.File(tmp_path / "cells.vtkhdf") as file:
        root, steps = file["VTKHDF"], file["VTKHDF/Steps"]
        assert root.attrs["Type"] == b"PolyData"
        assert list(steps["Values"]) == list(disc.times)
        assert list(root["NumberOfPoints"]) == list(map(len, states))
        for i, state in enumerate(states):
            begin = steps["PointOffsets"][i]
            rows = slice(begin, begin + len(state))
            assert list(root["Points"][rows, 0]) == list(state["x"])
            assert list(root["PointData/volume"][rows]) == list(state["volume"])
            begin = steps["CellOffsets"][i, 0]
            assert list(root["Vertices/Connectivity"][begin:begin + len(state)]) == (
                list(range(len(state))))
            assert list(root["Vertices/Offsets"][begin + i:][:len(state) + 1]) == (
                list(range(len(state) + 1)))


def volume_error(run, number, voxel):
    """Each cell's voxels have the volume of its region but for those that its walls
    go through, of which a half is wrong at most; all of them together, where walls
    between cells do not count, are far nearer. Returns the mean square error over
    the square of the mean volume."""
    regions = regions_of_state(run, number)
    bodies = regions_of_state(run, number).bodies
    ids = run.cells(number)["id"].to_numpy()
    points = bodies.points[np.unique(bodies.corners)][:, :run.dimension]
    raster = raster_around([(points.min(axis=0), points.max(axis=0))],
                           [voxel] * run.dimension, ids.max() + 1)
    image = filled(raster, bodies, ids + 1)
    found = np.bincount(image.ravel(), minlength=ids.max() + 2)[ids + 1] * (
        voxel**run.dimension)
    area = np.linalg.norm(bodies.area_vectors(), axis=1)
    area[bodies.beyond == FLAT] = 0
    error = np.abs(found - regions.volume)
    assert (error <= 0.5 * np.bincount(bodies.owner, area) * voxel).all()
    assert abs(found.sum() / regions.volume.sum() - 1) < 0.01
    return np.mean(error**2) / regions.volume.mean()**2


def test_volumes_of_labels(run):
    """Within the resolution of the raster, and better with finer voxels."""
    coarse, fine = (volume_error(run, len(run.times) - 1, voxel) for voxel in (2, 1))
    assert fine < 0.5 * coarse


def test_a_lattice_is_exact(cube, export, tmp_path):
    """Cubes of 12 µm in voxels of 3 µm."""
    assert "corner at -33, -33, -3 um" in export(
        cube, "cube.NPY", "--time", "0", "--voxel", "3")
    image = np.load(tmp_path / "cube.NPY")
    assert image.shape == (22, 22, 22)
    assert (np.bincount(image.ravel())[1:] == np.full(125, 64)).all()
    cells = cube.cells(0)
    at = ((cells[["z", "y", "x"]] - [-3, -33, -33]) // 3).to_numpy(int)
    np.testing.assert_array_equal(image[tuple(at.T)], cells["id"] + 1)


def test_there_and_back(runs, cube, export, tmp_path):
    """contrib/import makes the same cells of the image: OME's voxels, their
    volumes, their places."""
    export(cube, "labels.tif", "--voxel", "2,2,4", "--all")
    files = sorted(tmp_path.glob("labels-*.tif"))
    assert len(files) == len(cube.times)
    said = runs.call([CONTRIB / "import", files[-1].name], cwd=tmp_path).stdout
    assert "A voxel is 2 x 2 x 4 um" in said
    table = np.genfromtxt(tmp_path / files[-1].stem / "cells.csv", delimiter=",",
                          names=True)
    volumes = regions_of_state(cube, len(cube.times) - 1).volume
    assert len(table) == len(volumes)
    assert abs(table["volume"].sum() / volumes.sum() - 1) < 0.01
    places = cube.cells(-1)
    for axis in "xyz":  # but for the corner, which is one for all
        assert np.std(np.sort(table[axis]) - np.sort(places[axis])) < 1.5


@pytest.mark.parametrize("words, said", [
    (["a.txt"], "ends in one of .geff, .h5ad"),
    (["nowhere/a.geff"], "a directory that exists"),
    (["there.h5ad"], "or replace that one with --again"),
    (["a.tif"], "numbers > 0 in um"),
    (["a.tif", "--voxel", "0"], "numbers > 0 in um"),
    (["a.tif", "--voxel", "1,2"], "three edges, for a run in 3-D"),
    (["a.tif", "--voxel", "0.01"], "take larger voxels"),
    (["a.h5ad", "--voxel", "1"], "nothing without an image"),
    (["a.geff", "--all"], "nothing for files over time alone"),
    (["a.h5ad", "--time", "0.3"], "a day of a state that was written"),
    (["folder.geff", "--again"], "Something else is there")])
def test_refusals(cube, export, tmp_path, words, said):
    (tmp_path / "there.h5ad").write_text("")
    (tmp_path / "folder.geff").mkdir()
    assert said in export(cube, *words, code=1)
    assert {file.name for file in tmp_path.iterdir()} == {"there.h5ad", "folder.geff"}


def test_tissue_without_a_surface(runs, export):
    """Has no regions, and says so; tracks and tables need none."""
    run = runs.run("free", SCENES / "points-free.prm",
                   {"Time/End time": "0.25", "Output/Formats": "csv"})
    export(run, "a.geff", "a.h5ad")
    said = export(run, "a.tif", "--voxel", "5", code=1)
    assert "allowed is tissue with boundary points" in said
    for tool, *words in (["cell-shapes"], ["render", "--shapes"]):
        said = runs.call([CONTRIB / tool, run.directory, *words], 1).stderr
        assert "allowed is tissue with boundary points" in said


def test_portal(run, runs):
    file = runs.work / f"{run.name}.csv"
    runs.call([CONTRIB / "export", run.directory, file])
    lines = file.read_text().splitlines()
    names = ["simID", "time", "cellID", "cellType", *"xyz"[:run.dimension]]
    assert lines[0] == ",".join(names)
    assert len(lines) == 1 + sum(len(run.cells(n)) for n in range(len(run.times)))
    last, cell = lines[-1].split(","), run.cells(-1).iloc[-1]
    assert [last[0], float(last[1]), int(last[2])] == [run.name, run.times[-1], cell["id"]]
    assert last[3] == (run.type_names[int(cell["type"])] if run.type_names else "cell")
    assert [float(x) for x in last[4:]] == [cell[axis] for axis in "xyz"[:run.dimension]]
