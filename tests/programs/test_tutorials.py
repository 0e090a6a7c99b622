# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The pages that people follow from begin to end, run as they stand, in a directory
with the names of the tree: what their blocks claim, they assert."""
import json
import os
import re
import shutil
import subprocess

import matplotlib
import numpy as np
import pytest
from morula.run import Run

from tests.common.program import TESTS

pytestmark = pytest.mark.release

ROOT = TESTS.parent
BLOCK = re.compile(r"<!-- run: [\w-]+ -->\n```(\w+)\n(.*?)^```", re.S | re.M)
COMMAND = re.compile(r"^    ((?:build|contrib)/\S(?:.*\\\n)*.*)$", re.M)
# Further lines of the scenes that the steps' commands are tried with: whether they can
# be followed does not depend on the number of cells.
CELLS = "subsection Tissue\n  set Cell spacing = {}\nend\n"
COARSER = {
    1: "", 2: CELLS.format(20), 3: CELLS.format(20), 5: CELLS.format(20),
    4: CELLS.format(25) + "subsection Time\n  set End time = 1\nend\n",
    6: CELLS.format(40) + "subsection Grid\n  set Spacing = 100\nend\n"
    "subsection Time\n  set End time = 2.5\nend\n",
    7: CELLS.format(10) + "subsection Grid\n  set Spacing = 50\nend\n"}


@pytest.fixture
def tree(runs, monkeypatch, tmp_path):
    """The working directory. A scene without `morula=` takes the program of the tree."""
    matplotlib.use("Agg")
    for name in ("contrib", "doc"):
        (tmp_path / name).symlink_to(ROOT / name)
    build = runs.options.morula.parent
    (tmp_path / "build").symlink_to(build)
    shutil.copytree(ROOT / "prm", tmp_path / "prm")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", f"{build}:{os.environ['PATH']}")
    return tmp_path


def follow(command):
    """What a command prints."""
    return subprocess.run(["bash", "-euc", command], text=True, check=True,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE).stdout


def follow_blocks(page):
    """Runs the marked blocks of a page in their order; returns Python's names."""
    names = {}
    blocks = BLOCK.findall((ROOT / "doc" / page).read_text())
    assert blocks
    for language, text in blocks:
        if language == "sh":
            follow(text)
        else:
            exec(compile(text, page, "exec"), names)
    return names


def assert_pictures(tree, number):
    """So many pictures with something in them."""
    found = list(tree.glob("output/**/*.png"))
    assert len(found) == number
    assert all(picture.stat().st_size > 10000 for picture in found)


def test_readme(tree):
    """From the held half up, the tissue becomes clearly narrower, and then wider."""
    text = (ROOT / "README.md").read_text().partition("## Your first tissue")[2]
    scene, commands = re.findall(r"^```\n(.*?)^```$", text, re.M | re.S)[:2]
    assert scene == (ROOT / "prm/bud.prm").read_text()
    (tree / "bud.prm").write_text(scene)
    assert len(commands.splitlines()) == 4
    for line in commands.splitlines():
        follow(line)
    surface = Run("output/bud").surface(-1)
    radius = np.hypot(surface["x"], surface["y"])
    height = np.floor(surface["z"] / 10).astype(int)
    widths = [radius[height == k].max() for k in range(height.max() + 1)]
    waist = int(np.argmin(widths[:12]))
    assert max(widths[:waist]) > 1.08 * widths[waist]
    assert max(widths[waist:]) > 1.25 * widths[waist]
    assert_pictures(tree, 1)
    assert "<html" in (tree / "output/bud/report.html").read_text()[:200]


@pytest.mark.parametrize("step", COARSER)
def test_steps(tree, step):
    with (tree / f"prm/step-{step}.prm").open("a") as scene:
        scene.write(COARSER[step])
    commands = COMMAND.findall((ROOT / f"doc/steps/step-{step}.md").read_text())
    assert commands
    for command in commands:
        follow(command)
    assert_pictures(tree, sum(command.startswith("contrib/render") for command in commands))


def test_first_tissue(tree):
    names = {}
    book = json.loads((ROOT / "doc/first-tissue.ipynb").read_text())
    cells = [cell for cell in book["cells"] if cell["cell_type"] == "code"]
    assert len(cells) > 5
    for number, cell in enumerate(cells):
        assert cell["outputs"] == [], "measured numbers are not kept"
        exec(compile("".join(cell["source"]), f"cell {number}", "exec"), names)
    assert names["run"].finished
    picture = names["run"].show("energy_density", panels=1)._repr_png_()
    assert picture[1:4] == b"PNG"


def test_from_an_image(tree):
    names = follow_blocks("from-an-image.md")
    assert names["scene"]["Tissue/Points surface"] == "surface.off"


def test_fit_a_spheroid(tree):
    names = follow_blocks("fit-a-spheroid.md")
    # kept runs: the same point again, without a run
    again = names["model"].map([names["prior"][names["best"]]])
    assert abs(again[0] - names["found"][names["best"]]).max() < 1e-12
