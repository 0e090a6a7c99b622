# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""contrib/render: cells are where they are, colours mean what they say, all
states and films, and what it refuses; and what tools say when a library of
Python is missing."""
import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from morula.draw import shading, spheres
from morula.draw.colours import OF_TYPES, colours_of, limits_of
from morula.draw.outline import inside_of_cut
from morula.draw.screen import virtual_screen
from morula.draw.view import cut_plane, view_of
from PIL import Image
from tests.common.program import SCENES

CONTRIB = Path(__file__).resolve().parents[2] / "contrib"
CUBE = SCENES.parent / "programs/small-cube.prm"
RED, BLUE = (200, 0, 0), (0, 0, 200)


@pytest.fixture(scope="module")
def screen():
    """For pictures that are drawn in this process."""
    with virtual_screen():
        yield


def balls(positions, radii, colours, gaps=0.0):
    """Their picture, looking along the y axis from below, and pixels of a µm."""
    view = view_of(np.array([[-30., -30, -30], [30, 30, 30]]), azimuth=-90, elevation=0)
    picture = spheres.render(np.array(positions, dtype=float), np.array(radii),
                             np.uint8(colours), view, (318, 318), gaps)
    assert picture.shape == (318, 318, 3)
    return picture, 318 / (2 * view.half_width)


def test_places(screen):
    """Two balls, one of them partly behind the other."""
    picture, scale = balls([(0, -20, 0), (12, 10, 5)], [10, 8], [RED, BLUE])
    rows, columns = np.indices(picture.shape[:2]) + 0.5
    across, up = (columns - 159) / scale, (159 - rows) / scale
    red = np.hypot(across, up)
    blue = np.hypot(across - 12, up - 5)
    edge = 1 / scale  # where a pixel is both
    is_red = picture[:, :, 0] > picture[:, :, 2]
    is_blue = picture[:, :, 2] > picture[:, :, 0]
    assert is_red[red < 10 - edge].all()
    assert is_blue[(blue < 8 - edge) & (red > 10 + edge)].all()
    outside = (red > 10 + edge) & (blue > 8 + edge)
    assert (picture[outside] == 1).all()
    # the middle is seen straight on: ambient light, and three lights
    light = 0.3
    for direction, strength in shading.LIGHTS:
        direction = np.array(direction) / np.linalg.norm(direction)
        light += 0.85 * strength * max(0, direction[2])
    assert picture[159, 159, 0] == pytest.approx(min(1, light * 200 / 255), abs=0.03)


def test_depth_decides(screen):
    """Not the order in which they come."""
    places, colours = [(0, -20, 0), (3, 10, 0)], [RED, BLUE]
    one, _ = balls(places, [10, 10], colours)
    other, _ = balls(places[::-1], [10, 10], colours[::-1])
    np.testing.assert_array_equal(one, other)


def test_gaps_are_dark(screen):
    """A ball in a hollow among others loses light, one alone does not."""
    alone = [(0, 0, 0)]
    ring = [(14 * np.cos(a), -12, 14 * np.sin(a)) for a in np.arange(0, 6.28, 0.52)]
    lone = [balls(alone, [8], [RED], gaps)[0][159, 159] for gaps in (0.0, 15.0)]
    np.testing.assert_allclose(*lone, atol=0.02)
    deep, _ = balls(alone + ring, [8] * 14, [RED] * 14, 15.0)
    assert deep[159, 159][0] < 0.85 * lone[0][0]


def test_discs(screen):
    """Cells of a 2-D run: the colour itself inside, a darker rim, white
    beside; where two overlap, the nearer middle's."""
    view = view_of(np.array([[-30., -30, 0], [30, 30, 0]]), flat=True)
    picture = spheres.render_discs(np.array([[0., 0, 0], [14, 0, 0]]), np.array([10., 10]),
                                   np.uint8([RED, BLUE]), view, (318, 318))
    scale = 318 / (2 * view.half_width)
    rows, columns = np.indices(picture.shape[:2]) + 0.5
    x, y = (columns - 159) / scale, (159 - rows) / scale
    one, other = np.hypot(x, y), np.hypot(x - 14, y)
    edge, rim = 1 / scale, 0.8 + 1 / scale
    red, blue = np.array(RED) / 255, np.array(BLUE) / 255
    for inner, colour in (((one < 10 - rim) & (one < other - edge), red),
                          ((other < 10 - rim) & (other < one - edge), blue)):
        np.testing.assert_allclose(picture[inner], np.tile(colour, (inner.sum(), 1)),
                                   atol=1e-6)
    rims = (np.abs(one - 9.7) < 0.1) & (other > 11)
    assert (picture[rims][:, 0] < 0.75 * red[0]).all()
    assert (picture[(one > 10 + edge) & (other > 10 + edge)] == 1).all()


