# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What was simulated: the keys of the scene, and its effects."""
import subprocess

from morula.refusal import Refused
from morula.scene import normal


def changed_keys(run, program):
    """(key, value, default) where the value is not that by default; of all keys
    without the program."""
    defaults = program.defaults if program else {}
    return [(key, value or "(empty)", defaults.get(key, "(unknown)") or "(empty)") for key, value
            in run.keys.items() if key not in defaults or normal(value) != normal(defaults[key])]


def effects(run, program):
    """(name, description) by --explain; none if the program does not
    say, as when a file that the scene names has gone."""
    if program is None:
        return []
    try:
        said = program.explain(run.directory / "parameters.prm")
    except (Refused, subprocess.SubprocessError, OSError):
        return []
    return [(effect["name"], effect["description"]) for effect in said["effects"]]


def log_lines(run):
    """What log.txt says besides a line a step."""
    file = run.directory / "log.txt"
    if not file.is_file():
        return []
    return [line for line in file.read_text(errors="replace").splitlines()
            if line.strip() and not line.startswith("step ")]
