# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""contrib/report without a browser: its numbers and cells are those of the run's
files, what it refuses, what it leaves out; a run's texts stay texts."""
import base64
import json
import re
import zlib
from html import unescape
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from morula.draw.colours import OF_TYPES, colours_of, limits_of
from morula.draw.points import radii_of
from morula.report.cells import PERCENTILES, choose, quantised
from morula.report.curves import fit_growth
from morula.run import Run
from PIL import Image
from tests.common.program import SCENES

REPORT = Path(__file__).resolve().parents[2] / "contrib/report"
CUBE = SCENES.parent / "programs/small-cube.prm"


def test_quantised():
    values = np.linspace(-3, 5, 1000)
    steps = quantised(values, -3, 5, np.uint8)
    assert np.abs(-3 + 8 * (steps / 255) - values).max() < 4.001 / 255
    assert list(quantised([-9, 9], -3, 5, np.uint8)) == [0, 255]
    assert list(quantised([4, 4], 4, 4, np.uint8)) == [0, 0]


@pytest.mark.parametrize("wanted, limit, states, stride", [
    (None, 1e6, [*range(11)], 1), (None, 35000, [0, 5, 10], 1),
    (2, 1e6, [0, 10], 1), (None, 10000, [10], 1), (None, 3000, [10], 4)])
def test_choice(wanted, limit, states, stride):
    found = choose(np.arange(11) * 0.5, [1000] * 11, 10.0, wanted, limit)
    assert (found.states, found.stride) == (states, stride)
    assert len(found.words) == (len(states) < 11) + (stride > 1)


def test_fits():
    time = np.linspace(0, 5, 101)
    found = fit_growth(time, 7 * np.exp(0.36 * time))
    assert found.rate == pytest.approx(0.36, abs=1e-12)
    assert found.factor == pytest.approx(7, abs=1e-12)
    assert (found.low, found.high, found.rows) == (2, 4, 41)
    assert found.r2 == pytest.approx(1, abs=1e-12)
    assert found.exponential
    straight = fit_growth(time, 1 + time)
    assert not straight.exponential
    assert straight.r2_line == pytest.approx(1, abs=1e-12)
    assert fit_growth(time, np.ones(101)) is None
    assert fit_growth(time[:4], time[:4] + 1) is None
    # a shorter run: its second half
    short = fit_growth(time[:41], np.exp(time[:41]))
    assert (short.low, short.high, short.rows) == (1, 2, 21)


class Page(HTMLParser):
    """What a page of contrib/report says: the values by their names, the rows of
    all tables, the elements, and what JavaScript gets."""

    def __init__(self, file):
        super().__init__()
        self.text = file.read_text()
        self.values = {name: unescape(value) for name, value in re.findall(
            "<dt>(.*?)</dt><dd>(.*?)</dd>", self.text)}
        self.elements, self.rows, self.scripts = [("", {})], [], {}
        self.feed(self.text)
        self.about = json.loads(self.scripts.get("about", "null"))

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        if tag == "tr":
            self.rows.append([])

    def handle_data(self, data):
        tag, attributes = self.elements[-1]
        if tag == "td" and data.strip():
            self.rows[-1].append(data)
        if tag == "script" and "id" in attributes:
            self.scripts.setdefault(attributes["id"], data)

    def cells(self, i):
        """Positions and radii (n, 4), µm, of state i, and by field its bytes."""
        content = zlib.decompress(base64.b64decode(self.scripts[f"cells-{i}"]))
        n = self.about["states"][i]["shown"]
        places = np.frombuffer(content, np.uint16, 4 * n).reshape(n, 4)
        fields = np.frombuffer(content, np.uint8, offset=8 * n).reshape(-1, n)
        return (self.about["low"] + np.array(self.about["size"]) * (places / 65535),
                {field["name"]: values for field, values
                 in zip(self.about["fields"], fields, strict=True)})


def report(runs, run, *words, code=0):
    return runs.call([REPORT, run.directory, "--morula", runs.options.morula, *words], code)


def page_of(runs, run, *words):
    report(runs, run, *words)
    return Page(run.directory / "report.html")


@pytest.fixture(scope="module")
def cube(runs):
    return runs.run("cube", CUBE, {
        "Time/End time": 2, "Time/Step": 0.25, "Output/Formats": "vtu",
        "Proliferation/Cell cycle/Start": "together"})


@pytest.fixture(scope="module")
def page(runs, cube):
    return page_of(runs, cube, "--no-pictures")