def hollow_ball(radius=50.0, inner=0.0):
    """Cells of a ball, perhaps a hollow one, and its boundary points."""
    axis = np.arange(-radius, radius + 1, 5.0)
    cells = np.stack(np.meshgrid(axis, axis, axis), -1).reshape(-1, 3)
    far = np.linalg.norm(cells, axis=1)
    cells = cells[(far < radius) & (far > inner)]
    k = np.arange(4000) + 0.5
    height, turn = 1 - k / 2000, np.pi * (1 + 5**0.5) * k
    flat = np.sqrt(1 - height**2)
    unit = np.stack([flat * np.cos(turn), flat * np.sin(turn), height], 1)
    if not inner:
        return cells, (radius * unit, unit)
    return cells, (np.concatenate([radius * unit, inner * unit]),
                   np.concatenate([unit, -unit]))


@pytest.mark.parametrize("inner, height", [(0.0, 0.0), (0.0, 30.0), (25.0, 0.0)])
def test_outline_is_that_of_the_plane(inner, height):
    """Of a ball cut off its middle: the circle in the plane, as it is seen
    under an angle; of a hollow one, with the circle within."""
    cells, surface = hollow_ball(inner=inner)
    view = view_of(surface[0], 5.0, -60, 14)
    _, normal = cut_plane(surface[0], -60)
    pixels = view.pixels(300)
    mask = inside_of_cut(cells, 5.0, surface, (height * normal, normal), view, pixels)
    assert mask.shape == pixels[::-1]
    unit = view.direction / np.linalg.norm(view.direction)
    area = (mask > 0.5).sum() * (2 * view.half_width / 300)**2
    circle = np.pi * (50**2 - height**2 - inner**2) * abs(unit @ normal)
    assert abs(area / circle - 1) < 0.02


def test_no_outline_of_a_plane_seen_from_its_edge():
    cells, surface = hollow_ball()
    view = view_of(surface[0], 5.0, -60, 89.9)
    assert inside_of_cut(cells, 5.0, surface, cut_plane(surface[0], -60), view,
                         (300, 300)) is None


@pytest.mark.parametrize("field", ["pressure", "sigma_xy", "principal_stress_3"])
def test_colours_of_stress(field):
    """As far on both sides of zero, which is the middle colour."""
    values = np.array([-1.0, 0.5, 3.0])
    low, high = limits_of(field, values)
    assert low == -high
    assert np.ptp(colours_of(field, values).of([0.0])[0].astype(int)) < 25  # grey
    assert limits_of("energy_density", values)[0] > -1


def test_colours_of_names():
    """Phases and types have the same colour whichever of them there are, and all of
    them differ; a type that the run does not name has its number."""
    some, all_phases = (colours_of("phase", np.array(v)) for v in ([0, 4], [0, 1, 2, 3, 4, 9]))
    assert [*some.names.values()] == ["G0", "S", "G2", "M", "G1", "no cycle"]
    np.testing.assert_array_equal(some.of([0, 4, 9]), all_phases.of([0, 4, 9]))
    assert len({tuple(c) for c in some.of([0, 1, 2, 3, 4, 9])}) == 6
    names = [f"type{i}" for i in range(16)]
    few = colours_of("type", np.array([0, 1, 0]), types=names[:2])
    many = colours_of("type", np.array([5, 0]), types=names)
    assert [*few.names.values()] == names[:2]
    assert [*many.names.values()] == names
    np.testing.assert_array_equal(few.of([0, 1]), many.of([0, 1]))
    assert len({tuple(c) for c in many.of(range(16))}) == 16
    more = colours_of("type", np.array([0, 2]), types=names[:1])
    assert [*more.names.values()] == ["type0", "1", "2"]


