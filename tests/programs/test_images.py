# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""contrib/import: label images and trackers' tables become scenes that run; what is
odd about them is said; and what the program says of surface files."""
import json

import numpy as np
import pytest
import tifffile
from morula.images.surface import Part, balls_around, contains
from morula.run import read_csv
from tests.common.cells_image import EDGE, INNER, hollow_ball
from tests.common.program import TESTS

TOOL = TESTS.parent / "contrib/import"
COARSE, V = 4, "2,2,8"  # of the small 3-D image
SMALL = hollow_ball(3, COARSE)[0]
NUMBERS = np.unique(SMALL)
N = len(NUMBERS) - 1


def separate(n=4):
    """A mask of n^2 squares of 11 pixels with gaps of 3."""
    mask = np.zeros((14 * n + 4, 14 * n + 4), bool)
    for i in range(n):
        for j in range(n):
            mask[14 * i + 3:14 * i + 14, 14 * j + 3:14 * j + 14] = True
    return mask


def lined(n=4):
    """The same, with a label for each square."""
    square = np.arange(14 * n + 4) // 14
    return separate(n) * (n * square[:, None] + square + 1)


@pytest.fixture(scope="module")
def make(runs):
    """What the tool says of an array as NumPy's file, or as TIFF."""
    def call(name, array, *words, code=0, **tiff):
        if tiff:
            tifffile.imwrite(runs.work / name, array, **tiff)
        else:
            np.save(runs.work / name, array)
        done = runs.call([TOOL, name, "--again", *words], code, cwd=runs.work)
        return done.stdout + done.stderr
    return call


@pytest.fixture(scope="module")
def cells(runs):
    return lambda name: read_csv(runs.work / name / "cells.csv")


@pytest.fixture(scope="module")
def explained(runs):
    return lambda scene: json.loads(runs.execute(scene, "--explain=json").stdout)


@pytest.mark.parametrize("dim, name, days", [
    (2, "ring", 5), pytest.param(3, "ball", 3, marks=pytest.mark.release)])
def test_hollow_ball(runs, make, cells, dim, name, days):
    """From an anisotropic image with touching labels, a hole and a torn label to a
    run: volumes, the surface's and the lumen's are the image's; the lumen stays."""
    labels, voxel = hollow_ball(dim)
    said = make(f"{name}.tif", labels, "--voxel", ",".join(map(str, voxel[::-1])),
                photometric="minisblack")
    assert "in several parts" in said
    sizes = np.unique(labels[labels > 0], return_counts=True)[1]
    np.testing.assert_allclose(np.sort(cells(name)["volume"]),
                               np.sort(sizes) * voxel.prod(), 0.02)
    run = runs.run(f"run-{dim}", runs.work / name / "scene.prm",
                   {"Time/End time": days})
    first, last = run.statistics.iloc[0], run.statistics.iloc[-1]
    total = sizes.sum() * voxel.prod()
    assert first["cells"] == len(sizes)
    assert first["grown_volume"] == pytest.approx(total, 1e-6)  # its surface pulls at once
    assert first["enclosed_volume"] == pytest.approx(total, 0.02)
    hole = [np.pi, 4 / 3 * np.pi][dim - 2] * INNER**dim
    assert first["lumen_volume"] == pytest.approx(hole, 0.05)
    assert last["time"] == days and last["cells"] > 1.2 * first["cells"]
    assert last["lumen_volume"] == pytest.approx(first["lumen_volume"], 1e-3)
    places = run.cells(-1)[list("xyz"[:dim])].to_numpy() - EDGE / 2
    assert np.linalg.norm(places, axis=1).min() > INNER / 4


@pytest.mark.parametrize("name, array, voxel, count, said", [
    pytest.param("u8", np.searchsorted(NUMBERS, SMALL).astype(np.uint8), V, N, "",
                 marks=pytest.mark.release),
    pytest.param("i32", np.searchsorted(NUMBERS, SMALL).astype(np.int32) * 1000003, V, N, "",
                 marks=pytest.mark.release),
    ("border", SMALL[:, :18], V, None, "touch the border"),
    ("slice", hollow_ball(2)[0][None], "0.5,0.5", 34, "one slice"),
    ("floats", SMALL.astype(np.float32), V, N, "but whole"),
    pytest.param("negative", np.where(SMALL > 0, SMALL.astype(int), -1), V, N, "below 0",
                 marks=pytest.mark.release),
    ("mask", separate(), "1,1", 16, "16 parts"),
    ("lines", lined(), "1,1", 16, "--fill-gaps gives")],
    ids=lambda value: value if isinstance(value, str) else "")
def test_other_images(make, cells, explained, runs, name, array, voxel, count, said):
    assert said in make(f"{name}.npy", array, "--voxel", voxel)
    assert explained(runs.work / name / "scene.prm")["cells"] == len(cells(name))
    if count:
        assert len(cells(name)) == count