def test_numbers(cube, page):
    rows, lineage = cube.statistics, cube.lineage
    assert len(lineage) > lineage.founders
    sizes = np.bincount(lineage.founder[cube.cells(-1)["id"]])
    for name, value in {
            "steps": len(rows) - 1, "cells at first": rows["cells"][0],
            "cells at last": rows["cells"].iloc[-1], "to day": 2,
            "volume at last, µm³": rows["total_volume"].iloc[-1],
            "founders": rows["cells"][0], "cells that ever lived": len(lineage),
            "divisions": rows["dividing"].sum(),
            "cells living at the end": rows["cells"].iloc[-1],
            "founders that never divided": (sizes == 1).sum(),
            "mean cells of a clone": rows["cells"].iloc[-1] / rows["cells"][0],
            "latest generation": cube.cells(-1)["generation"].max(),
            "Newton iterations": rows["newton_iterations"].sum(),
            "linear iterations": rows["linear_iterations"].sum(),
            "unknowns, most": rows["unknowns"].max(),
            "largest residual at a step's end, relative to its first":
            rows["residual"].max(),
            "rejected steps": 0}.items():
        shown = float(page.values[name.replace("'", "&#39;")].replace(",", ""))
        assert shown == pytest.approx(value, rel=1e-3), name
    assert page.values["cells to a grid cell&#39;s edge, first"] == f"{35 / 12:.3g}"
    assert page.values["largest clone"] == (
        f"{sizes.max()} cells, of founder {sizes.argmax()}")


def test_tables(cube, page):
    """Time by section, the keys that differ, and the effects."""
    assert ["Tissue/Cell spacing", "12", "10"] in page.rows
    names = [row[0] for row in page.rows if len(row) == 2]
    assert "proliferation" in names and "growth" not in names
    shown = {row[0]: row[1:] for row in page.rows if row and row[-1].endswith(" %")}
    for section, (calls, seconds, share) in cube.timings.iterrows():
        assert int(shown[section][0].replace(",", "")) == calls
        assert float(shown[section][1]) == pytest.approx(seconds, abs=0.006)
        assert float(shown[section][2].strip(" %")) == pytest.approx(100 * share, abs=0.06)


def test_packed_cells(cube, page):
    """Every state is that of the files."""
    assert [state["time"] for state in page.about["states"]] == [*cube.times]
    whole = [cube.cells(i) for i in range(len(cube.times))]
    for i, cells in enumerate(whole):
        assert page.about["states"][i]["cells"] == len(cells)
        places, fields = page.cells(i)
        step = np.array(page.about["size"]) / 65535 + 1e-4
        assert (np.abs(places[:, :3] - cells[["x", "y", "z"]]) < step[:3]).all(axis=None)
        assert (np.abs(places[:, 3] - radii_of(cells["volume"])) < step[3]).all()
        for name in ("energy_density", "volume", "pressure"):
            values = np.concatenate([state[name] for state in whole])
            low, high = limits_of(name, values, PERCENTILES)
            found = low + (high - low) * fields[name] / 255
            assert np.abs(found - np.clip(cells[name], low, high)).max() < (
                0.51 * (high - low) / 255 + 1e-6)


def test_shades(cube, page):
    """A cell's byte leads to the colour that contrib/render gives its value."""
    _, fields = page.cells(len(cube.times) - 1)
    cells = cube.cells(-1)
    for field in page.about["fields"]:
        name, shades = field["name"], np.reshape(field["shades"], (256, 3))
        values = np.concatenate([cube.cells(i)[name] for i in range(len(cube.times))])
        expected = colours_of(name, values, limits_of(name, values, PERCENTILES)).of(cells[name])
        off = np.abs(shades[fields[name]].astype(int) - expected).max()
        assert off <= (0 if name in ("phase", "generation") else 4), name


def test_types(runs):
    """Two dimensions, three types: discs in the colours of the types."""
    run = runs.run("types", SCENES / "cell-types.prm", {"Time/End time": 1.5})
    page = page_of(runs, run, "--no-pictures")
    assert page.about["flat"]
    places, fields = page.cells(-1 % len(run.times))
    cells = run.cells(-1)
    np.testing.assert_allclose(places[:, 3], np.sqrt(cells["volume"] / np.pi), rtol=1e-3)
    assert page.about["fields"][0]["name"] == "type"
    shades = np.reshape(page.about["fields"][0]["shades"], (256, 3))[fields["type"]]
    expected = np.array([np.round(255 * np.array(to_rgb(OF_TYPES[t]))) for t in cells["type"]])
    assert {*cells["type"]} == {0, 1, 2}
    np.testing.assert_array_equal(shades, expected)


def test_choices(runs, cube):
    """Fewer fields and states; no address of the network anywhere."""
    page = page_of(runs, cube, "--no-pictures", "--states", "2", "--fields", "sigma_xx,phase")
    assert [field["name"] for field in page.about["fields"]] == ["sigma_xx", "phase"]
    assert [state["time"] for state in page.about["states"]] == [0, 2]
    for _, attributes in page.elements:
        for name in ("src", "href"):
            assert re.match("data:|#", attributes.get(name) or "#")
    policy = next(a["content"] for tag, a in page.elements if "http-equiv" in a)
    assert re.fullmatch(r"default-src 'none'; script-src( ?'sha256-[^']{44}'){4}; "
                        "style-src 'unsafe-inline'; img-src data:", policy)


@pytest.mark.release
def test_limit(runs, cube):
    """A page that may hold next to nothing shows some cells of the last state."""
    page = page_of(runs, cube, "--no-pictures", "--limit", "0.0005")
    state, = page.about["states"]
    assert state["time"] == 2
    assert len(page.cells(0)[0]) == state["shown"] < state["cells"]


