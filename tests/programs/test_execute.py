# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""morula.execute: what it starts ends as a whole, and nothing is lost of what
it says, takes and returns."""
import json
import os
import subprocess
import sys
import threading
import time
from pathlib import Path

from morula.execute import (ENVIRONMENT, Processes, call, command, end,
                            overrides)
from tests.common.program import ProgramTest

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


class Execute(ProgramTest):
    def parent(self, name):
        file = self.work / name
        return [sys.executable, "-c", PARENT, file], file

    def number_in(self, file):
        until = time.monotonic() + 60
        while not (file.is_file() and file.read_text().endswith("\n")):
            self.assertLess(time.monotonic(), until)
            time.sleep(0.01)
        return int(file.read_text())

    def test_words(self):
        self.assertEqual(
            command("morula", Path("a.prm"), *overrides({"A/B c": 0.5}),
                    ranks=3, mpiexec="mpirun"),
            ["mpirun", "-n", "3", "morula", "a.prm", "-s", "A/B c=0.5"])
        self.assertEqual(overrides([("A", 1), ("A", 2)]),
                         ["-s", "A=1", "-s", "A=2"])

    def test_result(self):
        script = ("import os, sys; print(os.environ['OMP_NUM_THREADS'], "
                  "os.environ['MORE'], sys.stdin.read() == ''); "
                  "print('error', file=sys.stderr); sys.exit(3)")
        found = call([sys.executable, "-c", script], env={"MORE": "x"})
        self.assertEqual((found.code, found.stdout, found.stderr),
                         (3, "1 x True\n", "error\n"))
        self.assertEqual(found.text, "1 x True\nerror\n")
        self.assertEqual(ENVIRONMENT["OMPI_MCA_rmaps_base_oversubscribe"], "1")
        log = self.work / "log"
        found = call([sys.executable, "-c", script], env={"MORE": "x"},
                     stdout=log, stderr=subprocess.STDOUT)
        self.assertEqual((found.code, found.text), (3, ""))
        self.assertEqual(sorted(log.read_text().splitlines()),
                         ["1 x True", "error"])

    def test_cost(self):
        """20 MB more are 20 MB more, and a signal is told as one."""
        peaks = []
        for size in (1, 20):
            cost = self.work / f"{size}.json"
            found = call([sys.executable, "-c", f"x = b'a' * {size}000000"],
                         cost=cost)
            self.assertEqual(found.code, 0)
            peaks.append(json.loads(cost.read_text())["peak_bytes"])
        self.assertLess(abs(peaks[1] - peaks[0] - 19e6), 3e6)
        call([sys.executable, "-c", "import os; os.kill(os.getpid(), 9)"],
             cost=cost)
        self.assertEqual(json.loads(cost.read_text())["exit"], -9)

    def test_timeout_ends_children_too(self):
        words, file = self.parent("late")
        with self.assertRaises(subprocess.TimeoutExpired):
            call(words, timeout=5)
        self.assertFalse(running(self.number_in(file)))

    def test_stop(self):
        """Whoever waits gets None; nothing is started any more."""
        processes, found = Processes(), []
        words, file = self.parent("stopped")
        thread = threading.Thread(
            target=lambda: found.append(processes.call(words)))
        thread.start()
        number = self.number_in(file)
        processes.stop()
        thread.join(60)
        self.assertEqual(found, [None])
        self.assertFalse(running(number))
        self.assertIsNone(processes.call(["true"]))

    def test_each(self):
        """Results in order; where one throws, the others end."""
        self.assertEqual(Processes().each(lambda x: x * x, range(5), 3),
                         [0, 1, 4, 9, 16])
        words, file = self.parent("other")
        processes = Processes()

        def work(item):
            if item == "throws":
                self.number_in(file)
                raise LookupError
            return processes.call(words)

        with self.assertRaises(LookupError):
            processes.each(work, ["throws", "waits"], 2)
        self.assertFalse(running(self.number_in(file)))

    def test_patience(self):
        """A process that does not mind being asked is killed."""
        script = ("import signal, time; "
                  "signal.signal(signal.SIGTERM, signal.SIG_IGN); "
                  "print('ready', flush=True); time.sleep(600)")
        with subprocess.Popen([sys.executable, "-c", script],
                              stdout=subprocess.PIPE,
                              start_new_session=True) as child:
            child.stdout.readline()
            end([child], 0.2)
            self.assertEqual(child.wait(10), -9)
