# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs that cannot be resumed: exit code 1, the option or key, the value, the limit
and the remedy on stderr, and no file of the earlier run changed.
"""
import re
import shutil
from pathlib import Path

import h5py
import numpy as np
from tests.common.program import ProgramTest, overrides

from tests.common.sealing import seal

SCENE = Path(__file__).resolve().parent / "small-cube.prm"
ESTIMATE = overrides({"Output/Condition estimate": "true"})
HALF = overrides({"Time/End time": "0.25"})
ANEW = "or start the run anew"


def cut_rows(path, n):
    lines = path.read_text().splitlines(keepends=True)
    path.write_text("".join(lines[:n]))


def without(name):
    """Removes a table or a number of the snapshot, as another program might
    write it: with the digest of what is left."""
    def damage(output):
        with h5py.File(output / "snapshot.h5", "r+") as file:
            group, _, item = name.partition("/")
            if group == "numbers":
                del file["numbers"].attrs[item]
            else:
                del file[name]
        seal(output / "snapshot.h5")
    return damage


def other_columns(output):
    """As a program whose cell cycle has columns of other names writes it."""
    with h5py.File(output / "snapshot.h5", "r+") as file:
        names = file["cells/columns"][()].item().decode()
        del file["cells/columns"]
        file["cells/columns"] = np.bytes_(
            names.replace("event_time 1", "other_time 1"))
    seal(output / "snapshot.h5")


def fewer_numbers(output):
    with h5py.File(output / "snapshot.h5", "r+") as file:
        properties = file["cells/properties"][:, :-1]
        del file["cells/properties"]
        file["cells/properties"] = properties
    seal(output / "snapshot.h5")


def changed(change, name="snapshot.h5"):
    """The file with other bytes."""
    def damage(output):
        data = (output / name).read_bytes()
        other = change(data)
        assert other != data
        (output / name).write_bytes(other)
    return damage


def one_bit(where):
    def change(data):
        at = int(where * len(data))
        return data[:at] + bytes([data[at] ^ 16]) + data[at + 1:]
    return changed(change)


def swapped(data):
    half = len(data) // 2
    return (data[:half - 512] + data[half:half + 512] + data[half - 512:half]
            + data[half + 512:])


def other_digit(name, row, column):
    """One digit of an old row of a table."""
    def change(data):
        rows = data.split(b"\n")
        fields = rows[row].split(b",")
        fields[column] = re.sub(
            rb"\d(?=\D*$)", lambda m: b"%d" % ((int(m[0]) + 1) % 10),
            fields[column])
        rows[row] = b",".join(fields)
        return b"\n".join(rows)
    return changed(change, name)


def foreign(output):
    with h5py.File(output / "snapshot.h5", "w") as file:
        file["numbers"] = [1, 2, 3]


def other_position(output):
    """A value that makes sense, without its digest."""
    with h5py.File(output / "snapshot.h5", "r+") as file:
        file["cells/positions"][3, 0] += 1.0


def text(output):
    (output / "snapshot.h5").write_text("x,y,z\n")


# name -> (what is done to the finished run, what must be said)
DAMAGES = {
    "no snapshot": (lambda output: (output / "snapshot.h5").unlink(),
                    ("a snapshot that can be read",
                     "start the run without --resume")),
    "truncated": (changed(lambda data: data[:len(data) // 2]),
                  ("an undamaged snapshot", ANEW)),
    "appended": (changed(lambda data: data + b"\0"),
                 ("an undamaged snapshot", ANEW)),
    "a page of zeros": (changed(lambda data: data[:4096] + bytes(4096)
                                + data[8192:]), ("their digest differs", ANEW)),
    "swapped blocks": (changed(swapped), ("their digest differs", ANEW)),
    **{f"one bit at {where}": (one_bit(where), ("their digest differs", ANEW))
       for where in (0.01, 0.1, 0.35, 0.6, 0.85, 0.999)},
    "another position": (other_position, ("their digest differs", ANEW)),
    "foreign": (foreign, ("a snapshot that begins with a digest",
                          "the HDF5 file of another program", ANEW)),
    "no HDF5": (text, ("this file does not begin as one", ANEW)),
    "no box": (without("integer tables/box_n"),
               ("the table 'box_n' of 3 integers", "lacks it", ANEW)),
    "no weights": (without("grid weights"),
                   ("an undamaged snapshot", ANEW)),
    "no output times": (without("tables/output_times"),
                        ("the table 'output_times'", "lacks it", ANEW)),
    "no id": (without("numbers/next_id"), ("the number 'next_id'", ANEW)),
    "no row count": (without("numbers/statistics_rows"),
                     ("the number 'statistics_rows'", ANEW)),
    "no digest of rows": (without("integer tables/lineage_digest"),
                          ("the table 'lineage_digest' of 2", ANEW)),
    "no step": (without("numbers/step_level"),
                ("the number 'step_level'", ANEW)),
    "no cells": (without("cells/positions"), ("an undamaged snapshot", ANEW)),
    "no parameters": (without("parameters"), ("an undamaged snapshot", ANEW)),
    "cells of another kind": (fewer_numbers, ("a snapshot whose cells have",
                                              "numbers each", ANEW)),
    "cells with other columns": (
        other_columns, ("a snapshot whose cells have the columns that the "
                        "scene's effects declare (this one lacks 'event_time' "
                        "and has 'other_time')", ANEW)),
    "statistics cut": (lambda output: cut_rows(output / "statistics.csv", 2),
                       ("statistics.csv", "at least the 3 rows",
                        "there are 1", "Restore the file")),
    "lineage cut": (lambda output: cut_rows(output / "lineage.csv", 5),
                    ("lineage.csv", "rows that the snapshot counts",
                     "Restore the file")),
    "another digit in the statistics": (
        other_digit("statistics.csv", 1, 4),
        ("statistics.csv", "whose first 3 rows are those of the run",
         "Restore the file")),
    "another digit in the lineage": (
        other_digit("lineage.csv", 40, 5),
        ("lineage.csv", "rows are those of the run", "Restore the file")),
    "another digit in the conditions": (
        other_digit("condition.csv", 2, 3),
        ("condition.csv", "whose first 2 rows are those of the run",
         "Restore the file")),
    "lineage missing": (lambda output: (output / "lineage.csv").unlink(),
                        ("lineage.csv", "a readable file next to the snapshot",
                         "Restore the file")),
    "statistics of another run": (
        lambda output: (output / "statistics.csv").write_text("a,b\n1,2\n"),
        ("statistics.csv", "a file with the header", "Restore the file")),
}

KEYS = {"Grid/Spacing": ("34", "'35', as in the snapshot"),
        "Random seed": ("5", "'4', as in the snapshot"),
        "Material/Young's modulus": ("2", "as in the snapshot"),
        "Tissue/Cell spacing": ("10", "'12', as in the snapshot"),
        "Proliferation/Cell cycle/Duration": ("1.5", "as in the snapshot")}


class ResumeRefusals(ProgramTest):
    def setUp(self):
        super().setUp()
        self.execute(SCENE, *ESTIMATE, *HALF, output=self.work / "good")

    def refused(self, output, texts, *arguments):
        """Resumes; nothing may change but by what is said."""
        before = {path: path.read_bytes() for path in output.iterdir()}
        result = self.execute(SCENE, *ESTIMATE, "--resume", *arguments,
                              output=output, code=1)
        for expected in texts:
            self.assertIn(expected, result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertEqual(before,
                         {path: path.read_bytes() for path in output.iterdir()})

    def test_damages(self):
        for name, (damage, texts) in DAMAGES.items():
            with self.subTest(name):
                output = self.work / name.replace(" ", "-")
                shutil.copytree(self.work / "good", output)
                damage(output)
                self.refused(output, ("--resume = '" + str(output), *texts))

    def test_damage_on_two_ranks(self):
        output = self.work / "two"
        shutil.copytree(self.work / "good", output)
        DAMAGES["no box"][0](output)
        result = self.execute(SCENE, "--resume", output=output, ranks=2,
                              code=1)
        self.assertIn("'box_n'", result.stderr)
        self.assertEqual(result.stderr.count("morula: "), 1)

    def test_changed_keys(self):
        for key, (value, limit) in KEYS.items():
            with self.subTest(key):
                self.refused(self.work / "good",
                             (f"{key} = '{value}'", limit,
                              "Put the old value back"),
                             *overrides({key: value}))