@pytest.mark.release
def test_pictures(runs, cube):
    """Without the view: the run's own PNG or, without any, one that is drawn."""
    page = page_of(runs, cube, "--states", "0")
    assert page.about is None
    assert "drawn by morula render" in page.text
    Image.new("RGB", (3000, 10), "red").save(cube.directory / "mine.png")
    page = page_of(runs, cube, "--states", "0")
    assert "mine.png" in page.text
    assert "drawn by morula render" not in page.text


@pytest.mark.parametrize("words, texts", [
    (("--states", "-1"), ("--states = '-1'", ">= 0")),
    (("--limit", "0"), ("--limit", "> 0")),
    (("--fields", "volume,speed"), ("speed", "energy_density")),
    (("--output", "/nowhere/x.html"), ("/nowhere", "exists")),
    (("--morula", "/nowhere/m"), ("--morula", "executable"))])
def test_refusals(runs, cube, words, texts):
    said = report(runs, cube, *words, code=1).stderr
    assert all(text in said for text in texts)


@pytest.fixture
def damaged(runs):
    return runs.run("damaged", CUBE, {"Output/Formats": "vtu", "Output/Interval": 0.5,
                                      "Time/End time": 1}, "--replace")


@pytest.mark.parametrize("damages", [
    [("cells-0002.vtu", "<VTKFile")],
    pytest.param([("cells-0001.vtu", None), ("lineage.csv", "id,parent\n0,-1\n1"),
                  ("statistics.csv", "step,time\n")], marks=pytest.mark.release)])
def test_damaged(runs, damaged, damages):
    """A message, exit code 1 and the old page."""
    run = damaged
    page = page_of(runs, run, "--no-pictures", "--states", "1").text
    for name, content in damages:
        file = run.directory / name
        whole = file.read_bytes()
        file.unlink()
        if content is not None:
            file.write_text(content)
        said = report(runs, run, "--no-pictures", code=1).stderr
        assert "report: " in said and "Traceback" not in said
        assert (run.directory / "report.html").read_text() == page
        file.write_bytes(whole)


@pytest.mark.release
def test_stopped(runs, damaged):
    """A run that has stopped has a page without what it lacks, and so has one
    without cells."""
    run = damaged
    for name in ("lineage.csv", "timings.csv", "log.txt"):
        (run.directory / name).unlink()
    assert "There is no lineage.csv" in page_of(runs, run, "--no-pictures").text
    none = runs.run("none", CUBE, {"Output/Formats": "none"})
    assert page_of(runs, none).values["cells at last"] == page_of(
        runs, run, "--no-pictures").values["cells at last"]


# Each would run if it became an element. The second ends elements of the page,
# and begins a comment that would hide all that follows.
IMAGE = "<img src=data:x onerror=taken()>"
ENDS = f"</script></pre></td><!--<script>taken() {IMAGE}"
COLUMN = f"v\"><!--<script>{IMAGE}"
TYPE = f"$\\x {ENDS}"  # a name of a type, and no formula either


def hostile_run(runs):
    """A run of somebody who wants to run scripts by its texts."""
    plain = runs.run("plain", CUBE, {"Time/End time": 0.5, "Output/Formats": "csv"})
    output = runs.work / f"a<!--<script>b{IMAGE}\"'&amp;"
    plain.directory.rename(output)
    for pattern, added in {"cells-*.csv": {"type": 1}, "lineage.csv": {"type": 1},
                           "statistics.csv": {f"cells_{TYPE}": 7, "cells_b": 8}}.items():
        for file in output.glob(pattern):
            head, *rows = file.read_text().replace("sigma_yz", COLUMN, 1).splitlines()
            values = "".join(f",{value}" for value in added.values())
            file.write_text("\n".join([",".join([head, *added]),
                                       *(row + values for row in rows), ""]))
    (output / "events.csv").write_text(
        f"time,id,event,from,to\n0.2,0,transition,b,{TYPE}\n")
    for name, text in {"log.txt": ENDS, "timings.csv": f"{ENDS},1,0.5,0.5",
                       "parameters.prm": f"subsection Cell types\n  set Names = {TYPE}, b\nend"
                       f"\nset Dimension{IMAGE[:4]}> = {ENDS}"}.items():
        with open(output / name, "a", encoding="utf-8") as stream:
            stream.write(f"{text}\n")
    Image.new("RGB", (30, 10), "red").save(output / f"{COLUMN}.png")
    return Run(output)


def test_hostile_texts(runs):
    """All of them are on the page, and none of them became an element."""
    run = hostile_run(runs)
    page = page_of(runs, run, "--fields", f"volume,{COLUMN},type")
    assert [field["name"] for field in page.about["fields"]] == ["volume", COLUMN, "type"]
    assert not any("onerror" in attributes for _, attributes in page.elements)
    assert sum(tag == "script" and not attributes for tag, attributes in page.elements) == 4
    everything = unescape(page.text)
    for text in (run.name, ENDS, f"Dimension{IMAGE[:4]}>", f"{COLUMN}.png", TYPE):
        assert text in everything
    for text in (IMAGE, ENDS):
        assert text not in page.text
