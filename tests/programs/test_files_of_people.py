# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""contrib/import with the files that people have: tables without volumes, pixels,
names of types and files, other formats, time-lapses and damaged files."""
import json
import sys
from types import SimpleNamespace

import h5py
import numpy as np
import pandas
import pytest
import tifffile
import zarr
from morula.draw import shading  # noqa: F401 (a fork of the tool has these then)
from morula.images import labels, surface, types  # noqa: F401
from morula.images import volumes as of_places
from morula.refusal import Refused
from PIL import Image
from scipy import ndimage
from scipy.spatial import cKDTree
from tests.common.program import TESTS

TOOL = TESTS.parent / "contrib/import"


def round_tissue(dim, n, radius, hole=0, seed=1):
    """Labels of the nearest of random centres in a disc or ball, pixels of 1 um."""
    rng = np.random.default_rng(seed)
    places = np.stack(np.meshgrid(*[np.arange(-radius - 2, radius + 2.5)] * dim, indexing="ij"), -1)
    centres = rng.uniform(-radius, radius, (100 * n, dim))
    distance = np.linalg.norm(centres, axis=1)
    centres = centres[(distance < radius) & (distance > hole)][:n]
    labels = cKDTree(centres).query(places)[1] + 1
    distance = np.linalg.norm(places, axis=-1)
    return (labels * ((distance < radius) & (distance >= hole))).astype(np.uint16)


DISC, BALL = round_tissue(2, 40, 30), round_tissue(3, 60, 13)


def centroids(labels):
    return np.array(ndimage.center_of_mass(labels > 0, labels, range(1, labels.max() + 1)))


def nuclei():
    """150 places at least 6 um apart in a ball of radius 36 um."""
    rng, found = np.random.default_rng(1), np.zeros((0, 3))
    while len(found) < 150:
        place = rng.uniform(-36, 36, 3)
        if np.linalg.norm(place) < 36 and (np.linalg.norm(found - place, axis=1) > 6).all():
            found = np.vstack([found, place])
    return found


def lattice(dim, n):
    return 10.0 * np.stack(np.meshgrid(*[np.arange(n)] * dim), -1).reshape(
        -1, dim) + np.random.default_rng(2).uniform(-1, 1, (n**dim, dim))


@pytest.fixture(autouse=True)
def coarse(monkeypatch):
    """Voxels for the volumes of places, in the tool, too, which is a fork."""
    monkeypatch.setattr(of_places, "VOXELS", 1e5)


@pytest.fixture(scope="module")
def convert(runs):
    """What the tool says of a file, which may be text or an array, and the cells."""
    def call(name, content=None, *words, code=0):
        if isinstance(content, str):
            (runs.work / name).write_text(content, encoding="utf-8")
        elif content is not None:
            np.save(runs.work / name, content)
        done = runs.call([TOOL, name, "--again", "--output", "made", "--morula",
                          runs.options.morula, *words], code, cwd=runs.work)
        said = done.stdout + done.stderr
        assert "Traceback" not in said
        return said, None if code else pandas.read_csv(runs.work / "made/cells.csv")
    return call


def table(names, rows):
    return names + "\n" + "\n".join(",".join(map(str, row)) for row in rows) + "\n"


@pytest.mark.parametrize("places, volume, most", [
    (centroids(BALL), (BALL > 0).sum(), 0.05), (centroids(DISC), (DISC > 0).sum(), 0.05),
    (nuclei(), 4 / 3 * np.pi * 36**3, 0.05), (lattice(3, 5), 125e3, 0.05),
    (centroids(round_tissue(2, 60, 40, 25)), np.pi * (40**2 - 25**2), 0.1),
    (centroids(round_tissue(3, 185, 30, 18)), 4 / 3 * np.pi * (30**3 - 18**3), 0.1)],
    ids=["ball", "disc", "nuclei", "lattice", "ring", "shell"])
def test_volumes_of_places(places, volume, most):
    volumes, _ = of_places.clipped_volumes(places)
    assert volumes.sum() == pytest.approx(volume, most) and volumes.min() > 0


def test_table_without_volumes(convert):
    """Said with the sum, in 2-D by the numbered columns of arrays."""
    said, cells = convert("centroids.csv", table("z,y,x", centroids(BALL)))
    assert f"together {cells['volume'].sum():.5g} um^3" in said
    assert cells["volume"].sum() == pytest.approx((BALL > 0).sum(), 0.05)
    said, cells = convert("regions.csv", table("label,centroid-0,centroid-1", [
        (n, *place) for n, place in enumerate(centroids(DISC))]))
    np.testing.assert_allclose(cells["x"], centroids(DISC)[:, 1], 1e-6)
    assert cells["volume"].sum() == pytest.approx((DISC > 0).sum(), 0.05)


def write_off(file, *parts):
    """Closed parts: corners and facets each."""
    parts = [(np.array(corners), np.array(facets)) for corners, facets in parts]
    before = np.cumsum([0] + [len(corners) for corners, _ in parts])
    file.write_text("\n".join([
        f"OFF {before[-1]} {sum(len(facets) for _, facets in parts)} 0 # of a test", *(
            " ".join(map(str, corner)) for corners, _ in parts for corner in corners), *(
            " ".join(map(str, (len(facet), *(facet + first)))) for (_, facets), first
            in zip(parts, before) for facet in facets)]) + "\n")


def box(low, high):
    corners = np.array(list(np.ndindex(2, 2, 2))) * (np.subtract(high, low)) + low
    return corners, [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4),
                     (1, 5, 7, 3)]


def test_volumes_within_a_surface(convert, runs):
    """A given surface bounds the regions, cavities and all, and goes into the scene."""
    places = lattice(3, 5)
    places = places[(np.abs(places - 20) > 9).any(1)]  # none in the cavity
    write_off(runs.work / "box.off", box([-9.0] * 3, [49.0] * 3), box([14.0] * 3, [26.0] * 3))
    said, cells = convert("places.csv", table("x,y,z", places), "--surface", "box.off")
    assert cells["volume"].sum() == pytest.approx(58**3 - 12**3, 0.01)
    assert "within the surface" in said and cells["volume"].min() > 500
    assert "= surface.off" in (runs.work / "made/scene.prm").read_text()
    (runs.work / "l.wkt").write_text("POLYGON((-5 -5, 45 -5, 45 45, -5 45, -5 -5), (15 15, 25 15, "
                                     "25 25, 15 25, 15 15))")
    places = lattice(2, 5)
    places = places[(np.abs(places - 20) > 6).any(1)]
    _, cells = convert("plane.csv", table("x,y", places), "--surface", "l.wkt")
    assert cells["volume"].sum() == pytest.approx(50**2 - 10**2, 0.01)


def test_surfaces_that_are_refused(convert, runs):
    rows = table("x,y,z", lattice(3, 5))
    write_off(runs.work / "small.off", box([-9.0] * 3, [35.0] * 3))
    (runs.work / "text.off").write_text("OFF\nno numbers\n")
    (runs.work / "empty.stl").touch()
    for name, said in (("small.off", "61 of 125 places are outside"), ("no.off", "No such file"),
                       ("text.off", "cannot be read"), ("empty.stl", "cannot be read")):
        assert said in convert("places.csv", rows, "--surface", name, code=1)[0]
    assert "nothing for an image" in convert("disc.npy", DISC, "--surface", "a.off", code=1)[0]


@pytest.mark.parametrize("names, own, dim, voxel, volume", [
    ("x,y,z,radius", 12.4, 3, "0.5,0.5,2", 4 / 3 * np.pi * 6.2**3),
    ("x,y,z,diameter", 24.8, 3, "0.5,0.5,2", 4 / 3 * np.pi * 6.2**3),
    ("x,y,z,volume", 2000, 3, "0.5,0.5,2", 1000), ("x,y,z,area_3d", 2000, 3, "0.5,0.5,2", 1000),
    ("x,y,area", 400, 2, "0.5,0.5", 100), ("x,y,radius", 10, 2, "0.5,0.5,2", 25 * np.pi),
    ("x,y,z,equivalent_diameter", 20, 3, "0.5,0.5,0.5", 4 / 3 * np.pi * 125),
    ("x,y,z,radius (um)", 6.2, 3, "0.5,0.5,2", 4 / 3 * np.pi * 6.2**3),
    ("Location_Center_X,Location_Center_Y,AreaShape_Area", 400, 2, "0.5,0.5", 100)])
def test_pixels(convert, names, own, dim, voxel, volume):
    """--voxel scales places, radii and volumes alike; not what has a unit."""
    places = lattice(dim, 5)
    edges = np.array([0.5, 0.5, float(voxel.split(",")[-1])][:dim])
    _, cells = convert("pixels.csv", table(names, [(*place, own) for place in places / edges]),
                       "--voxel", voxel)
    np.testing.assert_allclose(cells["x"], places[:, 0], 1e-6)
    np.testing.assert_allclose(cells["volume"], volume, 1e-6)


IMARIS = "\nPosition\n====================\n\n" \
    "Position X,Position Y,Position Z,Unit,Category,Collection,Time,ID,\n"


@pytest.mark.parametrize("content, said", [
    (IMARIS + "".join(f"{x},{x * x % 7},{x * x % 5},um,Surface,Position,1,{x},\n"
                      for x in range(12)), "Of 1 times"),
    ("x;y;z;volume\n1.234,5;2;3;4\n9;2;3;4\n5;5;5;4\n", ""),
    ("# x y z volume\n1 2 3 4\n9 2 3 4\n", ""),
    ("x,y,z,volume\n1,2,3,4\n9,2,3,4\n7,2,abc,4\n", "line 4, whose z is 'abc'"),
    ("x,y,z,volume,time\n1,2,3,4,10:00\n9,2,3,4,10:00\n", "that of 10:00")])
def test_habits(convert, content, said):
    assert said in convert("habits.csv", content)[0]


@pytest.mark.parametrize("content, said", [
    ("", "It is empty"), ("x,y\n", "no rows"), ("x,y\n\n1,5,2,5\n", "Line 3 has 4 for 2"),
    ("x,y,z\n1,2,a\n3,4,b\n", "line 2, whose z is 'a'"), ("a,b\n1,2\n3,4\n", "columns x and y"),
    ("x,y,volume\n1,2,-3\n3,4,5\n", "It has -3")])
def test_tables_that_are_refused(convert, content, said):
    assert said in convert("refused.csv", content, code=1)[0]


def test_names_of_types(convert, runs):
    kinds = ["T cell", "T_cell", "0", "1", "2.0", "b-1", ""]
    rows = [(*place, kinds[n % 7]) for n, place in enumerate(lattice(2, 5))]
    said, _ = convert("kinds.csv", table("x,y,type", rows))
    names = {line.split(",")[-1] for line in
             (runs.work / "made/cells.csv").read_text().splitlines()[1:]}
    assert names == {"T_cell", "T_cell_2", "type_0", "type_1", "type_2_0", "b_1", "no_type"}
    assert "'T cell' is T_cell_2" in said
    found = json.loads(runs.execute(runs.work / "made/scene.prm", "--explain=json").stdout)
    assert {kind["name"] for kind in found["types"]} == names


def test_names_of_files(runs):
    """Signs that a .prm file cannot hold are refused; two images have two outputs."""
    for name, sign in (("emb#3.npy", "'#'"), ("x\\.npy", "'\\'"), ("a\nb.npy", "x0a")):
        np.save(runs.work / name, DISC)
        assert sign in runs.call([TOOL, name, "--voxel", "1,1"], 1, cwd=runs.work).stderr
    outputs = set()
    for place in ("day1/emb", "day2/emb", "e.t1", "e.t2"):
        file = runs.work / f"{place}.npy"
        file.parent.mkdir(exist_ok=True)
        np.save(file, DISC)
        words = ["--output", place] if "/" in place else []
        runs.call([TOOL, file, "--voxel", "1,1", *words], cwd=runs.work)
        outputs |= {line for line in (runs.work / place / "scene.prm").read_text().splitlines()
                    if "Output directory" in line}
    assert len(outputs) == 4


def as_png(file):
    Image.fromarray(DISC).save(file)


def as_palette(file):
    picture = Image.fromarray(DISC.astype(np.uint8), mode="P")
    picture.putpalette([n * 37 % 256 for n in range(768)])
    picture.save(file)


def as_cellpose(file):
    np.save(file, {"masks": DISC, "outlines": DISC * 0, "diameter": 9.5, "filename": "a.tif"})


def as_hdf5(file):
    with h5py.File(file, "w") as stream:
        stream["exported_data"] = DISC[:, :, None]
        stream["exported_data"].attrs["axistags"] = json.dumps(
            {"axes": [{"key": key} for key in "yxc"]})
        stream["other"] = DISC * 0


def as_zarr(file):
    group = zarr.open(str(file), mode="w")
    labels = group.create_group("labels")
    labels.attrs["labels"] = ["cells"]
    cells = labels.create_group("cells")
    cells["0"] = DISC[None]
    cells.attrs["multiscales"] = [{"axes": [
        {"name": axis, "unit": "micrometer"} for axis in "zyx"], "datasets": [
            {"path": "0", "coordinateTransformations": [
                {"type": "scale", "scale": [1.0, 1.0, 1.0]}]}]}]


def as_bitmap(file):
    Image.fromarray(DISC.astype(np.uint8)).save(file)


@pytest.mark.parametrize("name, write", [
    ("a.png", as_png), ("b.png", as_palette), ("c_seg.npy", as_cellpose), ("d.h5", as_hdf5),
    ("e.ome.zarr", as_zarr), ("f.bmp", as_bitmap)])
def test_formats(convert, runs, name, write):
    write(runs.work / name)
    _, cells = convert(name, None, *([] if "zarr" in name else ["--voxel", "1,1"]))
    assert cells["volume"].sum() == (DISC > 0).sum()


def test_formats_that_are_refused(convert, runs):
    class Evil:
        def __reduce__(self):
            return print, ("executed",)

    np.save(runs.work / "evil_seg.npy", {"masks": Evil()})
    assert "it has a builtins.print" in convert("evil_seg.npy", code=1)[0]
    for name, said in (("a.czi", "No CZI"), ("a.jpg", "No JPG"), ("a.xlsx", "No XLSX"),
                       ("a.nrrd", "pip install pynrrd"), ("a.bin", "cannot be read")):
        (runs.work / name).write_bytes(b"\0\1\2" * 99)
        assert said in convert(name, code=1)[0]
    with h5py.File(runs.work / "two.h5", "w") as stream:
        stream["a"] = stream["b"] = DISC
    assert "one of a, b" in convert("two.h5", code=1)[0]
    convert("two.h5", None, "--dataset", "b", "--voxel", "1,1")


@pytest.mark.parametrize("about", [
    {"space directions": np.diag([0.5, 0.5, 2.0]), "space units": ["um"] * 3},
    {"spacings": np.array([500.0, 500.0, 2000.0]), "units": ["nm"] * 3}, {}])
def test_nrrd(convert, runs, monkeypatch, about):
    """By the library, which gives arrays in the order x, y, z unless it is told not to."""
    def read(_, index_order):
        return BALL if index_order == "C" else BALL.T, about

    (runs.work / "a.nrrd").touch()
    monkeypatch.setitem(sys.modules, "nrrd", SimpleNamespace(read=read))
    _, cells = convert("a.nrrd", None, *([] if about else ["--voxel", "0.5,0.5,2"]))
    assert cells["volume"].sum() == pytest.approx((BALL > 0).sum() / 2)
    assert np.ptp(cells["z"]) == pytest.approx(4 * np.ptp(cells["x"]), 0.4)


@pytest.mark.parametrize("kind", [
    {}, {"ome": True}, {"imagej": True}, {"compression": "zlib"}, {"bigtiff": True}, "pages"])
def test_cut_off(convert, runs, kind):
    """Half of a file, however its pages lie in it."""
    file = runs.work / "half.tif"
    if kind == "pages":
        with tifffile.TiffWriter(file) as writer:
            for plane in BALL:
                writer.write(plane, contiguous=False)
    else:
        tifffile.imwrite(file, BALL, **kind)
    file.write_bytes(file.read_bytes()[:file.stat().st_size // 2])
    assert "cut off" in convert("half.tif", None, "--voxel", "1,1,1", code=1)[0]


@pytest.mark.parametrize("name", ["half.png", "half.npy", "half.h5"])
def test_damaged(convert, runs, name):
    file = runs.work / name
    {"png": as_png, "npy": lambda place: np.save(place, DISC), "h5": as_hdf5}[name[5:]](file)
    file.write_bytes(file.read_bytes()[:file.stat().st_size // 2])
    assert "cannot be read" in convert(name, code=1)[0]


def test_numbers_of_any_size(convert, runs):
    big = np.where(DISC > 0, DISC.astype(np.uint64) + np.uint64(2**63), np.uint64(0))
    assert len(convert("big.npy", big, "--voxel", "1,1")[1]) == 40
    assert len(convert("float.npy", DISC * 2.0**70, "--voxel", "1,1")[1]) == 40
    np.save(runs.work / "marker.npy", np.where(DISC == 3, np.nan, DISC))
    words = ("--voxel", "1,1", "--marker", "marker.npy")
    assert "1 cells have none" in convert("disc.npy", DISC, *words, code=1)[0]
    np.save(runs.work / "marker.npy", np.where(np.indices(DISC.shape)[0] == 20, np.nan, DISC))
    convert("disc.npy", DISC, *words)


def test_units_of_z(convert, runs):
    """ImageJ's zunit; and edges that cannot be right are refused before any work."""
    about = {"axes": "ZYX", "spacing": 1000.0, "unit": "um", "zunit": "nm"}
    tifffile.imwrite(runs.work / "z.tif", BALL, imagej=True, resolution=(1, 1), metadata=about)
    assert convert("z.tif")[1]["volume"].sum() == (BALL > 0).sum()
    assert "is the unit right" in convert("z.tif", None, "--voxel", "1,1,1000", code=1)[0]
    assert "is the unit right" in convert("z.tif", None, "--voxel", "0.001,0.001,1", code=1)[0]


