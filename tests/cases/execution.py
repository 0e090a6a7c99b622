# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs of the trials of cases, each in its own directory."""
import shlex
import shutil
import subprocess
from pathlib import Path

from morula.execute import command, overrides

from tests.cases.case import TrialRun
from tests.cases.engine import (different_cells, figures, numbers_missing,
                                wrong_end, wrong_resume)
from tests.common.forks import call
from tests.common.kept import ROOT, digest, files_of_scene, kept, program_stamp
from tests.common.results import Results

HERE = Path(__file__).resolve().parent
JUDGES = [HERE / "engine.py", HERE / "execution.py",
          ROOT / "contrib/python/morula/execute.py",
          ROOT / "tests/common/forks.py"]


class Execution:
    """How trials are run: the program, ctest's size or the full one, where."""

    def __init__(self, morula, mpiexec, output, full):
        self.morula, self.mpiexec, self.full = morula, mpiexec, full
        self.output = output / ("full" if full else "quick")

    def run(self, name, trial):
        """(TrialRun of the first number of ranks, what is wrong as sentences);
        the scenes of the case hard/NAME are those of prm/hard."""
        directory = self.output / name / trial.name
        scene = ROOT / "prm" / name.split("/")[0] / trial.scene
        wrong, first = [], None
        for ranks in trial.ranks:
            run, found = self._on_ranks(trial, scene, ranks, directory)
            where = f"{trial.name} on {ranks} ranks: " if ranks > 1 else \
                f"{trial.name}: "
            if first is None:
                first = run
            elif run.exit == 0 == first.exit:
                found = found + different_cells(first.results, run.results,
                                                trial.agreement)
            wrong += [where + text for text in found]
        return first, wrong

    def _on_ranks(self, trial, scene, ranks, directory):
        """A run is kept, and not repeated, if nothing was wrong with it and
        scene, keys, files, program and checks are what they were."""
        output = directory / f"ranks-{ranks}"
        keys = trial.all_keys(self.full, directory / "files")
        files = write_files(trial, directory / "files")
        origin = {"keys": keys, "program": program_stamp(self.morula),
                  "ranks": ranks, "resume": trial.resume_keys,
                  "expected": [list(trial.exit), trial.message],
                  "files": digest([*files_of_scene(scene), *files, *JUDGES])}
        found = kept(directory / f"ranks-{ranks}.json", origin, lambda:
                     self._execute(trial, scene, keys, ranks, output))
        wrong = found["wrong"]
        if (output / "statistics.csv").is_file():
            results = Results(output)
            run = TrialRun(trial, found["exit"], found["text"], results,
                      figures(results), found["resumed"])
        else:
            run = TrialRun(trial, found["exit"], found["text"], None, None)
            if run.exit in (0, 2):
                wrong = wrong + ["there is no statistics.csv"]
        return run, wrong

    def _command(self, scene, keys, ranks, output, *more):
        return command(self.morula, scene.relative_to(ROOT),
                       *overrides({**keys, "Output directory": output}), *more,
                       ranks=ranks, mpiexec=self.mpiexec)

    def _execute(self, trial, scene, keys, ranks, output):
        shutil.rmtree(output, ignore_errors=True)
        output.parent.mkdir(parents=True, exist_ok=True)
        words = self._command(scene, keys, ranks, output)
        print("  +", shlex.join(words), flush=True)
        try:
            ended = call(words, cwd=ROOT, timeout=trial.timeout)
        except subprocess.TimeoutExpired:
            return {"exit": None, "text": "", "resumed": None,
                    "wrong": [f"no end within {trial.timeout:g} s"]}
        code, text = ended.code, ended.text
        wrong = wrong_end(trial, code, text, output)
        wrong += numbers_missing(output)
        resumed = None
        if code == 2 and (output / "snapshot.h5").is_file():
            resumed, found = self._resume(trial, scene, keys, ranks, output)
            wrong += found
        (output / "snapshot.h5").unlink(missing_ok=True)
        if wrong:
            wrong.append(f"it printed:\n{text[-3000:]}")
        return {"exit": code, "text": text, "resumed": resumed, "wrong": wrong}

    def _resume(self, trial, scene, keys, ranks, output):
        """Resumes a copy of a run; (exit code, what is wrong)."""
        copy = output.parent / (output.name + "-resumed")
        shutil.rmtree(copy, ignore_errors=True)
        shutil.copytree(output, copy)
        words = self._command(scene, {**keys, **trial.resume_keys}, ranks,
                              copy, "--resume")
        before = (copy / "statistics.csv").read_text()
        try:
            ended = call(words, cwd=ROOT, timeout=trial.timeout)
        except subprocess.TimeoutExpired:
            return None, [f"resumed, no end within {trial.timeout:g} s"]
        after = (copy / "statistics.csv").read_text()
        code = ended.code
        wrong = wrong_resume(code, ended.text, before, after)
        wrong += ["resumed: " + found for found in numbers_missing(copy)]
        shutil.rmtree(copy)
        return code, wrong


def write_files(trial, directory):
    """Writes the files of a trial; returns their paths."""
    found = []
    for name, text in trial.files.items():
        directory.mkdir(parents=True, exist_ok=True)
        text = text() if callable(text) else text
        file = directory / name
        if not file.is_file() or file.read_text() != text:
            file.write_text(text)
        found.append(file)
    return found