@pytest.mark.parametrize("limits, extend", [
    (None, "both"), ((0, 10), "neither"), ((0, 5), "max"), ((5, 10), "min")])
def test_clipping(limits, extend):
    """Ends of the bar that stand for more than themselves are arrows."""
    assert colours_of("volume", np.linspace(0, 10, 1001), limits).extend == extend


def lattice(directory, n, number=0, spacing=10.0, column="phase"):
    """A file of the cells of a cube on day number/2."""
    directory.mkdir(exist_ok=True)
    axis = np.arange(n) * spacing
    x, y, z = (a.ravel() for a in np.meshgrid(axis, axis, axis))
    ids = np.arange(len(x))
    rows = np.stack([0 * x + 0.5 * number, ids, x, y, z, 0 * x + 1000, ids % 5,
                     np.sin(ids)], axis=1)
    np.savetxt(directory / f"cells-{number:04}.csv", rows, "%.10g", ",",
               header=f"time,id,x,y,z,volume,{column},pressure", comments="")
    return directory


@pytest.fixture(scope="module")
def growing(runs):
    """Three states of a lattice, each larger than the one before."""
    for i in range(3):
        directory = lattice(runs.work / "growing", 4, i, 10 + i)
    return directory


def render(runs, *words, code=0):
    done = runs.call([CONTRIB / "render", *words], code)
    assert "Traceback" not in done.stderr
    return done


def image(file):
    return np.asarray(Image.open(file))


def test_states(runs, growing):
    """All with one view and one meaning of the colours."""
    render(runs, growing, "--all", "--field", "pressure", "--width", "120")
    pictures = [image(growing / f"pressure-000{i}.png") for i in range(3)]
    white = [(p[60:-100, :120] > 250).all(axis=2).mean() for p in pictures]
    assert len({p.shape for p in pictures}) == 1
    assert white[0] > white[1] > white[2]


@pytest.mark.release
def test_films(runs, growing):
    film = runs.work / "film.gif"
    said = render(runs, growing, "--movie", "--panels", "2", "--width", "120", "--output", film)
    assert [line.partition(",")[0] for line in said.stderr.splitlines()] == [
        f"render: picture {i} of 3" for i in (1, 2, 3)]
    with Image.open(film) as frames:
        assert frames.n_frames == 3
        frames.seek(2)
        assert frames.info["duration"] == 1000
    film = runs.work / "film.ogv"
    render(runs, growing, "--movie", "--width", "120", "--output", film)
    assert film.read_bytes()[:4] == b"OggS"
    assert b"theora" in film.read_bytes()[:200]
    assert [f.name for f in runs.work.iterdir() if "part" in f.name] == []


@pytest.mark.skipif(not shutil.which("ffmpeg"), reason="there is no ffmpeg")
def test_film_by_ffmpeg(runs, growing):
    render(runs, growing, "--movie", "--width", "120")
    assert (growing / "volume.mp4").is_file()


def test_film_without_ffmpeg(runs, growing):
    """The sentence names what goes without it."""
    folder = runs.work / "bin"  # what the tool's own script needs
    folder.mkdir()
    for word in ("dirname", "readlink"):
        (folder / word).symlink_to(shutil.which(word))
    done = subprocess.run(
        [CONTRIB / "render", growing, "--movie", "--output", "a.mp4"], text=True, check=False,
        env={**os.environ, "PATH": str(folder)}, stderr=subprocess.PIPE)
    assert done.returncode == 1
    assert "ffmpeg" in done.stderr and ".gif" in done.stderr


