# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs the scenes with the program: once each, going on where one stopped."""
import subprocess
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

from morula.program import environment

from .run_results import Run

# Scenes that are resumed with a further one.
CONTINUED = {"fig-4b": ["fig-4b-picture"]}


@dataclass
class Runner:
    """How scenes are run; `overrides` are KEY=VALUE for every one of them."""

    morula: Path
    scenes: Path
    output: Path
    overrides: list = field(default_factory=list)
    fresh: bool = False
    say: callable = print

    def __post_init__(self):
        self.environment = environment()
        self.lock = threading.Lock()
        self.processes = []
        self.stopped = False

    def directory(self, scene):
        return self.output / scene

    def execute(self, scene, file, *arguments):
        """One call of the program; returns None or what went wrong."""
        words = [str(self.morula), str(self.scenes / f"{file}.prm"),
                 *(word for text in (
                     f"Output directory={self.directory(scene)}",
                     *self.overrides) for word in ("-s", text)), *arguments]
        log = self.output / "log" / f"{file}.txt"
        log.parent.mkdir(parents=True, exist_ok=True)
        with log.open("w") as stream:
            with self.lock:
                if self.stopped:
                    return "not run"
                process = subprocess.Popen(
                    words, env=self.environment, stdin=subprocess.DEVNULL,
                    stdout=stream, stderr=subprocess.STDOUT)
                self.processes.append(process)
            code = process.wait()
        if code == 0:
            return None
        lines = log.read_text().strip().splitlines()[-6:]
        return f"exit code {code}; {log} ends with\n" + "\n".join(
            "    " + line for line in lines)

    def run(self, scene):
        """Brings one scene to its end; returns None or what went wrong. A
        finished run is left as it is: the program itself sees that."""
        start = time.monotonic()
        there = (self.directory(scene) / "snapshot.h5").exists()
        resume = there and not self.fresh
        failure = self.execute(scene, scene,
                               "--resume" if resume else "--replace")
        for file in CONTINUED.get(scene, []):
            failure = failure or self.execute(scene, file, "--resume")
        if failure and self.stopped:
            return failure
        if failure:
            if resume:
                failure += ("\n  To begin this run anew, remove "
                            f"{self.directory(scene)} or use --fresh.")
            self.say(f"reproduce: {scene} failed: {failure}")
            return failure
        cells = Run(self.directory(scene)).statistics["cells"][-1]
        self.say(f"reproduce: {scene}: {cells:,.0f} cells, "
                 f"{time.monotonic() - start:.0f} s")
        return None

    def stop(self):
        """Ends the runs under way; they can be resumed."""
        with self.lock:
            self.stopped = True
            for process in self.processes:
                if process.poll() is None:
                    process.terminate()

    def run_all(self, scenes, jobs):
        """Runs the scenes, so many at a time; {scene: what went wrong}."""
        pool = ThreadPoolExecutor(max_workers=jobs)
        futures = {scene: pool.submit(self.run, scene) for scene in scenes}
        try:
            results = {scene: future.result()
                       for scene, future in futures.items()}
        except BaseException:
            self.stop()
            pool.shutdown(cancel_futures=True)
            raise
        pool.shutdown()
        return {scene: text for scene, text in results.items() if text}
