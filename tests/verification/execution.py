# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs of the program for the rungs of a ladder, each in its own directory."""
import inspect
import shlex
import shutil
from pathlib import Path

import numpy
from morula.execute import command, overrides

from tests.common.forks import call
from tests.common.kept import ROOT, digest, files_of_scene, kept, program_stamp
from tests.common.results import Results
from tests.verification.ladder import SCENES, Measured

HERE = Path(__file__).resolve().parent


class RunFailed(Exception):
    """The program did not end with exit code 0."""


def run(morula, scene, keys, output):
    """Runs a scene of prm/verification, from where prm/ is."""
    words = command(morula, SCENES / scene,
                    *overrides({"Output directory": output, **keys}))
    ended = call(words, cwd=ROOT)
    if ended.code != 0:
        raise RunFailed(f"+ {shlex.join(words)}\n{ended.text}exit code "
                        f"{ended.code}")
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
    def errors():
        shutil.rmtree(directory, ignore_errors=True)
        directory.mkdir(parents=True)
        keys = dict(rung.keys)
        if rung.cells:
            keys.update(write_cells(directory / "cells.csv", rung.cells()))
        runs = [run(morula, scene, keys, directory / Path(scene).stem)
                for scene in ladder.scenes]
        found = {name: float(value)
                 for name, value in case.errors(*runs).items()}
        for results in runs:
            remove_large_files(results)
        return found

    return kept(directory / "errors.json",
                origin(case, ladder, rung, morula), errors)


def measure(case, ladder, morula, directory, full):
    """Runs a ladder."""
    rungs = ladder.wanted(full)
    rows = [measure_rung(case, ladder, rung, morula,
                         directory / ladder.name / f"{rung.size:g}")
            for rung in rungs]
    return Measured(ladder, [rung.size for rung in rungs],
                    {name: [row[name] for row in rows] for name in rows[0]})
