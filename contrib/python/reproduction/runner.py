# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Brings the paper's scenes to their end, going on where one stopped."""
import subprocess

from morula.command_line import tell
from morula.execute import Processes, command, overrides

from .paper_run import PaperRun

# Scenes that are resumed with a further one.
CONTINUED = {"fig-4b": ("fig-4b-picture",)}


def run_scenes(scenes, options, program, folder):
    """Runs scenes of a folder, so many at a time; those that failed. A finished run is
    left as it is: the program itself sees that."""
    processes = Processes()

    def execute(scene, file, word):
        """One call of the program; None, or what went wrong."""
        log = options.output / "log" / f"{file}.txt"
        log.parent.mkdir(parents=True, exist_ok=True)
        keys = [("Output directory", options.output / scene)]
        keys += [text.split("=", 1) for text in options.overrides]
        ended = processes.call(command(program, folder / f"{file}.prm", word, *overrides(keys)),
                               stdout=log, stderr=subprocess.STDOUT)
        if ended is None or ended.code == 0:
            return None
        lines = log.read_text().strip().splitlines()[-6:]
        return f"exit code {ended.code}; {log} ends with\n    " + "\n    ".join(lines)

    def run(scene):
        directory = options.output / scene
        resume = (directory / "snapshot.h5").exists() and not options.fresh
        failure = execute(scene, scene, "--resume" if resume else "--replace")
        for file in CONTINUED.get(scene, ()):
            failure = failure or execute(scene, file, "--resume")
        if failure and resume:
            failure += f"\n  To begin this run anew, remove {directory} or use --fresh."
        if failure:
            tell(f"reproduce: {scene} failed: {failure}")
        elif not processes.stopped:
            cells = PaperRun(directory).statistics["cells"].iloc[-1]
            tell(f"reproduce: {scene}: {cells:,.0f} cells")
        return failure

    failures = processes.each(run, scenes, options.jobs)
    return [scene for scene, failure in zip(scenes, failures) if failure]