def lineages(keep, gap, seed):
    """Twelve times of cells that move and divide about three times each; gaps between cells."""
    rng, numbers = np.random.default_rng(seed), iter(range(1, 9999))
    grid = np.stack(np.meshgrid(*[np.arange(-30, 31)] * 2), -1)
    places = [place for place in rng.uniform(-25, 25, (40, 2)) if np.linalg.norm(place) < 25][:15]
    cells = [[next(numbers), place, rng.uniform(0, 4)] for place in places]
    for time in range(12):
        size = 27 * (np.pi / len(cells)) ** 0.5
        for cell in [cell for cell in cells if cell[2] < time]:
            half = rng.normal(size=2)
            half *= 0.25 * size / np.linalg.norm(half)
            cells.append([next(numbers), cell[1] + half, time + rng.uniform(2.4, 5.6)])
            cell[:] = [cell[0] if keep else next(numbers), cell[1] - half,
                       time + rng.uniform(2.4, 5.6)]
        for cell in cells:
            cell[1] = cell[1] + 0.05 * size * rng.normal(size=2)
        far, own = cKDTree([cell[1] for cell in cells]).query(grid)
        yield np.array([cell[0] for cell in cells])[own] * (
            (np.linalg.norm(grid, axis=-1) < 27) & (far < gap * size))


