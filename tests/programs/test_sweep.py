# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""contrib/sweep: its numbers against those computed here from the runs, runs that
fail, runs that are interrupted, and what it refuses."""
import contextlib
import csv
import math
import os
import shutil
import signal
import statistics
import subprocess
import time
from pathlib import Path

import matplotlib.image
import numpy
import pytest
from morula.execute import cores, overrides
from morula.refusal import Refused
from morula.run import Run
from morula.sweep import request
from morula.sweep.ensemble import summary
from morula.sweep.options import parser
from tests.common import requests
from tests.common.program import (SCENES, TESTS, assert_same_columns,
                                  assert_same_file)

ROOT = TESTS.parent
DISC, CUBE = (TESTS / f"programs/{name}.prm" for name in ("disc", "small-cube"))
RATE = "Proliferation/Cell cycle/G0 exit rate"
VARY = ["--vary", f"{RATE}=1,2", "--vary", "Grid/Spacing=80,40"]
SLOW = [CUBE, "--seeds", "4", "-s", "Time/Step=0.03125"]
PATIENCE = 300  # s, for a machine that has other things to do


@pytest.fixture
def found(runs):
    """Where the tool writes: empty."""
    shutil.rmtree(runs.work / "found", ignore_errors=True)
    return runs.work / "found"


@pytest.fixture
def words(runs, found):
    return lambda *words: [str(word) for word in (
        ROOT / "contrib/sweep", *words, "--output", found, "--morula",
        runs.options.morula, "--mpiexec", runs.options.mpiexec)]


@pytest.fixture
def sweep(runs, words):
    """Runs the tool; what it says."""
    def call(*arguments, code=0):
        done = runs.call(words(*arguments), code)
        return done.stdout + done.stderr
    return call


def rows_of(file):
    with file.open(encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


@pytest.mark.quick
def test_summary():
    four, one = summary([1, 2, 3, 4]), summary([7])
    assert (four.n, four.mean, four.smallest, four.largest) == (4, 2.5, 1, 4)
    assert four.deviation == pytest.approx(math.sqrt(5 / 3))
    assert four.error == pytest.approx(math.sqrt(5 / 12))
    assert (one.n, one.mean) == (1, 7)
    assert math.isnan(one.deviation) and math.isnan(one.error)


def test_combinations(found, sweep):
    """Four of them with two seeds, and nothing is run twice."""
    command = [DISC, *VARY, "--seeds", "1-2", "--jobs", min(2, cores()),
               "--columns", "cells,xmax,surface:std(radius)"]
    assert "from before" not in sweep(*command)
    rows = rows_of(found / "runs.csv")
    assert len({(row[RATE], row["Grid/Spacing"], row["seed"]) for row in rows}) == 8
    for row in rows:
        run = Run(found / row["directory"])
        for key, value in ((RATE, row[RATE]), ("Grid/Spacing", row["Grid/Spacing"]),
                           ("Random seed", row["seed"])):
            assert run.keys[key] == value
        for column in ("time", "cells", "xmax", "unknowns"):
            assert float(row[column]) == run.statistics[column].iloc[-1]
        radius = numpy.linalg.norm(run.surface(-1)[["x", "y"]], axis=1)
        assert float(row["surface:std(radius)"]) == pytest.approx(radius.std(), 1e-6)
    table = rows_of(found / "table.csv")
    assert len(table) == 4 * len({row["column"] for row in table})
    for row in table:
        if row["column"] not in ("cells", "xmax"):
            continue
        ends = [float(run[row["column"]]) for run in rows
                if all(run[key] == row[key] for key in (RATE, "Grid/Spacing"))]
        assert (row["runs"], row["failed"]) == ("2", "0")
        deviation = statistics.stdev(ends)
        for name, value in (("mean", statistics.mean(ends)),
                            ("standard_deviation", deviation),
                            ("standard_error", deviation / math.sqrt(2)),
                            ("smallest", min(ends)), ("largest", max(ends))):
            assert float(row[name]) == pytest.approx(value, 1e-8)
    cells = {row[RATE]: float(row["mean"]) for row in table
             if row["column"] == "cells"}
    assert cells["2"] > cells["1"] + 20
    text = (found / "table.md").read_text(encoding="utf-8")
    assert "## xmax, um" in text and text.count("\n| 1 | ") == 6
    picture = matplotlib.image.imread(found / "sweep.png")
    assert picture.shape[1] > 800 and picture[:, :, :3].std() > 0.03
    assert sweep(*command).count("from before") == 8
    assert rows_of(found / "runs.csv") == rows


def test_samples(runs, found, sweep):
    """A line of the table is a combination; those that the program refuses are left
    out on request, and told; data files stand beside the scene."""
    folder = runs.work / "scene"
    folder.mkdir()
    (folder / "cells.csv").write_text("x,y\n" + "".join(
        f"{10 * i},{10 * j}\n" for i in range(9) for j in range(9)))
    scene = folder / "disc.prm"
    scene.write_text(DISC.read_text() + "subsection Tissue\n  set Shape = points\n"
                     "  set Points file = cells.csv\nend\n")
    table = runs.write("samples.csv", f'"{RATE}",Grid/Spacing\n'
                       "1,40\n# a comment\n3,-1\n2.5,45\n")
    words = [scene, "--samples", table, "-s", "Time/End time=0.2"]
    assert "Grid/Spacing=-1" in sweep(*words, code=1)
    said = sweep(*words, "--skip-refused")
    assert "is left out" in said and "2 of 2 runs finished" in said
    first, second = rows_of(found / "runs.csv")
    assert [(row[RATE], row["Grid/Spacing"]) for row in (first, second)] == [
        ("1", "40"), ("2.5", "45")]
    alone = runs.run("alone", scene, {"Time/End time": "0.2", RATE: "1",
                                      "Grid/Spacing": "40"})
    assert_same_file(found / first["directory"] / "lineage.csv",
                     alone.directory / "lineage.csv")
    table.write_text("Grid/Spacing\n-1\n")
    assert "some that Morula" in sweep(*words, "--skip-refused", code=1)


def test_types(found, sweep):
    """A key and a column that exist as the scene names types of cells."""
    key = "Cell types/stem/Transitions/To leaf"
    sweep(DISC, "-s", "Cell types/Names=stem, leaf", "--vary", f"{key}=0,5",
          "--columns", "cells_stem,cells_leaf")
    none, most = ({row["column"]: float(row["mean"])
                   for row in rows_of(found / "table.csv") if row[key] == rate}
                  for rate in ("0", "5"))
    assert (none["cells_leaf"], none["cells_stem"]) == (0, none["cells"])
    assert most["cells_leaf"] > most["cells_stem"]
    assert most["cells_leaf"] + most["cells_stem"] == most["cells"]


def test_runs_that_fail(found, sweep):
    """They are told, and the others are done."""
    said = sweep(SCENES / "without-extension-fails.prm", "--vary",
                 "Grid/Extension=false,true", "--columns", "zmax", code=2)
    for part in ("Extension = false", "exit code 2", "1 of 2 runs finished"):
        assert part in said
    failed, done = (row for row in rows_of(found / "table.csv")
                    if row["column"] == "zmax")
    assert (failed["runs"], failed["failed"], failed["mean"]) == ("0", "1", "nan")
    assert (done["runs"], done["failed"]) == ("1", "0")
    assert float(done["mean"]) > 0
    text = (found / "table.md").read_text(encoding="utf-8")
    assert "## Failed" in text and "0 of 1" in text


def run_with_snapshot(found, process, morula):
    """The process id of the only run, once it has written a snapshot."""
    deadline = time.monotonic() + PATIENCE
    while not list(found.glob("runs/*/output/snapshot.h5")):
        assert process.poll() is None and time.monotonic() < deadline
        time.sleep(0.002)
    for file in Path("/proc").glob("[0-9]*/cmdline"):
        with contextlib.suppress(OSError):
            words = file.read_bytes().decode(errors="replace").split("\0")
            if words[0] == os.path.realpath(morula) and any(
                    str(found) in word for word in words):
                return int(file.parent.name)
    raise AssertionError("the run has ended too early")


@pytest.mark.release
def test_interrupted(runs, found, words, sweep):
    """Ended with kill -9 while its run goes on: nobody else may write there until
    that run has ended, too; and then it is resumed."""
    whole = runs.run("whole", CUBE, {"Time/Step": "0.03125"}).directory
    process = subprocess.Popen(words(*SLOW), stdout=subprocess.DEVNULL)
    run = run_with_snapshot(found, process, runs.options.morula)
    os.kill(run, signal.SIGSTOP)
    process.kill()
    process.wait()
    try:
        assert "nobody else" in sweep(*SLOW, code=1)
    finally:
        os.kill(run, signal.SIGKILL)
    deadline = time.monotonic() + PATIENCE
    # The program that has started the run writes its cost last.
    while Path(f"/proc/{run}").exists() or not list(found.glob("runs/*/cost.json")):
        assert time.monotonic() < deadline
        time.sleep(0.01)
    time.sleep(0.2)
    assert "goes on from its snapshot" in sweep(*SLOW)
    resumed, = found.glob("runs/*/output")
    for name in ("lineage.csv", "cells-0002.csv"):
        assert_same_file(whole / name, resumed / name)
    assert_same_columns(whole / "statistics.csv", resumed / "statistics.csv",
                        ignore=["wall_seconds"])
    # a snapshot that cannot be resumed: the run begins anew
    (resumed / "snapshot.h5").write_text("damaged")
    record = resumed.parent / "run.json"
    record.write_text(record.read_text().replace('"exit": 0', '"exit": -9'))
    said = sweep(*SLOW)
    assert "goes on from its snapshot" in said and "1 of 1 runs finished" in said
    assert_same_file(whole / "lineage.csv", resumed / "lineage.csv")


def test_stopped(runs, found, words, sweep):
    """SIGTERM: no run is left over, nothing that has been done is lost."""
    process = subprocess.Popen(words(*SLOW), text=True, stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE)
    run = run_with_snapshot(found, process, runs.options.morula)
    process.terminate()
    said = process.communicate(timeout=PATIENCE)[1]
    assert process.returncode == 130 and "the same command goes on" in said
    assert not Path(f"/proc/{run}").exists()
    assert "goes on from its snapshot" in sweep(*SLOW)


# What the refusal must say, and the words after the scene.
NONSENSE = [
    ("at least one key", []),
    ("Did you mean 'Grid/Spacing'", ["--vary", "Grid/Spcing=80,40"]),
    ("Use --seeds", ["--vary", "Random seed=1,2"]),
    ("-s sets it", ["--vary", "Output/Formats=csv|vtu"]),
    ("each key in one", [*VARY, "--vary", "Grid/Spacing=20,10"]),
    ("nothing is random", [*VARY, "--seeds", "1-3", "-s", "Proliferation/Law=none"]),
    ("3996 runs", [*VARY, "--seeds", "1-999"]),
    ("Did you mean 'total_volume'", [*VARY, "--columns", "cells,total_volum"]),
    ("what --help shows", [*VARY, "--sedes", "1-2"]),
]
BAD_SAMPLES = [
    ("as many values", "Grid/Spacing\n"),
    ("Did you mean", "Grid/Spcing\n40\n"),
    ("2 values", "Grid/Spacing,Time/Step\n40\n"),
    ("Use --seeds", "Random seed\n4\n"),
]


@pytest.fixture(scope="module")
def asked(runs):
    with requests.asked(request, parser, runs.options.morula) as ask:
        yield ask


@pytest.mark.parametrize("said, words", NONSENSE)
def test_refusals(asked, said, words):
    with pytest.raises(Refused) as refused:
        asked(DISC, *words)
    assert said in str(refused.value)


@pytest.mark.parametrize("said, text", BAD_SAMPLES)
def test_bad_samples(runs, asked, said, text):
    with pytest.raises(Refused) as refused:
        asked(DISC, "--samples", runs.write("samples.csv", text))
    assert said in str(refused.value)


@pytest.mark.release
def test_output_in_the_working_directory(runs):
    """And what the program refuses, before anything is written."""
    command = [ROOT / "contrib/sweep", DISC, "--morula", runs.options.morula,
               *overrides({"Time/End time": 0.1})]
    said = runs.call([*command, "--vary", "Tissue/Cell spacing=10,50", "--vary",
                      "Tissue/Radius=80,20"], 1, cwd=runs.work).stderr
    assert "Tissue/Cell spacing=50" in said and "Tissue/Radius=20" in said
    assert not (runs.work / "output/sweep").exists()
    runs.call([*command, "--seeds", "1,2"], cwd=runs.work)
    assert (runs.work / "output/sweep/disc/table.md").is_file()
