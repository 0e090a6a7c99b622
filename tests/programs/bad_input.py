#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Bad input: exit code 1, key, value, limit and remedy on stderr, nothing on
stdout, and no output directory.
"""
from pathlib import Path

from program import ProgramTest, main, overrides

SCENE = Path(__file__).resolve().parent / "small-cube.prm"
CYCLE = "Proliferation/Cell cycle/"
CONDITIONS = "Boundary conditions/"

# Overrides of the scene; the texts that the message must have: the key, the
# value, what is allowed or what to do.
CASES = {
    "unknown key": ({"Grid/Spcing": "50"}, "Grid/Spcing", "Grid/Spacing"),
    "unknown section": ({"Gird/Spacing": "50"}, "Gird", "Grid"),
    "unknown choice": ({"Tissue/Shape": "cube"}, "Tissue/Shape", "cube",
                       "box"),
    "no number": ({"Time/End time": "long"}, "Time/End time", "long",
                  "number"),
    "dimension": ({"Dimension": "4"}, "Dimension", "4", "3"),
    "grid spacing": ({"Grid/Spacing": "-50"}, "Grid/Spacing", "-50", "> 0"),
    "no grid spacing": ({"Grid/Spacing": "0"}, "Grid/Spacing", "'0'", "> 0"),
    "cell spacing": ({"Tissue/Cell spacing": "-10"}, "Tissue/Cell spacing",
                     "-10", "above 0"),
    "negative size": ({"Tissue/Size": "60, -60, 60"}, "Tissue/Size", "-60",
                      "above 0"),
    "negative radius": ({"Tissue/Shape": "sphere", "Tissue/Radius": "-1"},
                        "Tissue/Radius", "-1", "above 0"),
    "cells that do not fit": ({"Tissue/Cell spacing": "130"},
                              "Tissue/Cell spacing", "130"),
    "incompressible": ({"Material/Poisson's ratio": "0.5"},
                       "Material/Poisson's ratio", "0.5", "< 0.5"),
    "ratio too low": ({"Material/Poisson's ratio": "-1"},
                      "Material/Poisson's ratio", "-1", "> -1"),
    "no stiffness": ({"Material/Young's modulus": "0"},
                     "Material/Young's modulus", "'0'", "> 0"),
    "stiffness negative somewhere": ({"Material/Young's modulus": "X"},
                                     "Material/Young's modulus", "'X'", "> 0"),
    "typo in an expression": ({"Growth/Law": "isotropic",
                               "Growth/Isotropic/Stretch": "1 + 0.1*tt"},
                              "Growth/Isotropic/Stretch", "1 + 0.1*tt", "tt"),
    "open bracket": ({CONDITIONS + "Slip where": "(Z <= 0"},
                     CONDITIONS + "Slip where", "(Z <= 0"),
    "too few components": ({CONDITIONS + "Traction where": "Z > 59",
                            CONDITIONS + "Traction": "1"},
                           CONDITIONS + "Traction", "'1'", "3"),
    "growth that ends below zero": ({"Growth/Law": "isotropic",
                                     "Growth/Isotropic/Stretch": "1 - 1.5*t"},
                                    "Growth/Isotropic/Stretch", "1 - 1.5*t",
                                    "> 0"),
    "growth without its law": ({"Growth/Isotropic/Stretch": "1 + t"},
                               "Growth/Isotropic/Stretch", "1 + t",
                               "Growth/Law"),
    "condition that holds nowhere": ({CONDITIONS + "Fixed where": "Z < -100"},
                                     CONDITIONS + "Fixed where", "Z < -100"),
    "normal without direction": ({CONDITIONS + "Slip normal": "0, 0, 0"},
                                 CONDITIONS + "Slip normal", "0, 0, 0"),
    "penalty": ({CONDITIONS + "Nitsche penalty": "-1"},
                CONDITIONS + "Nitsche penalty", "-1", "> 0"),
    "step above T/2": ({"Time/Step": "0.6"}, "Time/Step", "0.6", "0.5 day",
                       CYCLE + "Duration"),
    "step above T/2 of some founder": ({CYCLE + "Duration": "1 - 0.9*(X > 0)"},
                                       "Time/Step", "0.125", "0.05 day"),
    "cycle of no length": ({CYCLE + "Duration": "0"}, CYCLE + "Duration",
                           "'0'", "> 0"),
    "negative rate": ({CYCLE + "G0 exit rate": "-1"}, CYCLE + "G0 exit rate",
                      "-1", ">= 0"),
    "axis without direction": ({CYCLE + "Division axis": "fixed",
                                CYCLE + "Fixed axis": "0, 0, 0"},
                               CYCLE + "Fixed axis", "0, 0, 0"),
    "no step": ({"Time/Step": "0"}, "Time/Step", "'0'", "> 0"),
    "no end": ({"Time/End time": "-1"}, "Time/End time", "-1", "> 0"),
    "occupation": ({"Grid/Occupation parameter": "1.5"},
                   "Grid/Occupation parameter", "1.5", "1"),
    "tolerance": ({"Solver/Newton tolerance": "0"}, "Solver/Newton tolerance",
                  "'0'", "> 0"),
    "formats": ({"Output/Formats": "vtk"}, "Output/Formats", "vtk", "vtu"),
    "contradicting formats": ({"Output/Formats": "none, csv"},
                              "Output/Formats", "none, csv"),
    "missing mesh": ({"Tissue/Shape": "mesh",
                      "Tissue/Surface mesh": "nowhere.stl"},
                     "Tissue/Surface mesh", "nowhere.stl"),
    "no mesh": ({"Tissue/Shape": "mesh"}, "Tissue/Surface mesh"),
    "missing points": ({"Tissue/Shape": "points",
                        "Tissue/Points file": "nowhere.csv",
                        CONDITIONS + "Slip where": "",
                        CONDITIONS + "Slip normal": ""},
                       "Tissue/Points file", "nowhere.csv"),
    "points have no surface": ({"Tissue/Shape": "points",
                                "Tissue/Points file": "scattered-cells.csv"},
                               CONDITIONS + "Slip where", "Z <= 0"),
    "no cylinder in 2-D": ({"Dimension": "2", "Tissue/Shape": "cylinder"},
                           "Tissue/Shape", "cylinder"),
    "too many cells": ({"Tissue/Cell spacing": "0.01"}, "Tissue/Cell spacing",
                       "0.01"),
    "more than memory": ({"Tissue/Cell spacing": "0.04"}, "The scene", "GB",
                         "Tissue/Cell spacing"),
}


class BadInput(ProgramTest):
    def assert_refused(self, result, texts):
        self.assertEqual(result.stdout, "")
        for text in texts:
            self.assertIn(text, result.stderr)
        self.assertNotIn("exception", result.stderr.lower())
        self.assertNotIn(".cc", result.stderr)
        self.assertFalse((self.work / "output").exists(), "directory touched")

    def test_keys(self):
        for name, (keys, *texts) in CASES.items():
            with self.subTest(name):
                result = self.execute(SCENE, *overrides(keys), code=1)
                self.assert_refused(result, texts)

    def test_on_several_ranks(self):
        """One message, and no rank left waiting."""
        for name in ("grid spacing", "stiffness negative somewhere",
                     "missing mesh"):
            keys, *texts = CASES[name]
            with self.subTest(name):
                words = self.command(SCENE, "-s", f"Output directory="
                                     f"{self.work / 'output'}",
                                     *overrides(keys), ranks=3)
                result = self.run_words(words, 1)
                self.assert_refused(result, texts)
                self.assertEqual(result.stderr.count("morula: "), 1)

    def test_explain_refuses_alike(self):
        keys, *texts = CASES["incompressible"]
        result = self.execute(SCENE, "--explain", *overrides(keys), code=1)
        self.assert_refused(result, texts)

    def test_command_line(self):
        for arguments, text in (
                (["-s", "Grid/Spacing"], "="),
                (["-s"], "-s"),
                (["--resumee"], "--resumee"),
                (["a.prm", "b.prm"], "b.prm"),
                ([], "scene")):
            with self.subTest(arguments):
                words = [self.options.morula, *arguments]
                if arguments and not arguments[0].endswith(".prm"):
                    words.insert(1, str(SCENE))
                result = self.run_words(words, 1)
                self.assert_refused(result, [text])
        self.assert_refused(self.run_words(self.command("nowhere.prm"), 1),
                            ["nowhere.prm"])

    def test_file(self):
        """Mistakes in the file itself name file and line."""
        for name, text, message in (
                ("word", "sett Dimension = 3\n", "sett"),
                ("equals", "set Dimension 3\n", "="),
                ("open", "subsection Grid\n  set Spacing = 5\n", "end"),
                ("end", "set Dimension = 3\nend\n", "end"),
                ("key", "subsection Grid\n  set Spacng = 5\nend\n",
                 "Spacng")):
            with self.subTest(name):
                scene = self.write(f"{name}.prm", text)
                result = self.execute(scene, code=1)
                self.assert_refused(result, [f"{name}.prm", message])

    def test_output_directory(self):
        blocked = self.write("file", "kept\n")
        result = self.execute(SCENE, output=blocked / "below", code=1)
        self.assert_refused(result, ["Output directory", str(blocked)])
        self.assertEqual(blocked.read_text(), "kept\n")


if __name__ == "__main__":
    main()
