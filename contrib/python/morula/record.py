# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What is known of a run: whether it finished, and what it cost."""
import json
import shutil
from pathlib import Path

from .files import write
from .run import Run


class Record:
    """The directory of one run: run.json, the program's output, its words."""

    def __init__(self, directory):
        self.directory = Path(directory)
        self.file = self.directory / "run.json"
        self.output = self.directory / "output"
        self.identity, self.overrides, self.cost = None, (), None

    def load(self, identity):
        """Takes over what a former run has left, even if it was interrupted; false if there is
        none, or if it was one of another program or scene."""
        try:
            stored = json.loads(self.file.read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return False
        if stored.get("identity") != identity:
            return False
        self.identity, self.cost = identity, stored.get("cost")
        self.overrides = tuple(map(tuple, stored["overrides"]))
        return True

    def begin(self, identity, overrides):
        """Forgets what was there."""
        shutil.rmtree(self.directory, ignore_errors=True)
        self.directory.mkdir(parents=True)
        self.identity, self.overrides, self.cost = identity, overrides, None
        self._store()

    @property
    def resumable(self):
        """Whether an execution that did not end has left a snapshot. The
        program replaces it as a whole."""
        return ((self.killed or self.cost is None) and (self.output / "snapshot.h5").is_file())

    def resume(self):
        """The execution that did not end goes on."""
        self.cost = None

    def add(self, cost, ranks, jobs, keep):
        """An execution, with what measure.py says of it; files that are not in `keep` go."""
        cost.update(ranks=ranks, jobs=jobs)
        if cost["exit"] == 0:
            if "snapshot" not in keep:
                (self.output / "snapshot.h5").unlink(missing_ok=True)
            for kind in {"cells", "surface"} - set(keep):
                for file in self.output.glob(f"{kind}-[0-9]*.csv"):
                    file.unlink()
        self.cost = cost
        self._store()

    def _store(self):
        stored = {"identity": self.identity, "overrides": self.overrides, "cost": self.cost}
        write(self.file, json.dumps(stored, indent=1))

    @property
    def exit(self):
        """The exit code, or None."""
        return self.cost and self.cost["exit"]

    @property
    def finished(self):
        return self.exit == 0

    @property
    def failed(self):
        return self.exit not in (0, None)

    @property
    def refused(self):
        """The program did not accept what it was to do."""
        return self.exit == 1

    @property
    def killed(self):
        """Failed for a reason that is not the program's own (1 and 2)."""
        return self.exit not in (0, 1, 2, None)

    @property
    def run(self):
        """What the last execution has written, read anew."""
        return Run(self.output)

    @property
    def processor_seconds(self):
        """That all ranks together have computed; other work prolongs it less than the wall time."""
        return self.cost["processor_seconds"]

    @property
    def process_seconds(self):
        """Wall time of the whole process, start and end of MPI, output and all, seconds."""
        return self.cost["process_seconds"]

    @property
    def peak_bytes(self):
        """Peak resident memory: that of the largest rank times the ranks."""
        return self.cost["peak_bytes"] * self.cost["ranks"]

    def summary(self):
        if self.finished:
            return (f"{self.process_seconds:.1f} s"
                    + (" since it was resumed" if self.cost.get("resumed") else ""))
        if self.cost is None:
            return "interrupted"
        return f"failed with exit code {self.exit}: {self.last_words()}"

    def last_words(self):
        """The last line that a failed run wrote to stderr."""
        file = self.directory / "stderr"
        lines = file.read_text(errors="replace").split("\n") if (file.is_file()) else []
        words = [line.strip() for line in lines if line.strip()]
        own = [line for line in words if line.startswith("morula")]
        return (own or words or ["it said nothing"])[-1]
