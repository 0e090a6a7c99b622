# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs of the program for the rungs of a ladder, each in its own directory."""
import inspect
import json
import shlex
import shutil
from pathlib import Path

import numpy

from tests.common.processes import (call, digest, files_of_scene, overrides,
                                    program_stamp)
from tests.common.results import Results
from tests.verification.ladder import SCENES, Measured

HERE = Path(__file__).resolve().parent


class RunFailed(Exception):
    """The program did not end with exit code 0."""


def run(morula, scene, keys, output):
    """Runs a scene of prm/verification, from where prm/ is."""
    command = [str(morula), str(SCENES / scene),
               *overrides({"Output directory": output, **keys})]
    code, text = call(command)
    if code != 0:
        raise RunFailed(f"+ {shlex.join(command)}\n{text}exit code {code}")
    return Results(output)


def write_cells(file, layout):
    """A points file of positions (n, dim) in µm and volumes in µm^dim."""
    X, volumes = layout
    header = ",".join("xyz"[:X.shape[1]]) + ",volume"
    numpy.savetxt(file, numpy.column_stack([X, volumes]), fmt="%.17g",
                  delimiter=",", header=header, comments="")
    return {"Tissue/Shape": "points", "Tissue/Points file": str(file)}


def origin(case, ladder, rung, morula):
    """What the errors of a rung depend on: scenes, keys, the program, and the
    code that judges it."""
    scenes = [SCENES / scene for scene in ladder.scenes]
    files = [file for scene in scenes for file in files_of_scene(scene)]
    files += [file for file in sorted(HERE.glob("*.py"))
              if file.name not in ("report.py", "plots.py")]
    files += [Path(inspect.getsourcefile(judge))
              for judge in (case.errors, Results, call)]
    return {"keys": rung.keys, "files": digest(files),
            "program": program_stamp(morula)}


def remove_large_files(results):
    for kind in ("cells", "surface"):
        for file in results.outputs(kind):
            file.unlink()
    (results.directory / "snapshot.h5").unlink(missing_ok=True)


def measure_rung(case, ladder, rung, morula, directory):
    """The errors of a rung. They are kept beside the runs, and read from there
    if scenes, keys and program are the same; the runs' large files are not."""
    kept = directory / "errors.json"
    found = {"origin": origin(case, ladder, rung, morula)}
    if kept.is_file():
        before = json.loads(kept.read_text())
        if before["origin"] == found["origin"]:
            return before["errors"]
    shutil.rmtree(directory, ignore_errors=True)
    directory.mkdir(parents=True)
    keys = dict(rung.keys)
    if rung.cells:
        keys.update(write_cells(directory / "cells.csv", rung.cells()))
    runs = [run(morula, scene, keys, directory / Path(scene).stem)
            for scene in ladder.scenes]
    found["errors"] = {name: float(value)
                       for name, value in case.errors(*runs).items()}
    for results in runs:
        remove_large_files(results)
    kept.write_text(json.dumps(found))
    return found["errors"]


def measure(case, ladder, morula, directory, full):
    """Runs a ladder."""
    rungs = ladder.wanted(full)
    rows = [measure_rung(case, ladder, rung, morula,
                         directory / ladder.name / f"{rung.size:g}")
            for rung in rungs]
    return Measured(ladder, [rung.size for rung in rungs],
                    {name: [row[name] for row in rows] for name in rows[0]})
