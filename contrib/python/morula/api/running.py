# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""How a scene of Python's is run by the program."""
from __future__ import annotations

import contextlib
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from morula import execute
from morula.kept_runs import with_snapshots
from morula.refusal import Refused
from morula.scene import normal

from .run import Run

PATIENCE = 600.0  # s, for the step that a run is at: then it saves its state
EVERY = 0.5  # s, between looks at how far it is
SELDOM = 60.0  # s, between lines in a log, which keeps them all


@contextlib.contextmanager
def scene_file(scene):
    """The .prm file of a scene: its own, or an empty one for keys alone."""
    if scene.path:
        yield scene.path
        return
    with tempfile.TemporaryDirectory() as scratch:
        file = Path(scratch) / f"{scene.name}.prm"
        file.write_text("", encoding="utf-8")
        yield file


def state_of(scene, directory, keys):
    """'none', 'finished', 'resumable', 'begun' (no snapshot yet) or 'other', of
    the run in a directory; keys as --explain has them."""
    if not (directory / "parameters.prm").is_file():
        return "none"
    try:
        found = Run(directory)
        there, done = found.keys, found.finished
    except Refused:  # nothing was computed yet
        return "begun"
    same = all(normal(there.get(key, "")) == normal(value) for key, value in keys.items()
               if key not in ("Output directory", "Output/Snapshot interval"))
    if not same:
        return "other"
    if done:
        return "finished"
    return ("resumable" if (directory / "snapshot.h5").is_file() else "begun")


def run_scene(scene, directory, ranks, progress, again):
    """See Scene.run."""
    keys = scene.explain()["keys"]
    snapshots = with_snapshots(keys)
    keys.update(snapshots)
    state = state_of(scene, directory, keys)
    if state == "finished" and not again:
        return Run(directory)
    if state == "other" and not again:
        raise Refused("The directory", directory, "one without a run of other values",
                      "Pass again=True to replace that run, or another name or directory.")
    if again and state == "resumable":
        state = "begun"
    how = {"resumable": ["--resume"], "none": []}.get(state, ["--replace"])
    with scene_file(scene) as file:
        overrides = [*scene._overrides(), *snapshots, ("Output directory", directory)]
        words = [*scene.program.command(file, overrides, ranks), *how]
        code, said = _execute(words, directory, float(keys["Time/End time"]), progress)
    if code == 1:
        raise Refused(f"The scene {scene.name} is refused: {said}")
    if code:
        raise RuntimeError(f"The run in {directory} ended with exit code {code}:" f" {said}")
    return Run(directory)


def _execute(words, directory, end, progress):
    """The exit code, and what was said to stderr. Ctrl-C is passed on as the
    signal after which the program saves its state."""
    live = sys.stderr.isatty() or "ipykernel" in sys.modules
    due = time.monotonic() + (0 if live else SELDOM)
    with tempfile.TemporaryFile("w+") as errors:
        child = execute.start(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                              stderr=errors)
        try:
            while child.poll() is None:
                with contextlib.suppress(subprocess.TimeoutExpired):
                    child.wait(EVERY)
                if progress and time.monotonic() >= due:
                    _tell(directory, end, live)
                    due += 0 if live else SELDOM
        except KeyboardInterrupt:
            print("\nmorula: saving; the same call goes on ...", file=sys.stderr, flush=True)
            execute.end([child], PATIENCE)
            raise
        finally:
            if child.poll() is None:
                execute.end([child], PATIENCE)
            if progress:
                _tell(directory, end, live)
                print(end="\n" if live else "", file=sys.stderr, flush=True)
        errors.seek(0)
        return child.returncode, errors.read().strip().removeprefix("morula: ")


def _tell(directory, end, live):
    """How far the run is: a line of its own, or over the one before where somebody looks on."""
    row = ["", "0"]
    with contextlib.suppress(OSError, IndexError):
        lines = (directory / "statistics.csv").read_text().splitlines()
        names, row = lines[0].split(","), lines[-1].split(",")
        row = [row[names.index("cells")], row[names.index("time")]]
    with contextlib.suppress(ValueError):
        text = (f"day {float(row[1]):g} of {end:g}, {row[0]} cells" if row[0]
                else "placing the cells ...")
        print(f"\r{text:<60}" if live else text, end="" if live else "\n", file=sys.stderr,
              flush=True)
