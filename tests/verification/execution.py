# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs of the program for the rungs of a ladder, each in its own directory."""
import hashlib
import inspect
import json
import os
import re
import shlex
import shutil
import subprocess
from pathlib import Path

import numpy
from ladder import ROOT, SCENES, Measured
from results import Results

HERE = Path(__file__).resolve().parent

# One rank and one thread, by any user. MPI's search for graphics cards would
# connect to every X server, and end the run if that server goes away meanwhile.
ENVIRONMENT = {"OMP_NUM_THREADS": "1", "DEAL_II_NUM_THREADS": "1",
               "HWLOC_COMPONENTS": "-gl",
               "OMPI_ALLOW_RUN_AS_ROOT": "1",
               "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


class RunFailed(Exception):
    """The program did not end with exit code 0."""


def run(morula, scene, keys, output):
    """Runs a scene of prm/verification, from where prm/ is."""
    command = [str(morula), str(SCENES / scene),
               "-s", f"Output directory={output}"]
    for key, value in keys.items():
        command += ["-s", f"{key}={value}"]
    result = subprocess.run(command, cwd=ROOT, text=True,
                            env={**ENVIRONMENT, **os.environ},
                            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, check=False)
    if result.returncode != 0:
        raise RunFailed(f"+ {shlex.join(command)}\n{result.stdout}"
                        f"exit code {result.returncode}")
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
    program = os.stat(morula)
    digest = hashlib.sha256()
    texts = [(SCENES / scene).read_text() for scene in ladder.scenes]
    meshes = [ROOT / name for text in texts
              for name in re.findall(r"set Surface mesh *= *(\S+)", text)]
    files = meshes + [file for file in sorted(HERE.glob("*.py"))
             if file.name not in ("report.py", "plots.py")]
    files += [Path(inspect.getsourcefile(judge))
              for judge in (case.errors, Results)]
    for file in files:
        digest.update(file.read_bytes())
    return {"scenes": texts,
            "keys": rung.keys, "judges": digest.hexdigest(),
            "program": [program.st_size, program.st_mtime]}


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