@pytest.mark.parametrize("name, array, said", [
    ("whole-mask", SMALL > 0, "a mask with a single part"),
    ("rgb", np.zeros((40, 40, 3), np.uint8), "colour picture"),
    ("intensity", SMALL + 0.25, "segment it first"),
    ("nan", np.where(SMALL > 0, SMALL, np.nan), "fractions"),
    ("complex", SMALL.astype(complex), "complex128"),
    ("4d", np.stack([SMALL, SMALL]), "4 axes"),
    ("1d", np.arange(9), "shape is (9,)"),
    ("empty", np.zeros_like(SMALL), "no cell"),
    ("nothing", SMALL[:0], "shape is (0"),
    ("words", np.array([["a"]]), "type <U1")],
    ids=lambda value: value if isinstance(value, str) else "")
def test_images_that_are_refused(make, runs, name, array, said):
    """Each with a word that says why."""
    assert said in make(f"{name}.npy", array, "--voxel", V, code=1)
    assert not (runs.work / name).exists()


def test_lines_are_filled_on_request(make, cells):
    make("filled.npy", lined(), "--voxel", "1,1", "--fill-gaps")
    filled = cells("filled")["volume"]
    assert len(filled) == 16
    # an inner cell gets half of the gaps around it: 14 by 14
    assert filled.max() == pytest.approx(14**2, 0.1)


def test_voxels(make, cells):
    """Of OME, ImageJ and the option; and what these may not be."""
    make("ome.tif", SMALL, ome=True, metadata={
        "axes": "ZYX", "PhysicalSizeX": 2.0, "PhysicalSizeY": 2000.0,
        "PhysicalSizeYUnit": "nm", "PhysicalSizeZ": 8.0})
    make("imagej.tif", SMALL, imagej=True, resolution=(0.5, 0.5),
         metadata={"axes": "ZYX", "spacing": 8.0, "unit": "um"})
    make("option.npy", SMALL, "--voxel", V)
    for name in ("ome", "imagej"):
        for column in ("x", "z", "volume"):
            np.testing.assert_allclose(cells(name)[column], cells("option")[column])
    for words, said in (([], "does not say it"),
                        (["--voxel", "1,0,1"], "3 numbers > 0"),
                        (["--voxel", "1,1"], "order x,y,z"),
                        (["--voxel", "a,b,c"], "3 numbers > 0")):
        assert said in make("none.npy", SMALL, *words, code=1)


def test_channels_and_times(make, runs):
    """A channel has the labels, another one the types."""
    bright = np.where(np.indices(SMALL.shape)[2] > 24, 200, 10)
    both = np.stack([SMALL, bright.astype(np.uint16)])
    about = {"ome": True, "metadata": {"axes": "CZYX"}}
    assert "--channel" in make("two.tif", both, "--voxel", V, code=1, **about)
    assert "are positive" in make("two.tif", both, "--voxel", V, "--channel", "0",
                                  "--marker-channel", "1", **about)
    for line in (runs.work / "two/cells.csv").read_text().splitlines()[1:]:
        x, *_, kind = line.split(",")
        if abs(float(x) - EDGE / 2) > 10:
            assert kind == ("positive" if float(x) > EDGE / 2 else "negative")
    assert "--frame" in make("times.tif", both[:1].repeat(2, 0), "--voxel", V, code=1,
                             ome=True, metadata={"axes": "TZYX"})


def test_types(make, runs, explained):
    table = runs.write("types.csv", "label,type\n" + "".join(
        f"{label},{'ab'[label % 2]}\n" for label in NUMBERS))
    make("typed.npy", SMALL, "--voxel", V, "--types", table)
    found = explained(runs.work / "typed/scene.prm")
    assert [kind["name"] for kind in found["types"]] == ["a", "b"]
    assert sum(kind["founders"] for kind in found["types"]) == found["cells"]


def test_table(runs, cells, explained):
    """Of a tracker, with lines of units and two times."""
    rng = np.random.default_rng(2)
    grid = np.stack(np.meshgrid(*[np.arange(5) * 10.0] * 3), -1).reshape(
        -1, 3) + rng.uniform(-1, 1, (125, 3))
    lines = ["LABEL,POSITION_X,POSITION_Y,POSITION_Z,FRAME,RADIUS",
             "Label,X,Y,Z,Frame,Radius", "label,(um),(um),(um),,(um)"]
    lines += [f"{i},{x},{y},{z},{frame},6" for frame in (0, 3)
              for i, (x, y, z) in enumerate(grid + 100 * frame)]
    runs.write("spots.csv", "\n".join(lines) + "\n")
    words = [TOOL, "spots.csv", "--again"]
    assert "2 times" in runs.call(words, 1, cwd=runs.work).stderr
    counted = runs.call([*words, "--frame", "1"], cwd=runs.work).stdout
    said = runs.call([*words, "--frame", "3"], cwd=runs.work).stdout
    assert "2 times it is that of 3" in said and "2 times it is that of 3" in counted
    assert "2 lines hold no numbers" in said
    np.testing.assert_allclose(cells("spots")["x"], grid[:, 0] + 300, rtol=1e-7)
    np.testing.assert_allclose(cells("spots")["volume"], 4 / 3 * np.pi * 216)
    assert explained(runs.work / "spots/scene.prm")["cells"] == 125


