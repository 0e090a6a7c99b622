# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""contrib/export: tracks give back the lineage that they were made of; what
others read is after their specifications; labels fill the cells' regions."""
import json
import os

import h5py
import numpy as np
import zarr
from morula.export import geff
from morula.export.rasters import filled, raster_around
from morula.export.tracks import tracks_of
from morula.run import Run
from morula.shapes.polyhedra import FLAT
from morula.shapes.regions import regions_of_state
from tests.common.program import SCENES, TESTS, ProgramTest, overrides
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

TOOL = TESTS.parent / "contrib/export"
CUBE = TESTS / "programs/small-cube.prm"

# Cells in 2-D that divide, die, and are of two types; days 0.3 of the output lie
# between divisions, and some cells live between two of them.
DISC = """
set Dimension = 2
set Output directory = disc
subsection Time
  set End time = 0.9
  set Step = 0.1
end
subsection Tissue
  set Shape = sphere
  set Radius = 50
  set Cell spacing = 10
end
subsection Grid
  set Spacing = 30
end
subsection Cell types
  set Names = stem, other
  subsection stem
    set Where = X > 0
    subsection Transitions
      set To other = 1
    end
  end
end
subsection Proliferation
  set Law = cell cycle
  subsection Cell cycle
    set Duration = 0.25
    set G0 exit rate = 10
  end
end
subsection Death
  set Rate = 0.8
  set Shrinking time = 0.2
end
subsection Material
  set Energy per = grown volume
end
subsection Boundary conditions
  set Fixed where = Y < -40
end
subsection Output
  set Formats = csv
  set Interval = 0.3
end
"""


