# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs that cannot be resumed: exit code 1, the option or key, the value, the limit
and the remedy on stderr, and no file of the earlier run changed.
"""
import re
import shutil

import h5py
import numpy as np
import pytest

from tests.common.program import TESTS, overrides
from tests.common.sealing import seal

SCENE = TESTS / "programs/small-cube.prm"
ESTIMATE = {"Output/Condition estimate": "true"}
ANEW, FILE, DIGEST = "or start the run anew", "Restore the file", "their digest differs"


def sealed(change):
    """A damage of the snapshot with the digest of what is left, as another program
    might write it."""
    def damage(output):
        with h5py.File(output / "snapshot.h5", "r+") as file:
            change(file)
        seal(output / "snapshot.h5")
    return damage


def without(name):
    """Removes a table or a number of the snapshot."""
    group, _, item = name.partition("/")
    if group == "numbers":
        return sealed(lambda file: file["numbers"].attrs.__delitem__(item))
    return sealed(lambda file: file.__delitem__(name))


def replaced(name, change):
    def anew(file):
        data = change(file[name][()])
        del file[name]
        file[name] = data
    return sealed(anew)


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
        fields[column] = re.sub(rb"\d(?=\D*$)", lambda m: b"%d" % ((int(m[0]) + 1) % 10),
                                fields[column])
        rows[row] = b",".join(fields)
        return b"\n".join(rows)
    return changed(change, name)


def cut_rows(name, n):
    return changed(lambda data: b"".join(data.splitlines(keepends=True)[:n]), name)


def foreign(output):
    with h5py.File(output / "snapshot.h5", "w") as file:
        file["numbers"] = [1, 2, 3]


def other_position(output):
    """A value that makes sense, without its digest."""
    with h5py.File(output / "snapshot.h5", "r+") as file:
        file["cells/positions"][3, 0] += 1.0


DAMAGES = {
    "no snapshot": (lambda output: (output / "snapshot.h5").unlink(),
                    ("start the run without --resume",)),
    "truncated": (changed(lambda data: data[:len(data) // 2]), ("an undamaged snapshot", ANEW)),
    "appended": (changed(lambda data: data + b"\0"), ("an undamaged snapshot", ANEW)),
    "a page of zeros": (changed(lambda data: data[:4096] + bytes(4096) + data[8192:]),
                        (DIGEST, ANEW)),
    "swapped blocks": (changed(swapped), (DIGEST, ANEW)),
    **{f"one bit at {where}": (one_bit(where), (DIGEST, ANEW))
       for where in (0.01, 0.1, 0.35, 0.6, 0.85, 0.999)},
    "another position": (other_position, (DIGEST, ANEW)),
    "foreign": (foreign, ("the HDF5 file of another program", ANEW)),
    "no HDF5": (changed(lambda data: b"x,y,z\n"), ("this file does not begin as one", ANEW)),
    "no box": (without("integer tables/box_n"), ("the table 'box_n' of 3 integers", ANEW)),
    "no weights": (without("grid weights"), ("an undamaged snapshot", ANEW)),
    "no output times": (without("tables/output_times"), ("the table 'output_times'", ANEW)),
    "no id": (without("numbers/next_id"), ("the number 'next_id'", ANEW)),
    "no row count": (without("numbers/statistics_rows"), ("the number 'statistics_rows'", ANEW)),
    "no digest of rows": (without("integer tables/lineage_digest"),
                          ("the table 'lineage_digest' of 2", ANEW)),
    "no step": (without("numbers/step_level"), ("the number 'step_level'", ANEW)),
    "no cells": (without("cells/positions"), ("an undamaged snapshot", ANEW)),
    "no parameters": (without("parameters"), ("an undamaged snapshot", ANEW)),
    "cells of another kind": (replaced("cells/properties", lambda data: data[:, :-1]),
                              ("a snapshot whose cells have", ANEW)),
    "cells with other columns": (
        replaced("cells/columns", lambda data: np.bytes_(
            data.item().decode().replace("event_time 1", "other_time 1"))),
        ("this one lacks 'event_time' and has 'other_time'", ANEW)),
    "statistics cut": (cut_rows("statistics.csv", 2), ("at least the 3 rows", "there are 1", FILE)),
    "lineage cut": (cut_rows("lineage.csv", 5), ("lineage.csv", FILE)),
    "digit in the statistics": (other_digit("statistics.csv", 1, 4),
                                ("statistics.csv", "whose first 3 rows", FILE)),
    "digit in the lineage": (other_digit("lineage.csv", 40, 5), ("lineage.csv", FILE)),
    "digit in the conditions": (other_digit("condition.csv", 2, 3),
                                ("condition.csv", "whose first 2 rows", FILE)),
    "lineage missing": (lambda output: (output / "lineage.csv").unlink(), ("lineage.csv", FILE)),
    "statistics of another run": (changed(lambda data: b"a,b\n1,2\n", "statistics.csv"),
                                  ("statistics.csv", "a file with the header", FILE))}


@pytest.fixture(scope="module")
def good(runs):
    return runs.run("good", SCENE, {**ESTIMATE, "Time/End time": 0.25}).directory


def check(runs, output, texts, keys=(), ranks=1):
    """Resumes; nothing may change but by what is said."""
    before = {path: path.read_bytes() for path in output.iterdir()}
    result = runs.execute(SCENE, *overrides({**ESTIMATE, **dict(keys)}), "--resume",
                          output=output, code=1, ranks=ranks)
    for expected in texts:
        assert expected in result.stderr
    assert result.stderr.count("morula: ") == 1
    assert result.stdout == ""
    assert before == {path: path.read_bytes() for path in output.iterdir()}


@pytest.mark.parametrize("name, ranks", [*((name, 1) for name in DAMAGES), ("no box", 2)])
def test_damages(runs, good, name, ranks):
    damage, texts = DAMAGES[name]
    output = runs.work / f"{name}-{ranks}".replace(" ", "-")
    shutil.copytree(good, output)
    damage(output)
    check(runs, output, (f"--resume = '{output}", *texts), ranks=ranks)


@pytest.mark.parametrize("key, value, limit", [
    ("Grid/Spacing", "34", "'35', as in the snapshot"),
    ("Random seed", "5", "'4', as in the snapshot"),
    ("Material/Young's modulus", "2", "as in the snapshot"),
    ("Tissue/Cell spacing", "10", "'12', as in the snapshot"),
    ("Proliferation/Cell cycle/Duration", "1.5", "as in the snapshot")])
def test_changed_keys(runs, good, key, value, limit):
    check(runs, good, (f"{key} = '{value}'", limit, "Put the old value back"), {key: value})


def test_step_too_long_for_the_cycle(runs, good):
    check(runs, good, ("Time/Step",), {"Time/Step": "0.6"})


def test_no_run(runs):
    said = runs.refused(SCENE, {}, "--resume", output=runs.work / "nothing")
    assert "snapshot.h5" in said
    assert not (runs.work / "nothing").exists()
