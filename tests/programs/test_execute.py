# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""morula.execute: what it starts ends as a whole, and nothing is lost of what it
says, takes and returns."""
import json
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
from morula.execute import (ENVIRONMENT, Processes, call, command, end,
                            overrides)

# Starts another process, writes its id, and waits for it.
PARENT = """import subprocess, sys
child = subprocess.Popen(["sleep", "600"])
open(sys.argv[1], "w").write(f"{child.pid}\\n")
child.wait()
"""


def running(number):
    """Whether a process is there and is no zombie."""
    try:
        state = Path(f"/proc/{number}/stat").read_text().rpartition(")")[2]
    except OSError:
        return False
    return state.split()[0] != "Z"


def python(script, *words):
    return [sys.executable, "-c", script, *words]


def number_in(file):
    until = time.monotonic() + 60
    while not (file.is_file() and file.read_text().endswith("\n")):
        assert time.monotonic() < until
        time.sleep(0.01)
    return int(file.read_text())


def test_words():
    assert command("morula", Path("a.prm"), *overrides({"A/B c": 0.5}), ranks=3,
                   mpiexec="mpirun") == [
        "mpirun", "-n", "3", "morula", "a.prm", "-s", "A/B c=0.5"]
    assert overrides([("A", 1), ("A", 2)]) == ["-s", "A=1", "-s", "A=2"]


def test_result(tmp_path):
    words = python("import os, sys; print(os.environ['OMP_NUM_THREADS'], "
                   "os.environ['MORE'], sys.stdin.read() == ''); "
                   "print('error', file=sys.stderr); sys.exit(3)")
    found = call(words, env={"MORE": "x"})
    assert (found.code, found.stdout, found.stderr) == (3, "1 x True\n", "error\n")
    assert found.text == "1 x True\nerror\n"
    assert ENVIRONMENT["OMPI_MCA_rmaps_base_oversubscribe"] == "1"
    log = tmp_path / "log"
    found = call(words, env={"MORE": "x"}, stdout=log, stderr=subprocess.STDOUT)
    assert (found.code, found.text) == (3, "")
    assert sorted(log.read_text().splitlines()) == ["1 x True", "error"]


def test_cost(tmp_path):
    """20 MB more are 20 MB more, and a signal is told as one."""
    def cost_of(script):
        call(python(script), cost=tmp_path / "cost.json")
        return json.loads((tmp_path / "cost.json").read_text())

    small, large = (cost_of(f"x = b'a' * {size}000000") for size in (1, 20))
    assert (small["exit"], large["exit"]) == (0, 0)
    assert abs(large["peak_bytes"] - small["peak_bytes"] - 19e6) < 3e6
    assert cost_of("import os; os.kill(os.getpid(), 9)")["exit"] == -9


def test_timeout_ends_children_too(tmp_path):
    with pytest.raises(subprocess.TimeoutExpired):
        call(python(PARENT, tmp_path / "late"), timeout=5)
    assert not running(number_in(tmp_path / "late"))


def test_stop(tmp_path):
    """Whoever waits gets None; nothing is started any more."""
    processes, found = Processes(), []
    thread = threading.Thread(target=lambda: found.append(
        processes.call(python(PARENT, tmp_path / "stopped"))))
    thread.start()
    number = number_in(tmp_path / "stopped")
    processes.stop()
    thread.join(60)
    assert found == [None] and not running(number)
    assert processes.call(["true"]) is None


def test_each(tmp_path):
    """Results in order; where one throws, the others end."""
    assert Processes().each(lambda x: x * x, range(5), 3) == [0, 1, 4, 9, 16]
    processes, file = Processes(), tmp_path / "other"

    def work(item):
        if item == "throws":
            number_in(file)
            raise LookupError
        return processes.call(python(PARENT, file))

    with pytest.raises(LookupError):
        processes.each(work, ["throws", "waits"], 2)
    assert not running(number_in(file))


def test_patience():
    """A process that does not mind being asked is killed."""
    script = ("import signal, time; "
              "signal.signal(signal.SIGTERM, signal.SIG_IGN); "
              "print('ready', flush=True); time.sleep(600)")
    with subprocess.Popen(python(script), stdout=subprocess.PIPE,
                          start_new_session=True) as child:
        child.stdout.readline()
        end([child], 0.2)
        assert child.wait(10) == -9
