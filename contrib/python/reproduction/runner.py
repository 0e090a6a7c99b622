# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Brings the paper's scenes to their end, going on where one stopped."""
import subprocess
import time

from morula.execute import Processes, command

from .run_results import PaperRun

# Scenes that are resumed with a further one.
CONTINUED = {"fig-4b": ["fig-4b-picture"]}


def run_scenes(scenes, options, program, folder, say):
    """Runs scenes of a folder, so many at a time; {scene: what went wrong}. A
    finished run is left as it is: the program itself sees that."""
    processes = Processes()

    def execute(scene, file, word):
        """One call of the program; None, or what went wrong."""
        settings = [f"Output directory={options.output / scene}",
                    *options.overrides]
        log = options.output / "log" / f"{file}.txt"
        log.parent.mkdir(parents=True, exist_ok=True)
        ended = processes.call(
            command(program, folder / f"{file}.prm", word,
                    *(w for text in settings for w in ("-s", text))),
            stdout=log, stderr=subprocess.STDOUT)
        if ended is None or ended.code == 0:
            return None
        lines = log.read_text().strip().splitlines()[-6:]
        return f"exit code {ended.code}; {log} ends with\n" + "\n".join(
            "    " + line for line in lines)

    def run(scene):
        start, directory = time.monotonic(), options.output / scene
        resume = (directory / "snapshot.h5").exists() and not options.fresh
        failure = execute(scene, scene, "--resume" if resume else "--replace")
        for file in CONTINUED.get(scene, []):
            failure = failure or execute(scene, file, "--resume")
        if processes.stopped:
            return "not run"
        if failure:
            if resume:
                failure += ("\n  To begin this run anew, remove "
                            f"{directory} or use --fresh.")
            say(f"reproduce: {scene} failed: {failure}")
            return failure
        cells = PaperRun(directory).statistics["cells"].iloc[-1]
        say(f"reproduce: {scene}: {cells:,.0f} cells, "
            f"{time.monotonic() - start:.0f} s")
        return None

    found = processes.each(run, scenes, options.jobs)
    return {scene: text for scene, text in zip(scenes, found) if text}