@pytest.mark.parametrize("name, content", [
    ("semicolons", "sep=;\nx;y;z;volume\n1,5;2;3;4\n9;2;3;4\n"),
    ("tabs", "X\tY\tZ\tVolume\r\n1.5\t2\t3\t4\r\n9\t2\t3\t4\r\n"),
    ("blanks", " x  y z volume\n 1.5 2 3 4\n9 2 3 4 # a remark\n"),
    ("fortran", "x,y,z,volume\n1.5D0,2d0,3,4\n9,2,3,4\n"),
    ("units", "x (nm),y [um],Z (micron),volume (um^3)\n1500,2,3,4\n9000,2,3,4\n"),
    ("latin", "x (\u00b5m),y (\u00b5m),z,volume\n1.5,2,3,4\n9,2,3,4\n")])
def test_habits_of_tables(runs, cells, name, content):
    """What the program refuses in a points file is understood here."""
    file = runs.work / f"{name}.csv"
    file.write_text(content, encoding="latin-1", newline="")
    runs.call([TOOL, file.name, "--again"], cwd=runs.work)
    np.testing.assert_allclose(cells(name)["x"], [1.5, 9])
    np.testing.assert_allclose(cells(name)["volume"], [4, 4])


def test_units_and_columns_of_tables(runs):
    """Pixels are refused; phases and generations stay."""
    runs.write("pixels.csv", "x,y\n(pixel),(pixel)\n1,2\n9,2\n")
    assert "is in pixel" in runs.call([TOOL, "pixels.csv"], 1, cwd=runs.work).stderr
    runs.write("phases.csv", "x,y,phase,generation\n1,2,0,3\n9,2,4,2\n")
    runs.call([TOOL, "phases.csv"], cwd=runs.work)
    written = (runs.work / "phases/cells.csv").read_text().splitlines()
    assert written == ["x,y,volume,generation,phase", "1,2,64,3,0", "9,2,64,2,4"]


@pytest.mark.quick
def test_cover_of_a_cavity():
    """Balls hold all of a bent cavity and nothing of the outer surface."""
    angle = np.linspace(0.3, 2 * np.pi - 0.3, 300)[:, None]
    middle = np.hstack([np.cos(angle), np.sin(angle)]) * 50
    inner = Part(np.vstack([middle * 1.1, middle[::-1] * 0.9]), None, -1.0)
    outer = Part(np.vstack([middle * 1.4, middle[::-1] * 0.6]), None, 1.0)
    balls = balls_around(inner, [outer])
    for points, wanted in ((inner.vertices, True), (outer.vertices, False)):
        held = np.any([np.linalg.norm(points - centre, axis=1) < radius
                       for centre, radius in balls], axis=0)
        assert (held == wanted).all()
    square = Part(np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]]), None, 1.0)
    assert list(contains(square, np.array([[0.5, 0.5], [1.5, 0.5]]))) == [True, False]


def test_surface_files(runs, explained):
    """Cells outside are refused with their number, and files that hold no polygons
    with the reason."""
    runs.write("cells.csv", "x,y\n" + "".join(
        f"{x},{y}\n" for x in range(5, 95, 10) for y in range(5, 95, 10)))
    square = "POLYGON((0 0, {0} 0, {0} 90, 0 90, 0 0))"
    scene = runs.write("scene.prm", """set Dimension = 2
subsection Tissue
  set Shape = points
  set Points file = cells.csv
  set Points surface = outline.wkt
end
subsection Grid
  set Spacing = 30
end
""")
    for text, word in (
            (square.format(50), "36 of 81 cells lie outside"),
            ("POLYGON((0 0, 90 90, 90 0, 0 90, 0 0))", "has none that can"),
            ("POINT(1 2)", "MULTIPOLYGON"), ("", "MULTIPOLYGON"),
            ("POLYGON((0 0, 9 9", "It cannot be read as such"),
            ("POLYGON((0 0, 9", "At '9' there are not two")):
        runs.write("outline.wkt", text)
        said = runs.execute(scene, code=1).stderr
        assert "Tissue/Points surface" in said and word in said
    runs.write("outline.wkt", square.format(90))
    assert explained(scene)["boundary points"] == 36  # 360 um by 10
    assert ".wkt" in runs.execute(
        scene, "-s", "Tissue/Points surface=cells.csv", code=1).stderr
