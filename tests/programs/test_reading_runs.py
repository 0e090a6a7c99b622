# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""morula.run: a run read from CSV, from VTU and on two ranks is the same,
and its lineage is what the file says, row by row."""
import csv
import os
import re
import subprocess
from pathlib import Path

import matplotlib.image
import numpy as np
from morula.refusal import Refused
from morula.run import NoStates, Run
from tests.common.program import SCENES, ProgramTest

ROOT = Path(__file__).resolve().parents[2]

SCENE = SCENES.parent / "programs/small-cube.prm"


def rows_of(file):
    """Without NumPy: a dictionary a row."""
    with open(file, encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


class ReadingRuns(ProgramTest):
    def run_with(self, formats, name="output", ranks=1):
        output = self.work / name
        self.execute(SCENE, "-s", f"Output/Formats={formats}", output=output,
                     ranks=ranks)
        return Run(output)

    def test_tables(self):
        run = self.run_with("csv")
        written = rows_of(run.directory / "statistics.csv")
        self.assertEqual(list(run.statistics), list(written[0]))
        self.assertEqual(len(run.statistics), len(written))
        for i, row in enumerate(written):
            for name, text in row.items():
                self.assertEqual(run.statistics[name][i], float(text))
        files = sorted(run.directory.glob("cells-*.csv"))
        self.assertEqual(len(run.times), len(files))
        for kind in ("cells", "surface"):
            for i, file in enumerate(sorted(
                    run.directory.glob(f"{kind}-*.csv"))):
                columns = getattr(run, kind)(i)
                written = rows_of(file)
                self.assertEqual(len(columns["id"]), len(written))
                self.assertTrue((np.diff(columns["id"]) > 0).all())
                for name in written[0]:
                    np.testing.assert_array_equal(
                        columns[name], [float(r[name]) for r in written])
                self.assertEqual(run.times[i], columns["time"][0])
        np.testing.assert_array_equal(run.cells(-1)["id"],
                                      run.cells(len(files) - 1)["id"])
        self.assertEqual(run.number("Tissue/Cell spacing"),
                         float(run.keys["Tissue/Cell spacing"]))
        shares = run.timings["share"]
        self.assertLess(shares.drop("total").sum(), 1)
        self.assertAlmostEqual(shares["total"], 1, 9)
        self.assertGreater(run.timings.loc["tangent", "calls"], 0)

    def test_formats_and_ranks(self):
        """CSV and VTU of one run, VTU of two ranks: the same cells in the
        same order; VTU in single precision, and with stresses besides."""
        both = self.run_with("csv, vtu")
        parallel = self.run_with("vtu", "parallel", ranks=2)
        for i, time in enumerate(both.times):
            self.assertEqual(parallel.times[i], time)
            written = rows_of(sorted(both.directory.glob("cells-*.csv"))[i])
            for run in (both, parallel):
                cells = run.cells(i)
                for name in written[0]:
                    exact = np.array([float(row[name]) for row in written])
                    scale = 1 + np.abs(exact).max()
                    np.testing.assert_allclose(cells[name], exact,
                                               atol=2e-6 * scale)
                trace = sum(cells[f"sigma_{a}{a}"] for a in "xyz")
                np.testing.assert_allclose(cells["pressure"], -trace / 3,
                                           atol=1e-6)

    def test_lineage(self):
        """Against the file walked row by row."""
        run = self.run_with("csv")
        lineage = run.lineage
        written = rows_of(run.directory / "lineage.csv")
        parent = {int(r["id"]): int(r["parent"]) for r in written}
        self.assertEqual(lineage.founders, sum(p < 0 for p in parent.values()))

        def path(cell):
            return ([] if parent[cell] < 0 else path(parent[cell])) + [cell]

        mothers = set(parent.values()) - {-1}
        self.assertGreater(len(mothers), 20)
        for cell in parent:
            self.assertEqual(lineage.ancestors(cell), path(cell))
            self.assertEqual(lineage.founder[cell], path(cell)[0])
        deep = max(parent, key=lambda cell: len(path(cell)))
        for cell in (0, deep, path(deep)[0], path(deep)[1]):
            expected = [c for c in parent if cell in path(c)]
            self.assertEqual(list(run.clone(cell)), sorted(expected))
        self.assertEqual(set(lineage.living), set(parent) - mothers)
        # the living are the cells of the last state
        np.testing.assert_array_equal(lineage.living, run.cells(-1)["id"])
        self.assertEqual(lineage.clone_sizes.sum(),
                         run.statistics["cells"].iloc[-1])
        for row in written:
            if int(row["parent"]) >= 0:
                self.assertEqual(lineage.end_time[int(row["parent"])],
                                 float(row["birth_time"]))

    def test_types(self):
        """Names from the scene; events.csv and lineage.csv together say the
        type of every cell, in every state and in statistics.csv."""
        output = self.work / "types"
        self.execute(SCENES / "cell-types.prm", "-s", "Time/End time=1.5",
                     "-s", "Output/Interval=0.5", "-s",
                     "Output/Formats=csv", output=output)
        run = Run(output)
        self.assertEqual(run.type_names, ("transit", "stem", "resting"))
        written = rows_of(output / "events.csv")
        self.assertGreater(len(written), 20)
        self.assertEqual(run.events.columns.tolist(), list(written[0]))
        for name in ("event", "from", "to"):
            self.assertEqual(run.events[name].tolist(),
                             [row[name] for row in written])
        self.assertEqual(run.events["time"].tolist(),
                         [float(row["time"]) for row in written])
        histories = {cell: run.types_of(cell)
                     for cell in range(len(run.lineage))}
        self.assertEqual(sum(map(len, histories.values())),
                         len(histories) + len(written))

        def type_at(cell, time):
            return [name for since, name in histories[cell]
                    if since <= time][-1]

        for i, time in enumerate(run.times):
            cells = run.cells(i)
            self.assertEqual(cells["type"].dtype.kind, "i")
            self.assertEqual([type_at(cell, time) for cell in cells["id"]],
                             [run.type_names[t] for t in cells["type"]])
        last = run.statistics.iloc[-1]
        for name in run.type_names:
            self.assertEqual(last[f"cells_{name}"], sum(
                type_at(cell, last["time"]) == name
                for cell in run.lineage.living))
        with self.assertRaisesRegex(Refused, "an id from 0 to"):
            run.types_of(len(run.lineage))
        whole = (output / "events.csv").read_text()
        for damaged, words in (
                (whole.replace(",from,", ",of,", 1), "time, id, event, from"),
                (whole + "1.5,x,transition,stem,transit\n", "the columns"),
                (whole + "1.5,0,transition,stem,root\n", "It has 'root'")):
            (output / "events.csv").write_text(damaged)
            with self.assertRaisesRegex(Refused, words):
                Run(output).events

    def test_without_types(self):
        run = self.run_with("csv")
        self.assertEqual(run.type_names, ())
        self.assertEqual(len(run.events), 0)
        self.assertIsNone(run.lineage.type)
        self.assertEqual(run.types_of(3), [])

    def test_documented_example(self):
        """The code of doc/looking-at-results.md, on this run."""
        run = self.run_with("vtu", "output/demo")
        text = (ROOT / "doc/looking-at-results.md").read_text()
        code = re.search(r"<!-- example: clone -->\n```python\n(.*?)```", text,
                         re.DOTALL)[1]
        (self.work / "example.py").write_text(code)
        said = subprocess.run(
            [ROOT / "contrib/python/launch", "example.py"], cwd=self.work,
            text=True,
            env={**os.environ, "MPLBACKEND": "Agg"}, check=True,
            stdout=subprocess.PIPE).stdout
        founder, cells, alive = map(int, re.findall(r"\d+", said))
        self.assertEqual(cells, len(run.clone(founder)))
        self.assertEqual(alive, max(run.lineage.clone_sizes))
        picture = matplotlib.image.imread(self.work / "clone.png")
        self.assertGreater(picture[:, :, :3].std(), 0.03)

    def test_refusals(self):
        with self.assertRaisesRegex(Refused, "no parameters.prm"):
            Run(self.work)
        run = self.run_with("none")
        self.assertEqual(len(run.times), 0)
        with self.assertRaisesRegex(NoStates, "Formats = none"):
            run.cells(0)
        for cell in (-1, len(run.lineage)):
            with self.assertRaisesRegex(Refused, "an id from 0 to"):
                run.clone(cell)
        run = self.run_with("csv")
        with self.assertRaisesRegex(NoStates, "no state 99"):
            run.cells(99)

    def test_vectors(self):
        """Of VTU files, as components."""
        cells = self.run_with("csv, vtu").cells(-1)
        for axis in "xyz":
            np.testing.assert_allclose(
                cells[f"displacement_{axis}"],
                cells[axis] - cells[axis.upper()], atol=1e-4)
        self.assertTrue({"sigma_xx", "sigma_zx"} <= set(cells))
        self.assertEqual(cells["id"].dtype.kind, "i")

    def test_damaged(self):
        """A row that is too short, and text, are no missing numbers."""
        run = self.run_with("csv")
        file = run.directory / "statistics.csv"
        whole = file.read_text().splitlines()
        for row in (whole[-1].rpartition(",")[0],
                    whole[-1].replace(",", ",x", 1)):
            file.write_text("\n".join([*whole[:-1], row, ""]))
            with self.assertRaisesRegex(Refused, "lines of as many numbers"):
                Run(run.directory).statistics["time"]