class Export(ProgramTest):
    @classmethod
    def setUpClass(cls):
        cls.runs = {}

    def run_of(self, name):
        """The cube or the disc, computed once for all tests."""
        if name not in self.runs:
            keep = self.work.parent / f"export-{name}"
            scene = (CUBE if name == "cube" else self.write("disc.prm", DISC))
            self.execute(scene, *overrides({"Output directory": keep}),
                         "--replace")
            self.runs[name] = Run(keep)
        return self.runs[name]

    def export(self, run, *words, code=0):
        done = self.run_words([TOOL, run.directory, *words], code=code,
                              cwd=self.work)
        return done.stdout if code == 0 else done.stderr

    def test_lineage_comes_back(self):
        """Exactly, with places and times of birth, types, deaths and
        removals."""
        for name in ("cube", "disc"):
            run = self.run_of(name)
            said = self.export(run, f"{name}.geff")
            self.assertIn(f"{len(run.lineage)} cells", said)
            found, right = geff.read_lineage(self.work / f"{name}.geff"), run.lineage
            self.assertGreater(len(right), 1.5 * right.founders)
            self.assertEqual(set(found.table), set(right.table))
            for column in right.table:
                np.testing.assert_array_equal(found.table[column],
                                              right.table[column], column)
            np.testing.assert_array_equal(found.death_time, right.death_time)
            np.testing.assert_array_equal(found.removal_time, right.removal_time)
        self.assertTrue(np.isfinite(right.death_time).any())
        self.assertTrue(np.isfinite(right.removal_time).any())

    def test_a_run_without_states(self):
        self.execute(CUBE, *overrides({"Output/Formats": "none"}))
        run = Run(self.work / "output")
        self.export(run, "births.geff")
        tracks = geff.read(self.work / "births.geff")
        self.assertEqual(len(tracks), len(run.lineage))
        np.testing.assert_array_equal(
            geff.read_lineage(self.work / "births.geff").parent,
            run.lineage.parent)

    def test_graph(self):
        """Nodes are births and states; time goes on along edges; lineages are
        what hangs together, tracklets the longest paths without a branch."""
        for name in ("cube", "disc"):
            run = self.run_of(name)
            tracks = tracks_of(run)
            cell, t = (tracks.properties[k].values for k in ("cell", "t"))
            wanted = {(i, time) for i, time in enumerate(run.lineage.birth_time)}
            for i, time in enumerate(run.times):
                wanted |= {(cell, time) for cell in run.cells(i)["id"]}
            self.assertEqual(sorted(zip(cell, t)), sorted(wanted))
            source, target = tracks.edges.T
            self.assertTrue((t[target] > t[source]).all())
            graph = coo_matrix((np.ones(len(source)), (source, target)),
                               (len(t), len(t)))
            n, part = connected_components(graph, directed=False)
            self.assertEqual(n, run.lineage.founders)
            founder = tracks.properties["lineage"].values
            self.assertEqual(len(set(zip(part, founder))), n)
            leave, enter = (np.bincount(ends, minlength=len(t))
                            for ends in (source, target))
            self.assertLessEqual(leave.max(), 2)
            self.assertLessEqual(enter.max(), 1)
            simple = (leave[source] == 1) & (enter[target] == 1)
            np.testing.assert_array_equal(simple, cell[source] == cell[target])

    def test_columns(self):
        """Of the states, and missing at births that none of them shows."""
        run = self.run_of("disc")
        self.export(run, "disc.geff")
        tracks = geff.read(self.work / "disc.geff")
        cell, t = (tracks.properties[k].values for k in ("cell", "t"))
        missing = tracks.properties["volume"].missing
        self.assertTrue(missing.any())
        shown = 0
        for i, time in enumerate(run.times):
            cells = run.cells(i).set_index("id")
            here = np.flatnonzero(t == time)
            here = here[np.isin(cell[here], cells.index)]
            shown += len(here)
            self.assertEqual(len(here), len(cells))
            self.assertFalse(missing[here].any())
            for name in ("volume", "energy_density", "x", "y", "type", "phase"):
                np.testing.assert_array_equal(
                    tracks.properties[name].values[here],
                    cells.loc[cell[here], name].to_numpy(), name)
        self.assertEqual(shown, (~missing).sum())
        self.assertEqual(tracks.type_names, ("stem", "other"))

    def test_after_the_specification(self):
        """What a reader of GEFF 1.0 demands of the groups and of what they say
        of themselves."""
        for name, axes in (("cube", "tzyx"), ("disc", "tyx")):
            self.export(self.run_of(name), f"{name}.geff")
            root = zarr.open_group(str(self.work / f"{name}.geff"), mode="r")
            self.assertTrue((self.work / f"{name}.geff/.zgroup").is_file())
            said = json.loads((self.work / f"{name}.geff/.zattrs").read_text())["geff"]
            self.assertRegex(said["geff_version"], r"^\d+\.\d+")
            self.assertIs(said["directed"], True)
            ids, edges = root["nodes/ids"][:], root["edges/ids"][:]
            self.assertEqual({ids.dtype, edges.dtype}, {np.dtype(np.uint64)})
            self.assertEqual(len(set(ids)), len(ids))
            self.assertTrue(np.isin(edges, ids).all())
            self.assertEqual(len({*map(tuple, edges)}), len(edges))
            known = said["node_props_metadata"]
            self.assertEqual({*root["nodes/props"].group_keys()}, {*known})
            for prop, about in known.items():
                group = root[f"nodes/props/{prop}"]
                self.assertEqual(about["identifier"], prop)
                self.assertEqual(group["values"].dtype, np.dtype(about["dtype"]))
                self.assertEqual(group["values"].shape, ids.shape)
                if "missing" in group:
                    self.assertEqual(group["missing"].dtype, np.dtype(bool))
                    self.assertEqual(group["missing"].shape, ids.shape)
            self.assertEqual("".join(axis["name"] for axis in said["axes"]), axes)
            for axis in said["axes"]:
                group = root[f"nodes/props/{axis['name']}"]
                self.assertNotIn("missing", group)
                self.assertEqual([axis["min"], axis["max"]],
                                 [group["values"][:].min(), group["values"][:].max()])

    def test_annotated_data(self):
        run = self.run_of("disc")
        self.export(run, "all.h5ad", "--all")
        with h5py.File(self.work / "all.h5ad") as file:
            kinds = {}
            file.visititems(lambda name, element: kinds.update(
                {name: element.attrs.get("encoding-type")}))
            self.assertNotIn(None, kinds.values(), kinds)
            self.assertEqual(file.attrs["encoding-type"], "anndata")
            obs = file["obs"]
            order = list(obs.attrs["column-order"])
            self.assertEqual(order, [name for name in obs if name != "_index"
                                     and name in order] and order)
            self.assertEqual({*obs} - {"_index"}, {*order})
            names = file["var/_index"].asstr()[:]
            cells = [run.cells(i) for i in range(len(run.times))]
            np.testing.assert_array_equal(
                file["X"][:, list(names).index("volume")],
                np.concatenate([state["volume"] for state in cells]))
            self.assertEqual(len(set(obs["_index"].asstr()[:])),
                             sum(map(len, cells)))
            types = obs["type/categories"].asstr()[:][obs["type/codes"][:]]
            np.testing.assert_array_equal(types, np.concatenate(
                [np.array(run.type_names)[state["type"]] for state in cells]))
            self.assertEqual(len(file["uns/type_colors"]), 2)
            self.assertEqual(file["obsm/spatial"].shape[1], 2)
        try:
            import anndata
        except ImportError:
            return
        read = anndata.read_h5ad(self.work / "all.h5ad")
        self.assertEqual(read.shape, (sum(map(len, cells)), len(names)))
        self.assertEqual(set(read.obs["type"]), {"stem", "other"})
        np.testing.assert_array_equal(read[:, "volume"].X[:len(cells[0]), 0],
                                      cells[0]["volume"])

    def test_points_over_time(self):
        """Every state is a step, and begins where its offsets say; VTK's own
        reader finds it where it knows steps."""
        run = self.run_of("disc")
        said = self.export(run, "cells.vtkhdf")
        states = [run.cells(i) for i in range(len(run.times))]
        self.assertIn(f"{sum(map(len, states))} rows", said)
        with h5py.File(self.work / "cells.vtkhdf") as file:
            root, steps = file["VTKHDF"], file["VTKHDF/Steps"]
            self.assertEqual(root.attrs["Type"], b"PolyData")
            np.testing.assert_array_equal(steps["Values"], run.times)
            np.testing.assert_array_equal(root["NumberOfPoints"],
                                          [len(state) for state in states])
            for i, state in enumerate(states):
                begin = steps["PointOffsets"][i]
                rows = slice(begin, begin + len(state))
                np.testing.assert_array_equal(root["Points"][rows, 0], state["x"])
                np.testing.assert_array_equal(root["PointData/volume"][rows],
                                              state["volume"])
                begin = steps["CellOffsets"][i, 0]
                np.testing.assert_array_equal(
                    root["Vertices/Connectivity"][begin:begin + len(state)],
                    np.arange(len(state)))
                ends = root["Vertices/Offsets"][begin + i:][:len(state) + 1]
                np.testing.assert_array_equal(ends, np.arange(len(state) + 1))
        self.assert_read_by_vtk(self.work / "cells.vtkhdf", run, states)

    def assert_read_by_vtk(self, file, run, states):
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkIOHDF import vtkHDFReader
        reader = vtkHDFReader()
        if not hasattr(reader, "SetStep"):
            return  # before VTK 9.3
        reader.SetFileName(str(file))
        reader.UpdateInformation()
        self.assertEqual(reader.GetNumberOfSteps(), len(states))
        for i, state in enumerate(states):
            reader.UpdateTimeStep(run.times[i])
            read = reader.GetOutput()
            self.assertEqual(read.GetNumberOfPoints(), len(state))
            self.assertEqual(read.GetNumberOfVerts(), len(state))
            np.testing.assert_array_equal(
                vtk_to_numpy(read.GetPoints().GetData())[:, 1], state["y"])
            np.testing.assert_array_equal(
                vtk_to_numpy(read.GetPointData().GetArray("volume")),
                state["volume"])

    def assert_volumes(self, run, number, voxel):
        """Each cell's voxels have the volume of its region but for those that
        its walls go through, of which a half is wrong at most; all of them
        together, where walls between cells do not count, are far nearer.
        Returns the mean square error over the square of the mean volume."""
        bodies = regions_of_state(run, number).bodies
        regions = regions_of_state(run, number)
        ids = run.cells(number)["id"].to_numpy()
        points = bodies.points[np.unique(bodies.corners)][:, :run.dimension]
        raster = raster_around([(points.min(axis=0), points.max(axis=0))],
                               [voxel] * run.dimension, ids.max() + 1)
        image = filled(raster, bodies, ids + 1)
        found = np.bincount(image.ravel(), minlength=ids.max() + 2)[ids + 1] * (
            voxel**run.dimension)
        area = np.linalg.norm(bodies.area_vectors(), axis=1)
        area[bodies.beyond == FLAT] = 0
        area = np.bincount(bodies.owner, area)
        error = np.abs(found - regions.volume)
        self.assertTrue((error <= 0.5 * area * voxel).all())
        self.assertLess(abs(found.sum() / regions.volume.sum() - 1), 0.01)
        return np.mean(error**2) / regions.volume.mean()**2

    def test_volumes_of_labels(self):
        """Within the resolution of the raster, and better with finer voxels."""
        for name in ("cube", "disc"):
            run = self.run_of(name)
            last = len(run.times) - 1
            errors = [self.assert_volumes(run, last, voxel) for voxel in (2, 1)]
            self.assertLess(errors[1], 0.5 * errors[0])

    def test_a_lattice_is_exact(self):
        """Cubes of 12 µm in voxels of 3 µm."""
        run = self.run_of("cube")
        said = self.export(run, "cube.NPY", "--time", "0", "--voxel", "3")
        self.assertIn("corner at -33, -33, -3 um", said)
        image = np.load(self.work / "cube.NPY")
        self.assertEqual(image.shape, (22, 22, 22))
        np.testing.assert_array_equal(np.bincount(image.ravel())[1:],
                                      np.full(125, 64))
        cells = run.cells(0)
        at = ((cells[["z", "y", "x"]] - [-3, -33, -33]) // 3).to_numpy(int)
        np.testing.assert_array_equal(image[tuple(at.T)], cells["id"] + 1)

    def test_there_and_back(self):
        """contrib/import makes the same cells of the image: OME's voxels, their
        volumes, their places."""
        run = self.run_of("cube")
        self.export(run, "labels.tif", "--voxel", "2,2,4", "--all")
        files = sorted(self.work.glob("labels-*.tif"))
        self.assertEqual(len(files), len(run.times))
        said = self.run_words([TESTS.parent / "contrib/import", files[-1].name],
                              cwd=self.work).stdout
        self.assertIn("A voxel is 2 x 2 x 4 um", said)
        table = np.genfromtxt(self.work / files[-1].stem / "cells.csv",
                              delimiter=",", names=True)
        volumes = regions_of_state(run, len(run.times) - 1).volume
        self.assertEqual(len(table), len(volumes))
        self.assertLess(abs(table["volume"].sum() / volumes.sum() - 1), 0.01)
        places = run.cells(-1)
        for axis in "xyz":  # but for the corner, which is one for all
            off = np.sort(table[axis]) - np.sort(places[axis])
            self.assertLess(np.std(off), 1.5, axis)

    def test_refusals(self):
        run = self.run_of("cube")
        (self.work / "there.h5ad").write_text("")
        (self.work / "folder.geff").mkdir()
        for words, said in (
                (["a.txt"], "ends in one of .geff, .h5ad"),
                (["nowhere/a.geff"], "a directory that exists"),
                (["there.h5ad"], "or replace that one with --again"),
                (["a.tif"], "edges of the voxels in um"),
                (["a.tif", "--voxel", "0"], "edges of the voxels in um"),
                (["a.tif", "--voxel", "1,2"], "three edges, for a run in 3-D"),
                (["a.tif", "--voxel", "0.01"], "take larger voxels"),
                (["a.h5ad", "--voxel", "1"], "nothing without an image"),
                (["a.geff", "--all"], "nothing for files over time alone"),
                (["a.h5ad", "--time", "0.3"], "a day of a state that was written"),
                (["folder.geff", "--again"], "Something else is there")):
            with self.subTest(words):
                self.assertIn(said, self.export(run, *words, code=1))
        self.assertEqual({file.name for file in self.work.iterdir()},
                         {"there.h5ad", "folder.geff"})

    def test_tissue_without_a_surface(self):
        """Has no regions, and says so; tracks and tables need none."""
        self.execute(SCENES / "points-free.prm", *overrides(
            {"Time/End time": "0.25", "Output/Formats": "csv"}),
            output=self.work / "free")
        run = Run(self.work / "free")
        self.export(run, "a.geff", "a.h5ad")
        said = self.export(run, "a.tif", "--voxel", "5", code=1)
        self.assertIn("allowed is tissue with boundary points", said)
        for tool, *words in (["cell-shapes"], ["render", "--shapes"]):
            said = self.run_words([TESTS.parent / "contrib" / tool, run.directory,
                                   *words], code=1).stderr
            self.assertIn("allowed is tissue with boundary points", said)

    def test_missing_libraries(self):
        run = self.run_of("cube")
        for library, file in (("zarr", "a.geff"), ("h5py", "a.h5ad"),
                              ("tifffile", "a.tif")):
            fake = self.work / library
            fake.mkdir()
            (fake / f"{library}.py").write_text(
                f"raise ModuleNotFoundError('No module named {library}', "
                f"name='{library}')\n")
            path = f"PYTHONPATH={fake}:{os.environ.get('PYTHONPATH', '')}"
            words = ["--voxel", "10"] if file.endswith("tif") else []
            said = self.run_words(
                ["env", path, "/usr/bin/python3", "-P", "-m", "morula", "export",
                 run.directory, file, *words], code=1, cwd=self.work)
            self.assertIn(f"Debian's package python3-{library} has it",
                          said.stdout + said.stderr)

