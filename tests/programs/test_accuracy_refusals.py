# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What contrib/accuracy refuses: exit code 1, one message that says what was
given and what is allowed, and nothing written.
"""
from accuracy import DISC, AccuracyTest

SPACING = ["--vary", "Grid/Spacing=80,40"]
MEASURE = ["--measure", "xmax,total_volume"]
GOOD = SPACING + MEASURE

# Arguments after the scene, and the texts that the refusal must have: what was
# given, and what is allowed or what to do.
NONSENSE = {
    "unknown key": (["--vary", "Grid/Spcing=80,40", *MEASURE],
                    "Grid/Spcing", "Grid/Spacing"),
    "no ladder": (MEASURE, "--vary", "at least one ladder"),
    "no values": (["--vary", "Grid/Spacing", *MEASURE], "--vary", "="),
    "empty value": (["--vary", "Grid/Spacing=80,,40", *MEASURE], "80,,40",
                    "empty"),
    "one value": (["--vary", "Grid/Spacing=80", *MEASURE], "Grid/Spacing=80",
                  "at least two"),
    "the same value": (["--vary", "Grid/Spacing=80,40,80.0", *MEASURE],
                       "'80' and '80.0'", "once"),
    "the same ladder": ([*SPACING, "--vary", "Grid/Spacing=20,10", *MEASURE],
                        "Grid/Spacing", "one ladder"),
    "a value that Morula refuses": (
        ["--vary", "Grid/Spacing=80,-40", *MEASURE], "Grid/Spacing=-40",
        "'-40'", "> 0"),
    "combinations that Morula refuses": (
        ["--grid", "--vary", "Tissue/Cell spacing=10,50", "--vary",
         "Tissue/Radius=80,20", *MEASURE], "Tissue/Cell spacing=50",
        "Tissue/Radius=20"),
    "a value too few": (
        ["--vary", "Grid/Spacing,Tissue/Cell spacing=80:20,40", *MEASURE],
        "'40'", "1 values for the 2 keys"),
    "a key twice": (["--vary", "Grid/Spacing,Grid/Spacing=8:8,4:4", *MEASURE],
                    "each key once"),
    "a grid of one key": (
        ["--grid", *SPACING, "--vary",
         "Grid/Spacing,Tissue/Cell spacing=80:20,40:10", *MEASURE],
        "--grid", "one ladder"),
    "seed as a rung": (["--vary", "Random seed=1,2", *MEASURE], "Random seed",
                       "--seeds"),
    "end as a rung": (["--vary", "Time/End time=1,2", *MEASURE],
                      "Time/End time", "--at"),
    "output as a rung": (["--vary", "Output/Formats=csv|vtu", *MEASURE],
                         "Output/Formats", "how well"),
    "dimension as a rung": (["--vary", "Dimension=2,3", *MEASURE],
                            "Dimension", "in common"),
    "a step beyond the end": (["--vary", "Time/Step=0.5,0.25,2", *MEASURE],
                              "Time/Step=2", "up to the end"),
    "offsets in words": ([*MEASURE, "--offsets", "some"], "--offsets", "some",
                         ">= 1"),
    "one offset": ([*MEASURE, "--offsets", "1"], "--offsets", "from 2 to 256"),
    "offsets twice": (["--vary", "Grid/Offset=0,0|5,5", *MEASURE, "--offsets",
                       "4"], "Grid/Offset", "moves the grid already"),
    "offsets and an error": ([*MEASURE, "--offsets", "4", "--wanted", "1%"],
                             "--wanted", "--vary"),
    "too many runs at offsets": (
        [*GOOD, "--seeds", "1..3", "--offsets", "200"], "1200 runs", "1000"),
    "method beside its keys": (
        ["--vary", "Method=paper,consistent", "--vary",
         "Boundary conditions/Nitsche penalty=20,1000", *MEASURE],
        "Method and Boundary conditions/Nitsche penalty", "vary Method alone"),
    "unknown measure": ([*SPACING, "--measure", "total_volum"], "total_volum",
                        "total_volume"),
    "measure of effort": ([*SPACING, "--measure", "wall_seconds"],
                          "wall_seconds", "no right value"),
    "measure twice": ([*SPACING, "--measure", "xmax,xmax"], "xmax", "once"),
    "no measure": ([*SPACING, "--measure", ""], "--measure",
                   "column of statistics.csv"),
    "unknown file": ([*SPACING, "--measure", "cell:volume"], "cell:volume",
                     "cells:"),
    "unknown reduction": ([*SPACING, "--measure", "cells:average(volume)"],
                          "average", "mean"),
    "percentile": ([*SPACING, "--measure", "cells:p101(volume)"], "p101",
                   "p100"),
    "open bracket": ([*SPACING, "--measure", "cells:max(volume"],
                     "cells:max(volume", "reduction(column)"),
    "reduction of one number": ([*SPACING, "--measure",
                                 "statistics:max(xmax)"], "max(xmax)",
                                "nothing to reduce"),
    "flat column": ([*SPACING, "--measure", "zmax"], "zmax",
                    "two-dimensional"),
    "seeds backwards": ([*GOOD, "--seeds", "8..1"], "8..1", "1..8"),
    "seeds twice": ([*GOOD, "--seeds", "1..3,2"], "1..3,2", "once"),
    "seeds in words": ([*GOOD, "--seeds", "one"], "one", "1..8"),
    "seeds where nothing is random": (
        [*GOOD, "--seeds", "1..3", "-s", "Proliferation/Law=none"], "--seeds",
        "nothing is random"),
    "too many runs": ([*GOOD, "--seeds", "1..999"], "1998 runs", "1000"),
    "time after the end": ([*GOOD, "--at", "2"], "--at", "End time = 1 day"),
    "time within a step": ([*GOOD, "--at", "0.3,1"], "0.3", "0.25"),
    "times that fall": ([*GOOD, "--at", "1,0.5"], "1,0.5", "rising"),
    "stop at cells": ([*GOOD, "-s", "Time/Stop at cells=300"],
                      "Time/Stop at cells", "300", "--at"),
    "jobs": ([*GOOD, "--jobs", "0"], "--jobs", "'0'", ">= 1"),
    "more jobs than cores": ([*GOOD, "--jobs", "4096"], "4096", "cores"),
    "ranks": ([*GOOD, "--ranks", "two"], "--ranks", "two", ">= 1"),
    "repeats": ([*GOOD, "--repeat", "-1"], "--repeat", "-1", ">= 1"),
    "wanted nothing": ([*GOOD, "--wanted", "0%"], "--wanted", "> 0"),
    "wanted in words": ([*GOOD, "--wanted", "good"], "good", "1%"),
    "wanted of another unit": ([*GOOD, "--wanted", "xmax=1kPa"], "xmax=1kPa",
                               "xmax [um]"),
    "wanted of another measure": ([*GOOD, "--wanted", "ymax=1um"], "ymax=1um",
                                  "xmax"),
    "wanted of several units": ([*GOOD, "--wanted", "1"], "different units"),
    "limit": ([*GOOD, "--limit", "Grid/Spacing=small"], "Grid/Spacing=small",
              "zero, large, tolerance, none"),
    "limit of no key": ([*GOOD, "--limit", "Grid/Spcing=zero"], "Grid/Spcing",
                        "Grid/Spacing"),
    "no reference": ([*GOOD, "--reference", "nowhere.csv"], "nowhere.csv",
                     "can be read"),
    "column without a reference": ([*GOOD, "--reference-column", "xmax=r"],
                                   "xmax=r", "--reference"),
    "override without a value": ([*GOOD, "-s", "Grid/Spacing"],
                                 "Grid/Spacing", "="),
    "override that Morula refuses": ([*GOOD, "-s", "Tissue/Shape=cube"],
                                     "Tissue/Shape=cube", "sphere"),
    "no executable": ([*GOOD, "--morula", "nowhere/morula"], "nowhere/morula",
                      "executable"),
}

# Reference files, further arguments, texts of the refusal.
BAD_REFERENCES = {
    "no column": ("apex\n310\n", [], "'xmax'", "apex", "--reference-column"),
    "no number": ("xmax,total_volume\n310,large\n", [], "Row 1"),
    "not finite": ("xmax,total_volume\nnan,3\n", [], "finite"),
    "a word too few": ("xmax,total_volume\n310\n", [], "Row 1"),
    "no row": ("xmax,total_volume\n", [], "a row"),
    "several rows": ("xmax,total_volume\n1,2\n3,4\n", [], "2 rows", "time"),
    "other times": ("time,xmax,total_volume\n0.5,1,2\n", [], "day 1", "0.5"),
    "negative error": ("xmax,xmax_error,total_volume\n1,-1,2\n", [],
                       "xmax_error", "negative"),
    "wrong expression": ("r,total_volume\n1,2\n",
                         ["--reference-column", "xmax=2*(r+"], "2*(r+",
                         "syntax"),
    "no arithmetic": ("r,total_volume\n1,2\n",
                      ["--reference-column", "xmax=open('r')"], "open",
                      "numbers"),
    **{name: ("r,total_volume\n1,2\n",
              ["--reference-column", f"xmax={text}"], said,
              "numbers, + - * / **, brackets and the columns r, total_volume")
       for name, text, said in (
           ("division by zero", "1/0", "a division by zero"),
           ("division by a column", "r/(total_volume-2)",
            "a division by zero"),
           ("a tower of powers", "9**9**9**9", "a number too large"),
           ("a large product", "1e300*1e300", "it is inf"),
           ("a complex root", "(-r)**0.5", "no finite real number"),
           ("many signs", "-" * 5000 + "1", "more than 500 characters"),
           ("a null byte", "r\0", "syntax"))},
}


class Refusals(AccuracyTest):
    def assert_refused(self, scene, arguments, texts):
        result = self.accuracy(scene, *arguments, code=1)
        self.assertTrue(result.stderr.startswith("accuracy: "))
        self.assertEqual(result.stdout, "")
        for text in texts:
            self.assertIn(text, result.stderr)
        self.assertFalse((self.work / "found").exists(),
                         "something was written")

    def test_nonsense(self):
        scene = self.write("disc.prm", DISC)
        for name, (arguments, *texts) in NONSENSE.items():
            with self.subTest(name):
                self.assert_refused(scene, arguments, texts)

    def test_references(self):
        scene = self.write("disc.prm", DISC)
        for name, (text, arguments, *texts) in BAD_REFERENCES.items():
            with self.subTest(name):
                file = self.write("reference.csv", text)
                self.assert_refused(scene, [*GOOD, "--reference", file,
                                            *arguments], texts)

    def test_scenes(self):
        self.assert_refused("nowhere.prm", GOOD,
                            ["nowhere.prm", "can be read"])
        points = self.write("points.csv", "x,y,z\n0,0,0\n20,0,0\n0,20,0\n")
        self.assert_refused(
            self.write("points.prm", "subsection Tissue\n  set Shape = points\n"
                       f"  set Points file = {points}\nend\n"),
            GOOD, ["xmax", "no surface"])
        broken = self.write("broken.prm", "subsection Grid\n")
        self.assert_refused(broken, GOOD, ["broken.prm", "end"])

    def test_command_line(self):
        """The script itself: one message, exit code 1, no stack of calls."""
        scene = self.write("disc.prm", DISC)
        for words, text in (([], "--measure"),
                            ([*GOOD, "--meausre", "xmax"], "--meausre"),
                            ([*GOOD, "--seeds", "2..1"], "1..2")):
            result = self.accuracy(scene, *words, code=1)
            self.assertIn(text, result.stderr)
            self.assertEqual(result.stderr.count("\n"), 1, result.stderr)