@pytest.mark.parametrize("keep, gap", [(False, 1), (True, 1), (False, 0.45), (True, 0.45)])
def test_tracked_divisions(keep, gap):
    """Daughters have new labels, or one of them has the mother's; cells touch, or not."""
    frames = np.array(list(lineages(keep, gap, seed=1)))
    names, stack = np.unique(frames, return_inverse=True)
    assert len(names) > 90
    with pytest.raises(Refused, match="tyx or zyx"):
        labels.refuse_times(stack.reshape(frames.shape))
    alone = np.where(frames > 0, frames + 1000 * np.arange(12)[:, None, None], 0)
    with pytest.raises(Refused, match="tyx or zyx"):  # not tracked, but numbered on
        labels.refuse_times(np.unique(alone, return_inverse=True)[1].reshape(frames.shape))


@pytest.mark.parametrize("thick", [1, 2, 4])
def test_stacks_are_not_asked_about(thick):
    for stack in (BALL, round_tissue(3, 185, 30, 18)):
        labels.refuse_times(stack[::thick])


def test_time_lapse(convert):
    """A stack of times is asked about; the answer chooses one."""
    frames = np.stack([DISC, np.roll(DISC, 1, 0), np.roll(DISC, 2, 0), np.roll(DISC, 3, 1)])
    assert "--axes tyx" in convert("lapse.npy", frames, "--voxel", "1,1", code=1)[0]
    _, cells = convert("lapse.npy", frames, "--voxel", "1,1", "--axes", "tyx", "--frame", "2")
    assert cells["volume"].sum() == (DISC > 0).sum() and "z" not in cells
    convert("lapse.npy", frames, "--voxel", "1,1,4", "--axes", "zyx")
    _, cells = convert("four.npy", np.stack([BALL, BALL]), "--voxel", "1,1,1", "--axes", "tzyx",
                       "--frame", "1")
    assert len(cells) == 60
    np.testing.assert_allclose(
        convert("turned.npy", BALL.T, "--voxel", "1,1,1", "--axes", "xyz")[1], cells)
