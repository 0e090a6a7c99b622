# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What `cmake --install` makes: whole, movable, and found by CMake in a project of one's
own, contrib/example-project, line by line as its README says."""
import os
import re

import numpy
import pytest
from morula.execute import call
from morula.run import Run
from tests.common.program import TESTS

pytestmark = pytest.mark.release
ROOT = TESTS.parent
EXAMPLE = ROOT / "contrib/example-project"
CUBE = (TESTS / "programs/small-cube.prm", "-s", "Time/End time=0.125")


def said(runs, *words, cwd=None, code=0):
    """What a command prints, with a home of its own, and without this tree's packages
    for Python."""
    ended = call(words, cwd=cwd or runs.work,
                 env={"PYTHONPATH": "", "HOME": f"{runs.work}/home"})
    assert ended.code == code, f"{' '.join(map(str, words))}\n{ended.text}"
    return ended.text


@pytest.fixture(scope="module")
def installed(runs):
    """An installation that was moved."""
    (runs.work / "home").mkdir()
    first = runs.work / "first"
    said(runs, "cmake", "--install", runs.options.morula.parent, "--prefix", first)
    return first.rename(runs.work / "home/morula")


def test_files(runs, installed):
    """Nothing names this tree."""
    files = {file.relative_to(installed).as_posix(): file.read_bytes()
             for file in installed.rglob("*") if file.is_file()}
    expected = {"lib/libmorula.a", "share/morula/LICENSE", "share/morula/prm/paper/fig-4b.prm",
                "share/morula/prm/examples/two-lumens.csv", "share/doc/morula/copyright",
                "share/doc/morula/doc/parameters.md", "share/doc/morula/doc/steps/step-1.md"}
    expected |= {str(file.relative_to(ROOT)) for file in (ROOT / "include").rglob("*.h")}
    for file in (installed / "bin").iterdir():
        expected |= {f"share/man/man1/{file.name}.1",
                     f"share/bash-completion/completions/{file.name}"}
    assert expected <= set(files)
    for place in (ROOT, runs.options.morula.parent, runs.work):
        assert not [name for name, data in files.items() if os.fsencode(place) in data]


def test_tools(runs, installed):
    """They find their modules and the program beside them, and write nothing there."""
    before = sorted(installed.rglob("[!_]*.*"))
    tools = installed / "bin"
    output = runs.work / "run"
    for words in (("morula", *CUBE, "-s", f"Output directory={output}"),
                  ("morula-sweep", *CUBE, "--seeds", "1-2"),
                  ("morula-cell-shapes", output),
                  ("morula-render", output, "--output", runs.work / "cells.png"),
                  ("morula-report", output)):
        said(runs, tools / words[0], *words[1:])
    for file in ("output/sweep/small-cube", "cells.png", "run/report.html"):
        assert (runs.work / file).exists()
    assert sorted(installed.rglob("[!_]*.*")) == before
    for words in (("morula-export",), ("morula", "export")):
        assert said(runs, tools / words[0], *words[1:], "--help").startswith(
            "usage: morula export ")
    said(runs, tools / "morula", "shapes", output)


def test_example(runs, installed):
    """Every command of its README; theta = exp((k/a) (1 - exp(-a t))) without stress."""
    readme = (EXAMPLE / "README.md").read_text()
    use = re.findall(r"^```\n(.*?)^```$", readme, re.M | re.S)[1].splitlines()
    where, printed = runs.work, {}
    for line in use:
        if line.startswith("cd "):
            where /= line[3:]
        else:
            printed[line] = said(runs, "bash", "-c", line, cwd=where)
    rows = Run(where / "output/spheroid").statistics
    theta = numpy.exp(0.7 * (1 - numpy.exp(-0.5 * rows["time"])))
    assert f"that is {theta.iloc[-1]:.3f}, " in readme
    volume, height = rows["total_volume"], rows["zmax"]
    numpy.testing.assert_allclose(volume / volume[0], theta**3, rtol=1e-5)
    numpy.testing.assert_allclose(height / height[0], theta, rtol=1e-4)
    assert rows["max_energy_density"].max() < 1e-8
    line, = re.findall(r"^```text\n(.*?)^```$", readme, re.M | re.S)
    assert line in printed["build/my-morula spheroid.prm --explain"]
    assert "subsection Gompertz" in printed["build/my-morula --parameters"]
    # Another build type than the library's.
    said(runs, "cmake", "-DCMAKE_BUILD_TYPE=Debug", "build", cwd=where)
    said(runs, "cmake", "--build", "build", cwd=where)
    said(runs, "build/my-morula", "spheroid.prm", "-s", "Time/End time=0.5", "--replace", cwd=where)


def test_steps(runs, installed):
    """Their sources compile out of the tree, with the file that step 4 reads beside them."""
    share, build = installed / "share/morula", runs.work / "steps"
    said(runs, "cmake", "-S", share / "steps", "-B", build, f"-DCMAKE_PREFIX_PATH={installed}")
    said(runs, "cmake", "--build", build)
    for n in range(1, 8):
        assert "valid" in said(runs, build / f"step-{n}", share / f"prm/step-{n}.prm", "--explain")
    assert (share / "doc/data/half-fixed-sphere.csv").is_file()


PROJECT = "project(none LANGUAGES CXX)\n"
FIND = "find_package(Morula REQUIRED)\n"


@pytest.mark.parametrize("text, message", (
    (f"{PROJECT}set(CMAKE_DISABLE_FIND_PACKAGE_deal.II ON)\n{FIND}", "built with deal.II 9"),
    (f"{PROJECT}set(CMAKE_DISABLE_FIND_PACKAGE_Boost ON)\n{FIND}", "program_options is not"),
    (f"{PROJECT}set(CMAKE_FIND_LIBRARY_PREFIXES no)\n{FIND}", "needs the library mpfr"),
    (FIND + PROJECT, "call project"),
    (f"{PROJECT}find_package(Morula 99 REQUIRED)\n", 'compatible with requested version "99"')))
def test_what_is_missing(runs, installed, tmp_path, text, message):
    (tmp_path / "CMakeLists.txt").write_text("cmake_minimum_required(VERSION 3.16)\n" + text)
    printed = said(runs, "cmake", tmp_path, f"-DCMAKE_PREFIX_PATH={installed}", cwd=tmp_path,
                   code=1)
    assert message in " ".join(printed.split())
