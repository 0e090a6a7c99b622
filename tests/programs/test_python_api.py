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
import sys
import time

import pandas
from morula import Function, Refused, Run, Scene, map
from tests.common.program import TESTS, ProgramTest

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


class PythonApi(ProgramTest):
    def scene(self, source=CUBE, **options):
        return Scene(source, morula=self.options.morula, **options)

    def test_scene(self):
        scene = self.scene()
        self.assertEqual(scene["Grid/Spacing"], "35")
        self.assertEqual(scene["Material/Poisson's ratio"], "0.4")  # a default
        scene["Method"] = "consistent"
        self.assertEqual(scene["Boundary conditions/Nitsche penalty"], "20")
        scene["Grid/Extension"], scene["Grid/Offset"] = True, [1, 2, 3]
        self.assertEqual((scene["Grid/Extension"], scene["Grid/Offset"]),
                         ("true", "1, 2, 3"))
        with self.assertRaisesRegex(Refused, "Did you mean 'Grid/Spacing'"):
            scene["Grid/Spacng"] = 3
        with self.assertRaisesRegex(Refused, "a key that exists"):
            scene["Cell types/stem/Where"] = "X > 0"
        scene["Cell types/Names"] = ["stem", "leaf"]
        scene["Cell types/stem/Where"] = "X > 0"
        self.assertEqual(scene.about(RATE).unit, "1/day")
        said = scene.explain()
        self.assertEqual((said["cells"], said["dimension"]), (125, 3))
        self.assertEqual([kind["name"] for kind in said["types"]],
                         ["stem", "leaf"])
        self.assertEqual(said["keys"]["Grid/Offset"], "1, 2, 3")
        copy = scene.with_keys({"Grid/Spacing": -1})
        with self.assertRaisesRegex(Refused, "Grid/Spacing"):
            copy.explain()
        self.assertEqual(scene["Grid/Spacing"], "35")
        # written and read again it is the same scene
        again = self.scene(scene.save(self.work / "again.prm"))
        self.assertEqual(again.explain()["keys"] | {"Output directory": ""},
                         said["keys"] | {"Output directory": ""})
        self.assertIn("small-cube", repr(scene))
        self.assertIn("Grid/Spacing", scene._repr_html_())

    def test_run(self):
        scene = self.scene().with_keys({"Time/End time": 0.5})
        directory = self.work / "run"
        run = scene.run(directory, progress=False)
        self.execute(CUBE, "-s", "Time/End time=0.5", output=self.work / "own")
        self.assert_same_file(directory / "cells-0001.csv",
                              self.work / "own/cells-0001.csv")
        self.assertTrue(run.finished)
        self.assertEqual(list(run.cells(0.5)["x"]), list(run.cells()["x"]))
        with self.assertRaisesRegex(Refused, "0, 0.5"):
            run.cells(0.3)
        self.assertIn("finished, day 0.5 after 4 steps", repr(run))
        self.assertIn("<table>", run._repr_html_())
        self.assertEqual(run.lineage.clones["alive"].sum(), len(run.cells()))
        written = (directory / "statistics.csv").stat().st_mtime_ns
        scene.run(directory, progress=False)  # is there already
        self.assertEqual((directory / "statistics.csv").stat().st_mtime_ns,
                         written)
        other = scene.with_keys({"Grid/Spacing": 40})
        with self.assertRaisesRegex(Refused, "again=True"):
            other.run(directory, progress=False)
        other.run(directory, progress=False, again=True)
        with self.assertRaisesRegex(Refused, "Spacing"):
            scene.with_keys({"Grid/Spacing": -1}).run(directory)

    def test_tree(self):
        run = self.scene().run(self.work / "run", progress=False)
        lineage = run.lineage
        founder = int(lineage.clone_sizes.argmax())

        def members(cell, tree):
            return {cell}.union(*(members(*item) for item in tree.items()))

        self.assertEqual(members(founder, lineage.tree(founder)),
                         set(lineage.clone(founder)))
        axes = lineage.plot(founder, end=1.0)
        n = len(lineage.clone(founder))
        self.assertEqual(len(axes.lines), n + n // 2)  # and one a division

    def test_interrupted(self):
        """Ctrl-C saves; the same call goes on to the same cells."""
        directory = self.work / "run"
        text = SCRIPT.format(cube=str(CUBE), morula=str(self.options.morula),
                             directory=str(directory))
        whole = self.work / "whole"
        self.scene().with_keys({"Time/Step": 0.03125, "Output/Snapshot interval":
                                0.125}).run(whole, progress=False)
        words = [ROOT / "contrib/python/launch", "-c", text]
        process = subprocess.Popen(words, stdout=subprocess.PIPE, text=True,
                                   stderr=subprocess.PIPE)
        deadline = time.monotonic() + PATIENCE
        table = directory / "statistics.csv"
        while not table.is_file() or table.read_text().count("\n") < 4:
            self.assertIsNone(process.poll())
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.005)
        process.send_signal(signal.SIGINT)
        said = process.communicate(timeout=PATIENCE)[1]
        self.assertNotEqual(process.returncode, 0)
        self.assertIn("the same call goes on", said)
        self.assertFalse(Run(directory).finished)
        self.assertTrue((directory / "snapshot.h5").is_file())
        rows = table.read_text().count("\n")
        self.assertIn("finished, day 1", self.run_words(words).stdout)
        self.assertGreater(table.read_text().count("\n"), rows)
        for name in ("lineage.csv", "cells-0002.csv"):
            self.assert_same_file(directory / name, whole / name)

    def test_function(self):
        scene = self.scene().with_keys({"Time/End time": 0.25})
        keys = {"rate": RATE, "spacing": "Grid/Spacing"}
        f = Function(scene, keys, cells_at_end, directory=self.work / "runs")
        values = f.map([(2, 35), (8, 35), (-1, 35), {"rate": 8, "spacing": 35}],
                       jobs=2)
        direct = {}
        for rate in (2, 8):
            self.execute(CUBE, "-s", "Time/End time=0.25", "-s",
                         f"{RATE}={rate}", output=self.work / "own")
            direct[rate] = cells_at_end(Run(self.work / "own"))
        self.assertEqual(list(values[:2]), [direct[2], direct[8]])
        self.assertTrue(math.isnan(values[2]))
        self.assertEqual(values[3], values[1])
        runs = sorted((self.work / "runs/runs").glob("*/run.json"))
        before = [file.stat().st_mtime_ns for file in runs]
        self.assertEqual(f(rate=2, spacing=35), values[0])
        self.assertEqual(f(2, 35), f([2, 35]))
        self.assertEqual(before, [file.stat().st_mtime_ns for file in runs])
        self.assertEqual(f.run(2, 35).number(RATE), 2)
        with self.assertRaisesRegex(Refused, "rate, spacing"):
            f(2)
        with self.assertRaisesRegex(Refused, "a key that exists"):
            Function(scene, ["Grid/Spacng"], cells_at_end)
        both = Function(scene, lambda share: {RATE: 2 * share},
                        lambda run: run.statistics["cells"].to_numpy()[[0, -1]],
                        directory=self.work / "runs")
        self.assertEqual(list(both(1)), [125, direct[2]])
        self.assertTrue(all(math.isnan(value) for value in both(-1)))

    def test_map(self):
        samples = pandas.DataFrame({"Tissue/Radius": [30, 40, -1],
                                    "Grid/Spacing": [20, 20, 20]})
        scene = self.scene({"Dimension": 2, "Time/End time": 0.1,
                            "Tissue/Cell spacing": 5}, name="disc")
        found = map(scene, samples, lambda run: {
            "cells": run.statistics["cells"].iloc[-1]},
            directory=self.work / "map", progress=False)
        self.assertEqual(list(found), [*samples, "cells"])
        self.assertTrue(math.isnan(found["cells"][2]))
        self.assertGreater(found["cells"][1], found["cells"][0])

    def test_further_runs_start_at_once(self):
        """Forks of one process: from the call to the first row of a run that is
        not the first. (The limit on an idle machine is 0.05 s; others may be at
        work here.)"""
        scene = self.scene().with_keys({"Time/End time": 0.125})
        f = Function(scene, [RATE], lambda run: run.statistics[
            "wall_seconds"].iloc[0], directory=self.work / "runs")
        f.map([1, 2, 3])
        started = min(f(rate) for rate in (4, 5, 6, 7, 8))
        begun = time.monotonic()
        self.run_words([self.options.morula, CUBE, "--explain"],
                       call=plain_call)
        start = time.monotonic() - begun
        self.assertLess(started, 0.5 * start)
        self.assertLess(started, 0.15)

    def test_virtual_environment(self):
        """As doc/python.md says, offline: pip has no index to ask."""
        page = (ROOT / "doc/python.md").read_text()
        text = re.search(r"<!-- run: install -->\n```sh\n(.*?)```", page, re.S)[1]
        shutil.copytree(ROOT / "contrib/python", self.work / "contrib/python",
                        ignore=shutil.ignore_patterns("build", "*.egg-info"))
        environment = {**os.environ, "PIP_NO_INDEX": "1", "PATH":
                       f"{os.path.dirname(self.options.morula)}:/usr/bin:/bin"}
        environment.pop("PYTHONPATH", None)
        subprocess.run(["bash", "-euc", text], cwd=self.work, check=True,
                       env=environment, stdout=subprocess.DEVNULL)
        tools = self.work / "my-environment/bin"
        said = subprocess.run(
            [tools / "python", "-c", "import morula, morula.api.scene as s; "
             "print(morula.__file__); print(morula.Scene({})['Grid/Spacing'])"],
            cwd=self.work, check=True, env=environment, text=True,
            stdout=subprocess.PIPE).stdout.split()
        self.assertTrue(said[0].startswith(str(self.work / "my-environment")))
        self.assertEqual(said[1], "50")
        for tool in ("import", "sweep"):
            subprocess.run([tools / f"morula-{tool}", "--help"], check=True,
                           cwd=self.work, env=environment,
                           stdout=subprocess.DEVNULL)


def plain_call(words, cwd=None):
    """Without the forks of the tests."""
    from morula.execute import call
    return call(words, cwd=cwd)
