# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Processes of the program, for all tests in Python."""
import hashlib
import os
import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

# One thread a rank, any number of ranks, by any user. MPI's search for graphics
# cards would connect to every X server, and end the run if that server goes
# away meanwhile. What ctest sets (tests/CMakeLists.txt), for runs by hand.
ENVIRONMENT = {
    "OMP_NUM_THREADS": "1",
    "DEAL_II_NUM_THREADS": "1",
    "HWLOC_COMPONENTS": "-gl",
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "OMPI_MCA_hwloc_base_binding_policy": "none",
    "OMPI_MCA_btl_vader_single_copy_mechanism": "none",
}


def overrides(keys):
    """-s arguments for a dictionary of keys."""
    return [word for key, value in keys.items()
            for word in ("-s", f"{key}={value}")]


def call(words, cwd=ROOT, timeout=None):
    """(exit code, what it printed on both streams) of a process.

    Throws subprocess.TimeoutExpired after timeout seconds; the process has
    ended then.
    """
    result = subprocess.run([str(word) for word in words], cwd=cwd, text=True,
                            env={**ENVIRONMENT, **os.environ}, timeout=timeout,
                            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, check=False)
    return result.returncode, result.stdout


def program_stamp(morula):
    """Changes whenever the executable is built anew."""
    program = os.stat(morula)
    return [program.st_size, program.st_mtime]


def digest(files):
    """Of the contents of files."""
    found = hashlib.sha256()
    for file in files:
        found.update(Path(file).read_bytes())
    return found.hexdigest()


def files_of_scene(scene):
    """A .prm file with those it includes, and the files that their keys name
    (surface meshes, points), as paths."""
    scene = Path(scene)
    files = [scene]
    for line in scene.read_text().splitlines():
        include = re.match(r"\s*include\s+(\S+)", line)
        if include:
            files += files_of_scene(scene.parent / include[1])
        value = re.match(r"\s*set\s[^=#]*=\s*([^#]*?)\s*(#|$)", line)
        # A long expression is no file: systems refuse such names.
        if (value and 0 < len(value[1]) < 200
                and (ROOT / value[1]).is_file()):
            files.append(ROOT / value[1])
    return files
