# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What was simulated: the keys of the scene, and its effects."""
import subprocess

from morula.refusal import Refused
from morula.scene import normal

from .markup import Markup, definitions, number, span, table

# What turns an effect on: its key, and the value without it.
SWITCHES = (
    ("growth", "Growth/Law", "none"),
    ("proliferation", "Proliferation/Law", "none"),
    ("size checkpoint", "Proliferation/Cell cycle/Size checkpoint", "0"),
    ("fixed points", "Boundary conditions/Fixed where", ""),
    ("slip", "Boundary conditions/Slip where", ""),
    ("traction", "Boundary conditions/Traction where", ""),
    ("pressure", "Boundary conditions/Pressure where", ""),
    ("surface tension", "Boundary conditions/Surface tension", "0"),
    ("lumen", "Boundary conditions/Lumen where", ""),
    ("obstacles", "Obstacles/Names", ""),
    ("body force", "Body force/Force density", "0;0;0"))


def at_a_glance(run):
    first, last = run.statistics.iloc[0], run.statistics.iloc[-1]
    return definitions([
        ("from day", number(first["time"])),
        ("to day", number(last["time"]), "last-day"),
        ("steps", number(len(run.statistics) - 1), "steps"),
        ("cells at first", number(first["cells"]), "first-cells"),
        ("cells at last", number(last["cells"]), "last-cells"),
        (f"volume at last, {volume_unit(run)}",
         number(last["total_volume"]), "last-volume"),
        ("wall time, s", number(last["wall_seconds"]), "wall-seconds")])


def volume_unit(run):
    return "µm³" if run.dimension == 3 else "µm²"


def changed_keys(run, program):
    """The keys that are not as the program has them by default, or all of
    them without the program."""
    if program is None:
        words = ("The program was not found, so that these are all keys "
                 "(<code>--morula</code> names it).")
        rows = sorted(run.keys.items())
        return Markup(f"<p>{words}</p>") + table(
            ["key", "value"], [(key, value or "(empty)") for key, value
                               in rows], "keys")
    defaults = program.defaults
    rows = [(key, value or "(empty)", defaults.get(key, "(unknown key)")
             or "(empty)")
            for key, value in run.keys.items()
            if key not in defaults or normal(value) != normal(defaults[key])]
    everything = table(["key", "value"], [
        (key, value or "(empty)") for key, value in run.keys.items()])
    return table(["key", "value", "default"], rows, "keys") + Markup(
        f"<details><summary>All {len(run.keys)} keys</summary>{everything}"
        "</details>")


def effects(run, program):
    """On and off: in the program's own words, or from the keys."""
    rows = said_by_program(run, program) or switched_by_keys(run)
    return table(["effect", "", "how"],
                 [(name, span(state, state), how)
                  for name, state, how in rows], "effects")


def said_by_program(run, program):
    """The effects of --explain; None if the program does not
    say, as when a file that the scene names has gone."""
    if program is None:
        return None
    try:
        said = program.explain(run.directory / "parameters.prm")
    except (Refused, subprocess.SubprocessError, OSError):
        return None
    return [(effect["name"], "on" if effect["on"] else "off",
             effect["description"]) for effect in said["effects"]]


def switched_by_keys(run):
    rows = []
    for name, key, off in SWITCHES:
        value = run.keys.get(key, off)
        is_off = normal(value.replace(" ", "")) == off
        # without proliferation nothing waits at its checkpoint
        if name == "size checkpoint" and run.keys.get(
                "Proliferation/Law", "none") == "none":
            is_off = True
        rows.append((name, "off" if is_off else "on",
                     "" if is_off else f"{key} = {value}"))
    return rows


def log_lines(run):
    """What log.txt says besides a line a step."""
    file = run.directory / "log.txt"
    if not file.is_file():
        return []
    return [line for line in file.read_text(errors="replace").splitlines()
            if line.strip() and not line.startswith("step ")]
