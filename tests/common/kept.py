# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Results of runs, kept until something that they depend on changes."""
import hashlib
import json
import os
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def kept(record, origin, make):
    """What make() returned, a dictionary that JSON can hold, when the origin
    was the same as now: read from the file `record`, or made anew and kept
    there. Results with anything under "wrong" are not kept."""
    if record.is_file():
        before = json.loads(record.read_text())
        if before["origin"] == json.loads(json.dumps(origin)):
            return before["result"]
    record.unlink(missing_ok=True)
    result = make()
    if not result.get("wrong"):
        record.write_text(json.dumps({"origin": origin, "result": result}))
    return result


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
