# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The keys: doc/parameters.md has them all as they are; units."""
import subprocess
from pathlib import Path

from morula.keys import keys_of
from morula.prm import parse
from tests.common.program import ProgramTest

ROOT = Path(__file__).resolve().parents[2]


class Keys(ProgramTest):
    def test_document_is_up_to_date(self):
        result = subprocess.run(
            [ROOT / "contrib/upkeep/parameters", "--check", "--morula",
             self.options.morula], text=True, stderr=subprocess.PIPE)
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_document_has_all(self):
        keys = keys_of(self.options.morula)
        self.assertGreater(len(keys), 50)
        text = (ROOT / "doc/parameters.md").read_text()
        for key in keys:
            self.assertIn(f"| `{key.path}` |", text)
            self.assertTrue(key.meaning, key.path)

    def test_units(self):
        units = {key.path: key.unit for key in keys_of(self.options.morula)}
        for path, unit in (("Time/Step", "day"), ("Grid/Spacing", "um"),
                           ("Material/Young's modulus", "kPa"),
                           ("Body force/Force density", "kPa/um"),
                           ("Material/Poisson's ratio", ""),
                           ("Proliferation/Cell cycle/G0 exit rate", "1/day"),
                           ("Boundary conditions/Nitsche penalty", "E/h")):
            self.assertEqual(units[path], unit, path)

    def test_parsing(self):
        """The JSON says the same as the .prm file that people read."""
        keys = {key.path: key for key in keys_of(self.options.morula)}
        text = self.run_words([self.options.morula, "--parameters"]).stdout
        written = parse(text)
        self.assertEqual(list(keys), list(written))
        said = " ".join(line.strip(" #") for line in text.splitlines())
        for path, value in written.items():
            key = keys[path]
            self.assertEqual(key.default, value, path)
            for part in (key.meaning, key.allowed):
                self.assertIn(part, said, path)
        E = keys["Material/Young's modulus"]
        self.assertEqual((E.type, E.unit, E.components, E.evaluated),
                         ("expression", "kPa", 1, "at each step"))
        self.assertIn("generation", E.variables)
        self.assertNotIn("pressure", E.variables)
        self.assertEqual(
            {path: keys[path].type for path in (
                "Dimension", "Time/Step", "Grid/Extension", "Tissue/Center",
                "Output/Formats", "Tissue/Points surface", "Method")},
            {"Dimension": "integer", "Time/Step": "number",
             "Grid/Extension": "boolean", "Tissue/Center": "list of numbers",
             "Output/Formats": "list of words", "Method": "word",
             "Tissue/Points surface": "file"})
        self.assertEqual(keys["Method"].choices, ("paper", "consistent"))

    def test_words(self):
        """Keys that have all words, in path or meaning, and no others."""
        def shown(*words):
            return set(parse(self.run_words(
                [self.options.morula, "--parameters", *words]).stdout))
        every = {key.path: f"{key.path} {key.meaning}".lower()
                 for key in keys_of(self.options.morula)}
        for words in (("lumen",), ("LUMEN", "gas"), ("kpa",)):
            found = shown(*words)
            self.assertTrue(found)
            if words != ("kpa",):  # stands in units, too
                self.assertEqual(found, {
                    path for path, text in every.items()
                    if all(word.lower() in text for word in words)})
        self.assertIn("'xyzzy'", self.run_words(
            [self.options.morula, "--parameters", "xyzzy"], code=1).stderr)

