# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""morula.Scene, Run, Function and map: what they say, that interrupted runs go on
to the same cells, that further runs start at once; and the package in a virtual
environment, as doc/python.md says."""
import math
import os
import re
import shutil
import signal
import subprocess
import time

import numpy as np
import pandas
import pytest
from morula import Function, Refused, Run, Scene, map
from morula.execute import call
from tests.common.program import TESTS, assert_same_file

ROOT = TESTS.parent
CUBE = TESTS / "programs/small-cube.prm"
RATE = "Proliferation/Cell cycle/G0 exit rate"
PATIENCE = 120  # s

SCRIPT = """
from morula import Scene
scene = Scene({cube!r}, morula={morula!r})
scene["Output/Snapshot interval"] = 0.125
scene["Time/Step"] = 0.03125
print(scene.run({directory!r}, progress=False))
"""


def cells_at_end(run):
    return run.statistics["cells"].iloc[-1]


@pytest.fixture
def scene(runs):
    return Scene(CUBE, morula=runs.options.morula)


@pytest.fixture(scope="module")
def whole(runs):
    """A run by the program itself."""
    return runs.run("whole", CUBE)


def test_scene(runs, scene):
    assert scene["Grid/Spacing"] == "35"
    assert scene["Material/Poisson's ratio"] == "0.4"  # a default
    scene["Method"] = "consistent"
    assert scene["Boundary conditions/Nitsche penalty"] == "20"
    scene["Grid/Extension"], scene["Grid/Offset"] = True, [1, 2, 3]
    assert (scene["Grid/Extension"], scene["Grid/Offset"]) == ("true", "1, 2, 3")
    with pytest.raises(Refused, match="Did you mean 'Grid/Spacing'"):
        scene["Grid/Spacng"] = 3
    with pytest.raises(Refused, match="a key that exists"):
        scene["Cell types/stem/Where"] = "X > 0"
    scene["Cell types/Names"] = ["stem", "leaf"]
    scene["Cell types/stem/Where"] = "X > 0"
    assert scene.about(RATE).unit == "1/day"
    said = scene.explain()
    assert (said["cells"], said["dimension"]) == (125, 3)
    assert [kind["name"] for kind in said["types"]] == ["stem", "leaf"]
    assert said["keys"]["Grid/Offset"] == "1, 2, 3"
    with pytest.raises(Refused, match="Grid/Spacing"):
        scene.with_keys({"Grid/Spacing": -1}).explain()
    assert scene["Grid/Spacing"] == "35"
    # written and read again it is the same scene
    again = Scene(scene.save(runs.work / "again.prm"), morula=runs.options.morula)
    assert again.explain()["keys"] | {"Output directory": ""} == (
        said["keys"] | {"Output directory": ""})
    assert "small-cube" in repr(scene) and "Grid/Spacing" in scene._repr_html_()


def test_run(scene, whole, tmp_path):
    scene = scene.with_keys({"Time/End time": 0.5})
    run = scene.run(tmp_path, progress=False)
    assert_same_file(tmp_path / "cells-0001.csv", whole.directory / "cells-0001.csv")
    assert run.finished
    assert list(run.cells(0.5)["x"]) == list(run.cells()["x"])
    with pytest.raises(Refused, match="0, 0.5"):
        run.cells(0.3)
    assert "finished, day 0.5 after 4 steps" in repr(run)
    assert "<table>" in run._repr_html_()
    assert run.lineage.clones["alive"].sum() == len(run.cells())
    written = (tmp_path / "statistics.csv").stat().st_mtime_ns
    scene.run(tmp_path, progress=False)  # is there already
    assert (tmp_path / "statistics.csv").stat().st_mtime_ns == written
    other = scene.with_keys({"Grid/Spacing": 40})
    with pytest.raises(Refused, match="again=True"):
        other.run(tmp_path, progress=False)
    other.run(tmp_path, progress=False, again=True)
    with pytest.raises(Refused, match="Spacing"):
        scene.with_keys({"Grid/Spacing": -1}).run(tmp_path)


def test_tree(whole):
    lineage = whole.lineage
    founder = int(lineage.clone_sizes.argmax())

    def members(cell, tree):
        return {cell}.union(*(members(*item) for item in tree.items()))

    assert members(founder, lineage.tree(founder)) == set(lineage.clone(founder))
    axes = lineage.plot(founder, end=1.0)
    n = len(lineage.clone(founder))
    assert n > 1
    assert len(axes.lines) == n + n // 2  # and one a division


@pytest.mark.release
def test_interrupted(runs, scene):
    """Ctrl-C saves; the same call goes on to the same cells."""
    directory, whole = runs.work / "interrupted", runs.work / "uninterrupted"
    scene.with_keys({"Time/Step": 0.03125, "Output/Snapshot interval": 0.125}).run(
        whole, progress=False)
    words = [ROOT / "contrib/python/launch", "-c", SCRIPT.format(
        cube=str(CUBE), morula=str(runs.options.morula), directory=str(directory))]
    process = subprocess.Popen(words, stdout=subprocess.PIPE, text=True,
                               stderr=subprocess.PIPE)
    deadline, table = time.monotonic() + PATIENCE, directory / "statistics.csv"
    while not table.is_file() or table.read_text().count("\n") < 4:
        assert process.poll() is None and time.monotonic() < deadline
        time.sleep(0.005)
    process.send_signal(signal.SIGINT)
    said = process.communicate(timeout=PATIENCE)[1]
    assert process.returncode != 0 and "the same call goes on" in said
    assert not Run(directory).finished
    assert (directory / "snapshot.h5").is_file()
    rows = table.read_text().count("\n")
    assert "finished, day 1" in runs.call(words).stdout
    assert table.read_text().count("\n") > rows
    for name in ("lineage.csv", "cells-0002.csv"):
        assert_same_file(directory / name, whole / name)


def test_function(runs, scene, tmp_path):
    scene = scene.with_keys({"Time/End time": 0.25})
    f = Function(scene, {"rate": RATE, "spacing": "Grid/Spacing"}, cells_at_end,
                 directory=tmp_path)
    with pytest.warns(UserWarning, match="nan at .*rate = '-1'"):
        values = f.map([(2, 35), (8, 35), (-1, 35), {"rate": 8, "spacing": 35}], jobs=2)
    direct = [cells_at_end(runs.run(f"rate-{rate}", CUBE, {
        "Time/End time": 0.25, RATE: rate})) for rate in (2, 8)]
    assert list(values[:2]) == direct
    assert math.isnan(values[2]) and values[3] == values[1]
    records = sorted(tmp_path.glob("runs/*/run.json"))
    before = [file.stat().st_mtime_ns for file in records]
    assert f(rate=2, spacing=35) == f(2, 35) == f([2, 35]) == values[0]
    assert before == [file.stat().st_mtime_ns for file in records]
    assert f.run(2, 35).number(RATE) == 2
    with pytest.raises(Refused, match="rate, spacing"):
        f(2)
    with pytest.raises(Refused, match="a key that exists"):
        Function(scene, ["Grid/Spacng"], cells_at_end)
    both = Function(scene, lambda share: {RATE: 2 * share},
                    lambda run: run.statistics["cells"].to_numpy()[[0, -1]],
                    directory=tmp_path)
    assert list(both(1)) == [125, direct[0]]
    assert all(math.isnan(value) for value in both(-1))
    named = Function(scene, [RATE], ["cells", "cells:max(generation)"], directory=tmp_path)
    assert list(named(2)) == [direct[0], f.run(2, 35).cells()["generation"].max()]
    assert Function(scene, [RATE], "zmax", directory=tmp_path)(2) == (
        f.run(2, 35).statistics["zmax"].iloc[-1])
    with pytest.raises(Refused, match="Shape/Numbers = true"):
        Function(scene, [RATE], "roundness")


START = """
from morula import Scene, map
scene = Scene({cube!r}, morula={morula!r})
scene["Time/Step"], scene["Time/End time"], scene["Output/Formats"] = 0.01, 40, "none"
{act}
"""
RUN, MAP = "scene.run({0!r}, progress=False, ranks={1})", (
    "map(scene, [{{'Grid/Spacing': 35 + n}} for n in range(8)], lambda run: 1, directory={0!r}, "
    "jobs=2, progress=False)")
THREAD = "import threading; threading.Thread(target=lambda: " + RUN + ").start()"


@pytest.mark.parametrize("act, number, ranks", [
    (RUN, signal.SIGKILL, 1), (MAP, signal.SIGTERM, 1), *(
        pytest.param(*case, marks=pytest.mark.release) for case in (
            (RUN, signal.SIGTERM, 1), (RUN, signal.SIGHUP, 1), (THREAD, signal.SIGKILL, 1),
            (MAP, signal.SIGKILL, 1), (RUN, signal.SIGKILL, 2)))],
    ids=["kill", "term-map", "term", "hup", "kill-thread", "kill-map", "kill-ranks"])
def test_runs_end_with_their_python(runs, tmp_path, act, number, ranks):
    """However it ends, and with a snapshot; a run whose Python lives goes on."""
    place = tmp_path / "runs"
    words = [ROOT / "contrib/python/launch", "-c", START.format(
        cube=str(CUBE), morula=str(runs.options.morula), act=act.format(str(place), ranks))]

    def rows():
        return [file.read_text().count("\n") for file in place.rglob("statistics.csv")]

    def wait(done):
        deadline = time.monotonic() + PATIENCE
        while not done():
            assert time.monotonic() < deadline
            time.sleep(0.05)

    with subprocess.Popen(words, stderr=subprocess.DEVNULL) as process:
        wait(lambda: len(rows()) == 1 + (act == MAP) and min(rows()) > 5)
        process.send_signal(number)
    wait(lambda: len(list(place.rglob("snapshot.h5"))) == len(rows()))
    for log in place.rglob("log.txt"):
        wait(lambda: "Stopped at t = " in log.read_text())


def test_values(runs, scene, tmp_path):
    """3.0 is 3, also of NumPy; why a value is nan is said; signs are refused."""
    f = Function(scene.with_keys({"Time/End time": 0.125}), ["Random seed"], cells_at_end,
                 directory=tmp_path)
    assert f(3.0) == f(3) == f(np.float32(3)) > 0
    with pytest.warns(UserWarning, match="Random seed = '2.5'"):
        assert math.isnan(f(2.5))
    for value in ("a#b", "a\\", "a\nb"):
        scene["Output directory"] = value
        with pytest.raises(Refused, match="Output directory"):
            scene.save(tmp_path / "scene.prm")
    folder = tmp_path / "sub"
    folder.mkdir()
    (folder / "base.prm").write_text("subsection Grid\n  set Spacing = 41 # um\nend\n")
    (folder / "top.prm").write_text("include base.prm\nset Random \\\n  seed = 7\n")
    read = Scene(folder / "top.prm", morula=runs.options.morula)
    assert (read["Grid/Spacing"], read["Random seed"]) == ("41", "7")


def test_map(runs, tmp_path):
    samples = pandas.DataFrame({"Tissue/Radius": [30, 40, -1],
                                "Grid/Spacing": [20, 20, 20]})
    scene = Scene({"Dimension": 2, "Time/End time": 0.1, "Tissue/Cell spacing": 5},
                  name="disc", morula=runs.options.morula)
    found = map(scene, samples, lambda run: {"cells": cells_at_end(run)},
                directory=tmp_path, progress=False)
    assert list(found) == [*samples, "cells"]
    assert math.isnan(found["cells"][2]) and found["cells"][1] > found["cells"][0]
    named = map(scene, samples[:2], ["cells", "xmax"], directory=tmp_path, progress=False)
    assert list(named["cells"]) == list(found["cells"][:2]) and (named["xmax"] > 25).all()


@pytest.mark.release
def test_further_runs_start_at_once(runs, scene, tmp_path):
    """Forks of one process: from the call to the first row of a run that is not the
    first. (The limit on an idle machine is 0.05 s; others may be at work here.)"""
    f = Function(scene.with_keys({"Time/End time": 0.125}), [RATE],
                 lambda run: run.statistics["wall_seconds"].iloc[0],
                 directory=tmp_path)
    f.map([1, 2, 3])
    started = min(f(rate) for rate in (4, 5, 6, 7, 8))
    begun = time.monotonic()
    runs.call([runs.options.morula, CUBE, "--explain"], call=call)  # no fork
    assert started < min(0.15, 0.5 * (time.monotonic() - begun))


@pytest.mark.release
def test_virtual_environment(runs, tmp_path):
    """As doc/python.md says, offline: pip has no index to ask."""
    page = (ROOT / "doc/python.md").read_text()
    text = re.search(r"<!-- run: install -->\n```sh\n(.*?)```", page, re.S)[1]
    shutil.copytree(ROOT / "contrib/python", tmp_path / "contrib/python",
                    ignore=shutil.ignore_patterns("build", "*.egg-info"))
    environment = {**os.environ, "PIP_NO_INDEX": "1",
                   "PATH": f"{runs.options.morula.parent}:/usr/bin:/bin"}
    environment.pop("PYTHONPATH", None)

    def output_of(*words):
        return subprocess.run(words, cwd=tmp_path, check=True, env=environment,
                              text=True, stdout=subprocess.PIPE).stdout.split()

    output_of("bash", "-euc", text)
    tools = tmp_path / "my-environment/bin"
    place, spacing = output_of(
        tools / "python", "-c", "import morula, morula.api.scene as s; "
        "print(morula.__file__); print(morula.Scene({})['Grid/Spacing'])")
    assert place.startswith(str(tmp_path / "my-environment")) and spacing == "50"
    for tool in ("import", "sweep"):
        output_of(tools / f"morula-{tool}", "--help")
