# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Whose directory it is: runs that would be lost are refused, two runs at once
are refused, files that vanish under a run are noticed.
"""
import os
import re
import shutil
import signal
import socket
import subprocess
import time

import pytest

from tests.common.program import TESTS, overrides

SCENE = TESTS / "programs/small-cube.prm"
SHORT = overrides({"Time/End time": "0.25"})
FINE = overrides({"Time/Step": 1 / 32, "Output/Snapshot interval": 1 / 8})
PATIENCE = 300  # s, for a machine that has other things to do


@pytest.fixture
def output(fresh):
    """Where runs write if they are not told otherwise."""
    return fresh.work / "output"


def content(output):
    return {path: path.read_bytes() for path in output.rglob("*") if path.is_file()}


def check_refused(runs, scene, *arguments, texts, ranks=1):
    """Exit code 1, one message with these texts, and nothing touched."""
    output = runs.work / "output"
    before = content(output)
    result = runs.execute(scene, *arguments, ranks=ranks, code=1)
    for text in (f"Output directory = '{output}': allowed is ", *texts):
        assert text in result.stderr
    assert result.stderr.count("morula: ") == 1
    assert result.stdout == ""
    assert before == content(output)


@pytest.fixture
def start(fresh, output):
    """Starts a run that stands still behind a row of statistics.csv."""
    started = []

    def begin(*arguments, row=2):
        process = subprocess.Popen(
            fresh.command(SCENE, "-s", f"Output directory={output}", *FINE, *arguments),
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        started.append(process)
        statistics, deadline = output / "statistics.csv", time.monotonic() + PATIENCE
        while not statistics.exists() or statistics.read_bytes().count(b"\n") < row + 2:
            assert process.poll() is None, "ended too early"
            assert time.monotonic() < deadline
            time.sleep(0.001)
        process.send_signal(signal.SIGSTOP)
        os.waitpid(process.pid, os.WUNTRACED)  # all of its threads stand still
        return process

    yield begin
    for process in started:
        kill(process)
        process.stderr.close()


def end(process, code=0):
    process.send_signal(signal.SIGCONT)
    said = process.communicate(timeout=PATIENCE)[1]
    assert process.returncode == code, said
    return said


def kill(process):
    process.kill()
    process.wait()


def copied(runs, name):
    """The same scene as another file."""
    (runs.work / name).parent.mkdir(exist_ok=True)
    return shutil.copy(SCENE, runs.work / name)


@pytest.mark.parametrize("name", ["bud", "fig-4e-0.95"])
def test_default_is_named_after_the_scene(fresh, output, name):
    copied(fresh, f"{name}.prm")
    # an empty value is the default, as --parameters prints it
    for more in ((), overrides({"Output directory": ""})):
        fresh.call([fresh.options.morula, f"{name}.prm", *SHORT, *more], cwd=fresh.work)
    keys = (output / name / "parameters.prm").read_text()
    assert re.search(f"set Output directory *= output/{name}\n", keys)
    printed = fresh.call([fresh.options.morula, "--parameters"]).stdout
    assert re.search(r"(?m)^set Output directory *= *$", printed)


def test_a_finished_run_is_repeated(fresh, output):
    """By the same scene file, also with other overrides, and by its own
    parameters.prm."""
    lineage = output / "lineage.csv"
    fresh.execute(SCENE, *SHORT)
    first = lineage.read_bytes()
    fresh.execute(SCENE, *SHORT, *overrides({"Tissue/Cell spacing": "15"}))
    assert first != lineage.read_bytes()
    fresh.execute(output / "parameters.prm", *overrides({"Tissue/Cell spacing": "12"}))
    assert first == lineage.read_bytes()
    fresh.execute(SCENE, *SHORT)
    # in a tree that was moved, too
    fresh.execute(copied(fresh, "here/cube.prm"), *SHORT, output=fresh.work / "here/run")
    (fresh.work / "here").rename(fresh.work / "there")
    fresh.execute(fresh.work / "there/cube.prm", *SHORT, output=fresh.work / "there/run")


def test_another_scenes_run_is_kept(fresh, output):
    other = copied(fresh, "other.prm")
    fresh.execute(other, *SHORT)
    mine = [output / "notes.txt", output / "cells-0000.png"]
    for file in mine:
        file.write_text("mine\n")
    for ranks in (1, 2):
        check_refused(fresh, SCENE, *SHORT, ranks=ranks, texts=(
            "there is one of another scene, '../other.prm'", "--replace deletes it"))
    # of the same name, elsewhere
    check_refused(fresh, copied(fresh, "elsewhere/other.prm"), *SHORT, texts=("'../other.prm'",))
    before = set(content(output))
    fresh.execute(SCENE, *SHORT, "--replace")
    assert before == set(content(output))
    assert [file.read_text() for file in mine] == ["mine\n"] * 2
    fresh.execute(SCENE, *SHORT)


def test_an_unfinished_run_is_kept(fresh, output, start):
    kill(start(row=6))
    lock = output / "morula.lock"
    assert lock.exists()  # and is held by nobody any more
    check_refused(fresh, SCENE, *FINE, texts=(
        "there is one that is not finished", "--resume goes on with it", "--replace deletes it"))
    fresh.execute(SCENE, *FINE, "--resume")
    assert not lock.exists()
    fresh.execute(SCENE, *FINE)
    # one that has failed
    fresh.execute(SCENE, *overrides({
        "Growth/Law": "isotropic",
        "Growth/Isotropic/Stretch": "if (t > 0.2 && t < 0.3, log(-1), 1)"}), code=2)
    check_refused(fresh, SCENE, *SHORT, texts=("not finished",))
    fresh.execute(SCENE, *SHORT, "--replace")


def test_an_unfinished_run_without_snapshot(fresh, output, start):
    kill(start(row=1))
    assert not (output / "snapshot.h5").exists()
    check_refused(fresh, SCENE, *FINE, texts=(
        "there is one that is not finished", "no snapshot to go on from", "--replace deletes it"))
    said = fresh.execute(SCENE, *FINE, "--resume", code=1).stderr
    assert "with --replace if there are files of it" in said
    fresh.execute(SCENE, *FINE, "--replace")


def test_a_long_run_is_kept(fresh, output):
    fresh.execute(SCENE, *SHORT)
    file = output / "parameters.prm"
    text, n = re.subn("(# state: finished after ).* s\n", r"\g<1>3700 s\n", file.read_text())
    assert n > 0
    file.write_text(text)
    check_refused(fresh, SCENE, *SHORT, texts=(
        "there is one that took 1 h 01 min", "--replace deletes it"))
    fresh.execute(SCENE, *SHORT, "--replace")


def test_files_of_no_run_are_never_deleted(fresh, output):
    output.mkdir()
    log = output / "log.txt"
    log.write_text("my own log\n")
    for arguments in ((), ("--replace",)):
        check_refused(fresh, SCENE, *SHORT, *arguments, texts=(
            "there is 'log.txt', but no parameters.prm of such a run", "Move such files"))
    log.unlink()
    fresh.execute(SCENE, *SHORT)


def test_two_at_once(fresh, output, start):
    process = start()
    holder = (f"process {process.pid} on {socket.gethostname()}", "Wait for its end")
    for arguments, ranks in (((), 1), (("--replace",), 2), (("--resume",), 1)):
        check_refused(fresh, SCENE, *FINE, *arguments, texts=holder, ranks=ranks)
    end(process)
    fresh.execute(SCENE, *FINE, output=fresh.work / "alone")
    assert ((output / "lineage.csv").read_bytes()
            == (fresh.work / "alone/lineage.csv").read_bytes())


def test_two_resumed_at_once(fresh, output, start):
    kill(start(row=6))
    process = start("--resume", row=10)
    check_refused(fresh, SCENE, *FINE, "--resume", texts=(
        f"process {process.pid} on {socket.gethostname()}",))
    end(process)
    assert "morula.lock" not in os.listdir(output)


@pytest.mark.parametrize("name", ["statistics.csv", "lineage.csv"])
def test_tables_that_vanish(output, start, name):
    process = start()
    (output / name).unlink()
    said = end(process, code=2)
    assert f"{name}' was deleted or replaced while the run went on" in said
    assert "At t = " in said


def test_a_directory_that_vanishes(output, start):
    process = start()
    shutil.rmtree(output)
    said = end(process, code=2)
    # which file notices it first depends on where the run stood still, and
    # whether the background had put the first output in its place
    assert re.search(r"(statistics|lineage)\.csv' was deleted or replaced while the run went on"
                     r"|cannot (open|replace) the file '.*/\w+-0000\.\w+(\.tmp)?': No such file",
                     said)
    assert not output.exists()


def test_colon(fresh):
    """MPI-IO takes what stands before a colon for a file system."""
    place = fresh.work / "run-12:30"
    for ranks in (1, 2):
        fresh.execute(SCENE, *SHORT, "--replace", ranks=ranks, output=place)
        assert (place / "snapshot.h5").exists()
    fresh.execute(SCENE, *overrides({"Time/End time": 0.5}), "--resume", output=place)


def test_events_of_an_old_run(fresh, output):
    """A new run keeps no table that its own scene does not write."""
    fresh.execute(SCENE, *SHORT)
    (output / "events.csv").write_text("time,cell,event\n")
    fresh.execute(SCENE, *SHORT)
    assert not (output / "events.csv").exists()


def test_either_resume_or_replace(fresh, output):
    result = fresh.execute(SCENE, "--resume", "--replace", code=1)
    assert "leave one of the two out" in result.stderr
    assert not output.exists()


def test_temporary_files(fresh):
    """Two runs at once without mpiexec leave nothing behind: MPI starts no
    daemon for them, which would make directories. Open MPI 5 leaves
    directories without files, whatever it is told."""
    temporary = fresh.work / "tmp"
    temporary.mkdir()
    runs = [subprocess.Popen(
        fresh.command(SCENE, "-s", f"Output directory={fresh.work / name}", *SHORT),
        env={**os.environ, "TMPDIR": str(temporary)}, stdout=subprocess.DEVNULL)
        for name in ("one", "other")]
    assert [run.wait(PATIENCE) for run in runs] == [0, 0]
    version = subprocess.run(["ompi_info", "--version"], check=True, capture_output=True,
                             text=True).stdout
    left = [path for path in temporary.rglob("*")
            if "Open MPI v5" not in version or not path.is_dir()]
    assert left == []
