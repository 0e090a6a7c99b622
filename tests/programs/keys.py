#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The keys: doc/parameters.md has them all as they are; units; former names."""
import subprocess
from pathlib import Path

from morula.keys import RENAMES, keys_of, parse_keys
from morula.migrate import migrate
from program import ProgramTest, main

ROOT = Path(__file__).resolve().parents[2]

# A table of renames for tests alone.
TEST_RENAMES = {"Grid/Mesh size": "Grid/Spacing",
                "Seed": "Random seed",
                "Grid/Young": "Material/Young's modulus"}
OLD = """# A comment about Mesh size
set Seed = 4
subsection Grid  # the grid
  set   Mesh size = 50   # um, was Mesh size
  set Young = 1 + \\
    0.001*X  # kPa
  set Offset = 1, 2, 3
end
set Dimension = 3"""
NEW = """# A comment about Mesh size
set Random seed = 4
subsection Grid  # the grid
  set   Spacing = 50   # um, was Mesh size
  set Offset = 1, 2, 3
end
set Dimension = 3
subsection Material
  set Young's modulus = 1 + \\
    0.001*X
end
"""


class Keys(ProgramTest):
    def test_document_is_up_to_date(self):
        result = subprocess.run(
            [ROOT / "contrib/parameters", "--check", "--morula",
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
        key, = parse_keys("subsection A\n  # Long; > 0. Units:\n  # um. "
                          "Allowed: a number.\n  # Formerly: A/C\n"
                          "  set B = 1\nend\n")
        self.assertEqual((key.path, key.default, key.unit, key.allowed,
                          key.meaning, key.former),
                         ("A/B", "1", "um", "a number", "Long; > 0.",
                          ("A/C",)))

    def test_table_of_renames_is_the_programs(self):
        keys = keys_of(self.options.morula)
        paths = {key.path for key in keys}
        known = {former: key.path for key in keys for former in key.former}
        for former, path in RENAMES.items():
            self.assertIn(path, paths)
            self.assertNotIn(former, paths)
        for former, path in known.items():
            self.assertEqual(RENAMES.get(former), path)

    def test_migration(self):
        text, done = migrate(OLD, TEST_RENAMES)
        self.assertEqual(text, NEW)
        self.assertEqual(dict(done), TEST_RENAMES)
        self.assertEqual(migrate(NEW, TEST_RENAMES), (NEW, []))
        self.execute(self.write("new.prm", text), "--explain")

    def test_migrating_the_scenes_changes_nothing(self):
        scenes = sorted((ROOT / "prm").rglob("*.prm"))
        before = [scene.read_bytes() for scene in scenes]
        result = subprocess.run([ROOT / "contrib/migrate", "--check", *scenes],
                                text=True, stdout=subprocess.PIPE)
        self.assertEqual(result.returncode, 0, result.stdout)
        self.assertEqual(before, [scene.read_bytes() for scene in scenes])


if __name__ == "__main__":
    main()
