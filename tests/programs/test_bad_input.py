# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Bad input: exit code 1, key (or option, or file), value, limit and remedy on
stderr, nothing on stdout, and no output directory. The kinds are listed in
tests/common/refusals/, those of a resumed run in resume_refusals.py.
"""
import re
import resource
from pathlib import Path

from morula import execute
from morula.keys import keys_of
from tests.common.program import ProgramTest, overrides

from tests.common import refusals
from tests.common.refusals.refusal import CYCLE

ROOT = Path(__file__).resolve().parents[2]

SCENE = ROOT / "tests/programs/small-cube.prm"


class BadInput(ProgramTest):
    def assert_refused(self, result, texts):
        self.assertEqual(result.stdout, "")
        self.assertRegex(result.stderr, r"(?ms)^morula: .+ = '.*': allowed is ")
        for text in texts:
            self.assertIn(text, result.stderr)
        self.assertNotIn("exception", result.stderr.lower())
        self.assertNotIn(".cc", result.stderr)
        self.assertFalse((self.work / "output").exists(), "directory touched")

    def prepared(self, refusal):
        """(overrides, what must be said) with the files written."""
        for name, content in refusal.files.items():
            data = content if isinstance(content, bytes) else content.encode()
            (self.work / name).write_bytes(data)

        def filled(text):
            return text.replace("{files}", str(self.work))
        return ({key: filled(value) for key, value in refusal.keys.items()},
                [filled(text) for text in (refusal.key + " = ", refusal.value,
                                           refusal.limit, refusal.remedy)])

    def test_table(self):
        """At least sixty kinds, none twice."""
        names = [refusal.name for refusal in refusals.KEYS]
        self.assertGreaterEqual(len(names), 60)
        self.assertEqual(len(names), len(set(names)))

    def test_keys(self):
        units = {key.path: key.unit for key in keys_of(self.options.morula)}
        for refusal in refusals.KEYS:
            with self.subTest(refusal.name):
                keys, texts = self.prepared(refusal)
                result = self.execute(SCENE, *overrides(keys), code=1)
                self.assert_refused(result, texts)
                unit = units.get(refusal.key)
                if unit and refusal in refusals.NUMBERS:
                    self.assertRegex(result.stderr,
                                     rf"\b{re.escape(unit)}s?(\W|$)")

    def test_outliers(self):
        """Refused at once, by --explain too: nothing is made as large as they
        are. The time of a start on a busy machine, and 1 GB for libraries."""
        for refusal in refusals.OUTLIERS:
            with self.subTest(refusal.name):
                keys, texts = self.prepared(refusal)
                words = self.command(
                    SCENE, "--explain", "-s",
                    f"Output directory={self.work / 'output'}",
                    *overrides(keys))
                before = resource.getrusage(resource.RUSAGE_CHILDREN)
                result = self.run_words(words, 1, call=execute.call)
                after = resource.getrusage(resource.RUSAGE_CHILDREN)
                self.assert_refused(result, texts)
                self.assertLess(len(result.stderr), 1500)
                self.assertLess(after.ru_utime - before.ru_utime, 5)
                self.assertLess(after.ru_maxrss, 1e6)  # KB, the largest so far

    def test_on_several_ranks(self):
        """One message, and no rank left waiting."""
        for refusal in refusals.KEYS:
            if refusal.name not in ("grid spacing", "missing mesh",
                                    "stiffness negative somewhere",
                                    "a cell at 1e6,0,0", "a vertex at 1e6",
                                    "a cell across the diagonal"):
                continue
            with self.subTest(refusal.name):
                keys, texts = self.prepared(refusal)
                result = self.execute(SCENE, *overrides(keys), ranks=3, code=1)
                self.assert_refused(result, texts)
                self.assertEqual(result.stderr.count("morula: "), 1)

    def test_places(self):
        """Values that are refused after the file has been read: file and line,
        or -s."""
        text = SCENE.read_text()
        for name, value, key in (
                ("set End time = 1", "set End time = -1", "Time/End time"),
                ("set Spacing = 35", "set Spacing = -35", "Grid/Spacing"),
                ("set G0 exit rate = 2", "set G0 exit rate = 2 - X",
                 CYCLE + "G0 exit rate"),
                ("set Slip where  = Z <= 0", "set Slip where = Z < -9",
                 "Boundary conditions/Slip where")):
            with self.subTest(key):
                scene = self.write("scene.prm", text.replace(name, value))
                number = 1 + text[:text.index(name)].count("\n")
                for arguments in ((), ("--explain",)):
                    result = self.execute(scene, *arguments, code=1)
                    self.assertIn(f"morula: {scene}:{number}: {key} = ",
                                  result.stderr)
        result = self.execute(SCENE, *overrides({"Time/End time": "-1"}),
                              code=1)
        self.assertIn("morula: -s: Time/End time = ", result.stderr)

    def test_explain_refuses_alike(self):
        result = self.execute(
            SCENE, "--explain", *overrides({"Material/Poisson's ratio": "0.5"}),
            code=1)
        self.assert_refused(result, ["Material/Poisson's ratio", "'0.5'",
                                     "< 0.5", "0.499"])

    def test_command_line(self):
        for arguments, value, remedy in (
                (["-s", "Grid/Spacing"], "'Grid/Spacing'", "Put '='"),
                (["-s"], "-s", "'morula --help' explains"),
                (["--resumee"], "--resumee", "'morula --help' explains"),
                (["--explain=3"], "--explain=3", "'morula --help' explains"),
                (["a.prm", "b.prm"], "a.prm b.prm", "Name one scene"),
                ([], "''", "Name the scene")):
            with self.subTest(arguments):
                words = [self.options.morula, *arguments]
                if arguments and not arguments[0].endswith(".prm"):
                    words.insert(1, str(SCENE))
                self.assert_refused(self.run_words(words, 1), [value, remedy])

    def test_scenes(self):
        """Mistakes in the file itself name file and line."""
        for name, content, texts in refusals.SCENES:
            with self.subTest(name):
                scene = self.work / f"{name}.prm"
                if name == "directory":
                    scene.mkdir()
                elif content is not None:
                    scene.write_bytes(content)
                result = self.execute(scene, code=1)
                self.assert_refused(result, [f"{name}.prm", *texts])

    def test_scene_that_cannot_be_read(self):
        """A file that opens, but whose reading fails."""
        result = self.execute("/proc/self/mem", code=1)
        self.assert_refused(result, ["'/proc/self/mem'",
                                     "a file that can be read to its end",
                                     "Check its permissions"])

    def test_output_directory(self):
        blocked = self.write("file", "kept\n")
        for output, limit, remedy in (
                (blocked, "a directory, but", "Choose another one"),
                (blocked / "below", "a directory, but", "Choose another one"),
                ("/proc/nowhere", "a directory that can be written",
                 "Choose another one")):
            with self.subTest(str(output)):
                result = self.execute(SCENE, output=output, code=1)
                self.assert_refused(result, ["Output directory",
                                             str(output).split("/below")[0],
                                             limit, remedy])
        self.assertEqual(blocked.read_text(), "kept\n")

