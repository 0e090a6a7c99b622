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
        self.identity, self.overrides, self.repeats = None, (), []

    def load(self, identity):
        """Takes over what a former run has left, even if it was interrupted; false if there is
        none, or if it was one of another program or scene."""
        try:
            stored = json.loads(self.file.read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return False
        if stored.get("identity") != identity:
            return False
        self.identity, self.repeats = identity, stored["repeats"]
        self.overrides = tuple(map(tuple, stored["overrides"]))
        return True

    def begin(self, identity, overrides):
        """Forgets what was there."""
        shutil.rmtree(self.directory, ignore_errors=True)
        self.directory.mkdir(parents=True)
        self.identity, self.overrides, self.repeats = identity, overrides, []
        self._store()

    @property
    def resumable(self):
        """Whether an execution that did not end has left a snapshot. The
        program replaces it as a whole."""
        return ((self.killed or not self.repeats) and (self.output / "snapshot.h5").is_file())

    def resume(self):
        """The execution that did not end goes on."""
        self.repeats = []

    def add(self, cost, ranks, jobs, keep):
        """One more execution, with what launcher.py says of it. The row times are kept for each,
        because the files are those of the last one; of these, what is not in `keep` goes."""
        cost.update(ranks=ranks, jobs=jobs)
        if cost["exit"] == 0:
            cost["row_seconds"] = self._computing_seconds()
            if "snapshot" not in keep:
                (self.output / "snapshot.h5").unlink(missing_ok=True)
            for kind in {"cells", "surface"} - set(keep):
                for file in self.output.glob(f"{kind}-[0-9]*.csv"):
                    file.unlink()
        self.repeats.append(cost)
        self._store()

    def _store(self):
        stored = {"identity": self.identity, "overrides": self.overrides, "repeats": self.repeats}
        write(self.file, json.dumps(stored, indent=1))

    def _computing_seconds(self):
        """Wall time from the start to each row of statistics.csv, less the writing of cells and
        surface before it, which takes about equally long each time. On a busy machine one file can
        take far longer than the others: a tenth of the wall time is left at least."""
        run = self.run
        spent = run.timings["wall_seconds"].get("output", 0.0)
        return [float(max(seconds - spent * sum(run.times < time)
                          / max(1, len(run.times)), 0.1 * seconds))
                for time, seconds in zip(run.statistics["time"],
                                         run.statistics["wall_seconds"])]

    @property
    def finished(self):
        return bool(self.repeats) and all(r["exit"] == 0 for r in self.repeats)

    @property
    def failed(self):
        return any(r["exit"] != 0 for r in self.repeats)

    @property
    def refused(self):
        """The program did not accept what it was to do."""
        return any(r["exit"] == 1 for r in self.repeats)

    @property
    def killed(self):
        """Failed for a reason that is not the program's own (1 and 2)."""
        return any(r["exit"] not in (0, 1, 2) for r in self.repeats)

    @property
    def run(self):
        """What the last execution has written, read anew."""
        return Run(self.output)

    def row_seconds(self, row):
        """Least wall time from the start to the end of a step, without the
        writing of cells and surface, seconds."""
        return min(repeat["row_seconds"][row] for repeat in self.repeats)

    @property
    def process_seconds(self):
        """Least wall time of the whole process, start and end of MPI, output and all, seconds."""
        return min(repeat["process_seconds"] for repeat in self.repeats)

    @property
    def peak_bytes(self):
        """Peak resident memory: that of the largest rank times the ranks."""
        return max(r["peak_bytes"] * r["ranks"] for r in self.repeats)

    def summary(self):
        if self.finished:
            resumed = any(r.get("resumed") for r in self.repeats)
            return (f"{self.process_seconds:.1f} s" + (" since it was resumed" if resumed else ""))
        if not self.repeats:
            return "interrupted"
        return (f"failed with exit code {self.repeats[-1]['exit']}: " f"{self.last_words()}")

    def last_words(self):
        """The last line that a failed run wrote to stderr."""
        file = self.directory / "stderr"
        lines = file.read_text(errors="replace").split("\n") if (file.is_file()) else []
        words = [line.strip() for line in lines if line.strip()]
        own = [line for line in words if line.startswith("morula")]
        return (own or words or ["it said nothing"])[-1]
