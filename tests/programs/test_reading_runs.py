# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""morula.run: a run read from CSV, from VTU and on two ranks is the same, and its
lineage is what the file says, row by row."""
import csv
import os
import re
import shutil
import subprocess

import matplotlib.image
import numpy as np
import pytest
from morula.refusal import Refused
from morula.run import NoStates, Run
from tests.common.program import SCENES, TESTS

ROOT = TESTS.parent
SCENE = TESTS / "programs/small-cube.prm"


def rows_of(file):
    """Without NumPy: a dictionary a row."""
    with open(file, encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


@pytest.fixture(scope="module")
def run(runs):
    """With both kinds of files; read() reads its CSV files alone."""
    return runs.run("both", SCENE, {"Output/Formats": "csv, vtu"})


@pytest.fixture
def read(run, tmp_path):
    for file in [*run.directory.glob("*.csv"), run.directory / "parameters.prm"]:
        shutil.copy(file, tmp_path)
    return Run(tmp_path)


@pytest.fixture(scope="module")
def typed(runs):
    return runs.run("types", SCENES / "cell-types.prm", {
        "Time/End time": 1.5, "Output/Interval": 0.5, "Output/Formats": "csv"})


def test_tables(run, read):
    written = rows_of(read.directory / "statistics.csv")
    assert list(read.statistics) == list(written[0])
    for name in read.statistics:
        assert list(read.statistics[name]) == [float(row[name]) for row in written]
    for kind in ("cells", "surface"):
        files = sorted(read.directory.glob(f"{kind}-*.csv"))
        assert len(read.times) == len(files) == 3
        for i, file in enumerate(files):
            columns, written = getattr(read, kind)(i), rows_of(file)
            assert (np.diff(columns["id"]) > 0).all()
            for name in written[0]:
                assert list(columns[name]) == [float(row[name]) for row in written]
            assert read.times[i] == columns["time"][0]
    assert list(read.cells(-1)["id"]) == list(read.cells(2)["id"])
    assert list(read.at("cells", 0.5)["x"]) == list(read.cells(1)["x"])
    assert read.number("Tissue/Cell spacing") == 12
    shares = run.timings["share"]
    assert shares.drop("total").sum() < 1
    assert shares["total"] == pytest.approx(1, abs=1e-9)
    assert run.timings.loc["tangent", "calls"] > 0


def test_formats_and_ranks(runs, run, read):
    """CSV and VTU of one run, VTU of two ranks: the same cells in the same order;
    VTU in single precision, with stresses and vectors besides."""
    parallel = runs.run("parallel", SCENE, {"Output/Formats": "vtu"}, ranks=2)
    for i, time in enumerate(read.times):
        exact = read.cells(i)
        for other in (run, parallel):
            assert other.times[i] == time
            cells = other.cells(i)
            assert cells["id"].dtype.kind == "i"
            for name in exact:
                np.testing.assert_allclose(
                    cells[name], exact[name], atol=2e-6 * (1 + exact[name].abs().max()))
            trace = sum(cells[f"sigma_{a}{a}"] for a in "xyz")
            np.testing.assert_allclose(cells["pressure"], -trace / 3, atol=1e-6)
            for axis in "xyz":
                np.testing.assert_allclose(cells[f"displacement_{axis}"],
                                           cells[axis] - cells[axis.upper()], atol=1e-4)


def test_lineage(run):
    """Against the file walked row by row."""
    lineage = run.lineage
    written = rows_of(run.directory / "lineage.csv")
    parent = {int(row["id"]): int(row["parent"]) for row in written}
    assert lineage.founders == sum(mother < 0 for mother in parent.values())

    def path(cell):
        return ([] if parent[cell] < 0 else path(parent[cell])) + [cell]

    mothers = set(parent.values()) - {-1}
    assert len(mothers) > 20
    for cell in parent:
        assert lineage.ancestors(cell) == path(cell)
        assert lineage.founder[cell] == path(cell)[0]
    deep = max(parent, key=lambda cell: len(path(cell)))
    for cell in (0, deep, path(deep)[0], path(deep)[1]):
        assert list(run.clone(cell)) == sorted(c for c in parent if cell in path(c))
    assert set(lineage.living) == set(parent) - mothers
    # the living are the cells of the last state
    assert list(lineage.living) == list(run.cells(-1)["id"])
    assert lineage.clone_sizes.sum() == run.statistics["cells"].iloc[-1]
    for row in written:
        if int(row["parent"]) >= 0:
            assert lineage.end_time[int(row["parent"])] == float(row["birth_time"])


def test_types(typed):
    """Names from the scene; events.csv and lineage.csv together say the type of
    every cell, in every state and in statistics.csv."""
    assert typed.type_names == ("transit", "stem", "resting")
    written = rows_of(typed.directory / "events.csv")
    assert len(written) > 20
    assert list(typed.events) == list(written[0])
    for name in ("event", "from", "to"):
        assert list(typed.events[name]) == [row[name] for row in written]
    assert list(typed.events["time"]) == [float(row["time"]) for row in written]
    histories = {cell: typed.types_of(cell) for cell in range(len(typed.lineage))}
    assert sum(map(len, histories.values())) == len(histories) + len(written)

    def type_at(cell, time):
        return [name for since, name in histories[cell] if since <= time][-1]

    for i, time in enumerate(typed.times):
        cells = typed.cells(i)
        assert cells["type"].dtype.kind == "i"
        assert [type_at(cell, time) for cell in cells["id"]] == [
            typed.type_names[number] for number in cells["type"]]
    last = typed.statistics.iloc[-1]
    for name in typed.type_names:
        assert last[f"cells_{name}"] == sum(type_at(cell, last["time"]) == name
                                            for cell in typed.lineage.living)


def test_damaged_events(typed, tmp_path):
    for name in ("statistics.csv", "parameters.prm", "lineage.csv"):
        shutil.copy(typed.directory / name, tmp_path)
    whole = (typed.directory / "events.csv").read_text()
    for damaged, said in (
            (whole.replace(",from,", ",of,", 1), "time, id, event, from"),
            (whole + "1.5,x,transition,stem,transit\n", "the columns"),
            (whole + "1.5,0,transition,stem,root\n", "It has 'root'")):
        (tmp_path / "events.csv").write_text(damaged)
        with pytest.raises(Refused, match=said):
            Run(tmp_path).events


def test_without_types(run):
    assert run.type_names == () and len(run.events) == 0
    assert run.lineage.type is None and run.types_of(3) == []


def test_documented_example(run, tmp_path):
    """The code of doc/looking-at-results.md, on this run."""
    text = (ROOT / "doc/looking-at-results.md").read_text()
    code = re.search(r"<!-- example: clone -->\n```python\n(.*?)```", text, re.S)[1]
    (tmp_path / "output").mkdir()
    (tmp_path / "output/demo").symlink_to(run.directory)
    said = subprocess.run(
        [ROOT / "contrib/python/launch", "-c", code], cwd=tmp_path, text=True,
        env={**os.environ, "MPLBACKEND": "Agg"}, check=True,
        stdout=subprocess.PIPE).stdout
    founder, cells, alive = map(int, re.findall(r"\d+", said))
    assert cells == len(run.clone(founder))
    assert alive == max(run.lineage.clone_sizes)
    assert matplotlib.image.imread(tmp_path / "clone.png")[:, :, :3].std() > 0.03


def test_what_is_not_there(run, read, tmp_path):
    with pytest.raises(NoStates, match="no state 99"):
        read.cells(99)
    for cell in (-1, len(run.lineage)):
        with pytest.raises(Refused, match="an id from 0 to"):
            run.clone(cell)
        with pytest.raises(Refused, match="an id from 0 to"):
            run.lineage.ancestors(cell)
    with pytest.raises(Refused, match="0, 0.5, 1"):
        read.at("surface", 0.3)
    for file in tmp_path.glob("cells-*"):
        file.unlink()
    assert len(Run(tmp_path).times) == 0
    with pytest.raises(NoStates, match="Formats = none"):
        Run(tmp_path).cells(0)
    (tmp_path / "parameters.prm").unlink()
    with pytest.raises(Refused, match="no parameters.prm"):
        Run(tmp_path)


def test_damaged(read):
    """A row that is too short, and text, are no missing numbers."""
    file = read.directory / "statistics.csv"
    whole = file.read_text().splitlines()
    for row in (whole[-1].rpartition(",")[0], whole[-1].replace(",", ",x", 1)):
        file.write_text("\n".join([*whole[:-1], row, ""]))
        with pytest.raises(Refused, match="lines of as many numbers"):
            Run(read.directory).statistics