def test_types(runs):
    """Are called as in the run's parameters.prm, with as much room as the
    longest name needs; without that file, by their numbers."""
    directory = lattice(runs.work / "types", 3, column="type")
    numbers, names = runs.work / "numbers.png", directory / "type.png"
    render(runs, directory, "--field", "type", "--width", "200", "--output", numbers)
    (directory / "parameters.prm").write_text(
        f"subsection Cell types\n  set Names = a, b, c, d, {'hypertrophic' * 3}\nend\n")
    # the field that is drawn unless another one is asked for
    render(runs, directory, "--width", "200")
    numbers, names = image(numbers), image(names)
    assert names.shape[1] > numbers.shape[1] + 200
    # all that is written lies within the picture
    assert (names[:, -4:] == 255).all()
    for colour in (to_rgb(c) for c in OF_TYPES[:5]):
        there = np.abs(names - 255 * np.array(colour)).max(axis=2) < 3
        assert there[:, 200:].sum() > 500


@pytest.mark.parametrize("words, texts", [
    (("--time", "2.5"), ("--time", "2.5", "from 0 to 1")),
    (("--time", "nan"), ("--time", "from 0 to 1")),
    (("--range", "3,1"), ("--range", "LOW,HIGH")),
    (("--range", "a"), ("--range", "LOW,HIGH")),
    (("--width", "0"), ("--width", "20 to 20000")),
    (("--field", "speed"), ("--field", "speed", "pressure")),
    (("--section",), ("--section", "--shapes")),
    (("--movie", "--fps", "0"), ("--fps", "above 0")),
    (("--movie", "--output", "a.avi"), ("a.avi", ".ogv", ".mp4")),
    (("--output", "/nowhere/a.png"), ("--output", "exists"))])
def test_refusals(runs, growing, words, texts):
    before = {*growing.iterdir()}
    said = render(runs, growing, *words, code=1).stderr
    assert all(text in said for text in texts)
    assert {*growing.iterdir()} == before


def test_thousands_of_cells(runs):
    """9,261 cells in two panels fill them both."""
    directory = lattice(runs.work / "many", 21)
    render(runs, directory, "--panels", "2", "--field", "pressure", "--width", "400")
    drawn = (image(directory / "pressure.png") < 200).any(axis=2)
    assert drawn.shape[1] > 800
    for panel in np.array_split(drawn, 2, axis=1):
        assert panel.mean() > 0.2


def test_displays(monkeypatch):
    """None of 0 to 9, where Open MPI looks for graphics cards, and none
    that another process has."""
    monkeypatch.setenv("DISPLAY", ":own")
    with virtual_screen():
        one = os.environ["DISPLAY"]
        with virtual_screen():
            other = os.environ["DISPLAY"]
    assert one != other
    assert min(int(display[1:]) for display in (one, other)) >= 10
    assert os.environ["DISPLAY"] == ":own"


def without(work, module, tool, *words):
    """Runs a tool where Python lacks a library."""
    stub = work / f"without-{module}" / module / "__init__.py"
    stub.parent.mkdir(parents=True, exist_ok=True)
    stub.write_text(f"raise ModuleNotFoundError(\"No module named '{module}'\", "
                    f"name='{module}')\n")
    return subprocess.run(
        [CONTRIB / tool, *words], text=True, check=False, capture_output=True,
        stdin=subprocess.DEVNULL, env={**os.environ, "PYTHONPATH": str(stub.parents[1])})


@pytest.mark.parametrize("module, package, tools", [
    pytest.param("vtkmodules", "python3-vtk9", ("report", "render", "cell-shapes"),
                 marks=pytest.mark.release),
    ("numpy", "python3-numpy", ("accuracy", "render", "report", "sweep")),
    ("matplotlib", "python3-matplotlib", ("render", "report"))])
def test_missing_libraries(runs, module, package, tools):
    """One sentence with the package's name, exit code 1."""
    words = ["--help"]
    if module == "vtkmodules":  # needed when VTU files are read
        words = [runs.run("vtu", CUBE, {"Time/End time": 0.25,
                                        "Output/Formats": "vtu"}).directory]
    for tool in tools:
        done = without(runs.work, module, tool, *words)
        assert done.returncode == 1
        assert done.stderr.startswith(f"{tool}: ")
        assert f"Debian's package {package}" in done.stderr
        assert len(done.stderr.splitlines()) == 1, done.stderr
