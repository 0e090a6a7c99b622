# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Bad input through the program: exit code 1, key (or option, or file), value and remedy
on stderr, nothing on stdout, and no output directory. tests/program/refusals.txt lists
all kinds; these are some of each stage, and what only the program refuses.
"""
import re

import pytest

from tests.common.program import TESTS, overrides

pytestmark = pytest.mark.quick
SCENE = TESTS / "programs/small-cube.prm"
CYCLE, CONDITIONS = "Proliferation/Cell cycle/", "Boundary conditions/"
MESH = {CONDITIONS + "Slip where": "", CONDITIONS + "Slip normal": "", "Tissue/Shape": "mesh"}
POINTS = {**MESH, "Tissue/Shape": "points"}
FIELD = {"Fields/Names": "oxygen", "Fields/oxygen/Diffusion": "1e8"}


def check(fresh, result, texts):
    assert result.stdout == ""
    assert re.search(r"(?ms)^morula: .*( = '.*': allowed is |unknown |' is not closed)",
                     result.stderr)
    assert result.stderr.count("morula: ") == 1
    for text in texts:
        assert text in result.stderr
    assert "exception" not in result.stderr.lower()
    assert ".cc" not in result.stderr
    assert not (fresh.work / "output").exists()


@pytest.mark.parametrize("key, value, remedy, more, ranks", [
    # the parser
    ("Grid/Spcing", "50", "Did you mean 'Grid/Spacing'?", {}, 1),
    ("Gird/Spacing", "50", "Did you mean 'Grid/Spacing'?", {}, 1),
    ("Tissue/Shape", "spere", "Did you mean 'sphere'?", {}, 1),
    ("Time/End time", "long", "Correct the value", {}, 1),
    # values, alone and beside others
    ("Grid/Spacing", "-50", "Choose some cell spacings", {}, 3),
    ("Material/Poisson's ratio", "0.5", "0.499", {}, 1),
    ("Time/Step", "0.6", "lengthen", {}, 1),
    ("Material/Energy per", "initial volume", "Death/Shrinking time", {"Death/Rate": "1"}, 1),
    ("Tissue/Cell spacing", "0.01", "larger spacing", {}, 1),
    # expressions
    (CONDITIONS + "Slip where", "(Z <= 0", "Missing parenthesis", {}, 1),
    (CONDITIONS + "Fixed where", "Z < t", "remove t", {}, 1),
    ("Growth/Isotropic/Stretch", "1 - 1.5*t", "It is -0.5 at", {"Growth/Law": "isotropic"}, 1),
    # what is asked at founders and at the surface
    ("Material/Young's modulus", "X", "It is -24 at", {}, 3),
    (CYCLE + "Where", "Z > 400", "Proliferation/Law = none", {}, 3),
    (CONDITIONS + "Fixed where", "Z < -100", "leave it empty", {}, 3),
    ("Fields/oxygen/Consumption", "X", "Production", FIELD, 1),
    ("Fields/oxygen/Consumption", "0", "Without a sink", FIELD, 1),
    # files
    ("Tissue/Surface mesh", "nowhere.stl", "Check its name", MESH, 3),
    ("Tissue/Points file", "nowhere.csv", "Check its name", POINTS, 3)])
def test_keys(fresh, key, value, remedy, more, ranks):
    result = fresh.execute(SCENE, *overrides({**more, key: value}), ranks=ranks, code=1)
    check(fresh, result, [f"{key} = '", value, remedy])


def test_a_cell_astray_on_ranks(fresh):
    """One message, and no rank left waiting."""
    rows = [f"{12 * i},{12 * j},0" for i in range(9) for j in range(9)]
    file = fresh.write("cells.csv", "\n".join(["x,y,z", *rows, "1e6,0,0"]) + "\n")
    result = fresh.execute(SCENE, *overrides({**POINTS, "Tissue/Points file": file}), ranks=3,
                           code=1)
    check(fresh, result, ["cells.csv': ", "1e+06", "correct the cell that lies astray"])


@pytest.mark.parametrize("arguments", [(), ("--explain",)])
@pytest.mark.parametrize("old, new, key", [
    ("set End time = 1", "set End time = -1", "Time/End time"),
    ("set G0 exit rate = 2", "set G0 exit rate = 2 - X", CYCLE + "G0 exit rate"),
    ("set Slip where  = Z <= 0", "set Slip where = Z < -9", CONDITIONS + "Slip where")])
def test_places(fresh, arguments, old, new, key):
    """Values that are refused after the file has been read: file and line."""
    text = SCENE.read_text()
    scene = fresh.write("scene.prm", text.replace(old, new))
    number = 1 + text[:text.index(old)].count("\n")
    result = fresh.execute(scene, *arguments, code=1)
    check(fresh, result, [f"morula: {scene}:{number}: {key} = "])


def test_place_on_the_command_line(fresh):
    result = fresh.execute(SCENE, *overrides({"Time/End time": "-1"}), code=1)
    check(fresh, result, ["morula: -s: Time/End time = "])


@pytest.mark.parametrize("arguments, value, remedy", [
    ([SCENE, "-s", "Grid/Spacing"], "'Grid/Spacing'", "Put '='"),
    ([SCENE, "-s"], "-s", "'morula --help' explains"),
    ([SCENE, "--resumee"], "--resumee", "'morula --help' explains"),
    ([SCENE, "--explain=3"], "--explain takes", "'morula --help' explains"),
    (["a.prm", "b.prm"], "'a.prm' and 'b.prm'", "Name one scene"),
    ([], "Usage: morula", "Name the scene")])
def test_command_line(fresh, arguments, value, remedy):
    result = fresh.call([fresh.options.morula, *arguments], 1)
    assert result.stdout == "" and result.stderr.count("morula: ") == 1
    assert value in result.stderr and remedy in result.stderr


@pytest.mark.parametrize("content, said", [
    (None, "a .prm file that can be read"),
    (b"PK\x03\x04\0\0", ":1"), (b"subsection Grid\n  set Spacing = 5\n", ":1: subsection 'Grid'"),
    (b"\nsubsection Material\n  set Young's modulus = X\nend\n", ":3: Material/Young's modulus"),
    (b"include nowhere.prm\n", ":1"), (b"include scene.prm\n", ":1")])
def test_scenes(fresh, content, said):
    """Mistakes in the file itself name file and line; tests/scene/scene.cc has more."""
    scene = fresh.work / "scene.prm"
    if content is not None:
        scene.write_bytes(content)
    check(fresh, fresh.execute(scene, code=1), ["scene.prm", said])


def test_scene_that_cannot_be_read(fresh):
    """A directory, and a file that opens, but whose reading fails."""
    check(fresh, fresh.execute("/proc", code=1), ["a .prm file that can be read"])
    check(fresh, fresh.execute("/proc/self/mem", code=1), ["'/proc/self/mem'", "to its end"])


@pytest.mark.parametrize("place", ["file", "file/below", "/proc/nowhere"])
def test_output_directory(fresh, place):
    blocked = fresh.write("file", "kept\n")
    result = fresh.execute(SCENE, output=fresh.work / place, code=1)
    check(fresh, result, ["Output directory", place.split("/below")[0], "Choose another one"])
    assert blocked.read_text() == "kept\n"
