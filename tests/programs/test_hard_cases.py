# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The engine of the cases notices what is wrong: a program of a few lines
takes Morula's place and misbehaves as it is told to.
"""

from tests.common.program import ProgramTest

from tests.cases.case import Finding, Trial
from tests.cases.execution import Execution

SCENE = "cut-sphere.prm"
FAILED = "At t = 0.5 day: did not converge.\n... --resume"
STATISTICS = ("step,time,newton_iterations,linear_iterations,rejected_steps,"
              "min_elastic_volume_ratio\n0,0,0,0,0,1\n")

# Its first key says what it does.
PROGRAM = '''\
#!/usr/bin/python3
import os, sys, time
keys = dict(word.split("=", 1) for word in sys.argv[1:] if "=" in word)
directory = keys["Output directory"]
statistics = directory + "/statistics.csv"
exec(keys["Do"])
'''
WRITE = ("os.makedirs(directory, exist_ok=True); "
         f"open(statistics, 'w').write({STATISTICS!r}); "
         "open(directory + '/parameters.prm', 'w')"
         ".write('set Dimension = 3')")
SNAPSHOT = "open(directory + '/snapshot.h5', 'w')"
STOP = f"print({FAILED!r}); sys.exit(2)"


class HardCases(ProgramTest):
    def wrong(self, do, **trial):
        """What is wrong with a run of the program."""
        program = self.work / "program"
        if not program.exists():
            program.write_text(PROGRAM)
            program.chmod(0o755)
        execution = Execution(program, self.options.mpiexec, self.work, False)
        trial = Trial("trial", SCENE, keys={"Do": do}, **trial)
        return "\n".join(execution.run("hard/case", trial)[1])

    def assert_wrong(self, text, do, **trial):
        self.assertIn(text, self.wrong(do, **trial))

    def test_in_order(self):
        self.assertEqual(self.wrong(WRITE), "")
        self.assertEqual(
            self.wrong(f"{WRITE}; {SNAPSHOT}; {STOP}", exit=2,
                       message="did not converge"), "")
        self.assertEqual(self.wrong("print('Key = x'); sys.exit(1)", exit=1,
                                    message="Key"), "")
        self.assertEqual(self.wrong(WRITE, exit=(0, 2), message="x"), "")

    def test_exit_codes(self):
        self.assert_wrong("exit code 3, expected 0", "sys.exit(3)")
        self.assert_wrong("exit code -11, expected 0", "os.kill(os.getpid(), 11)")
        self.assert_wrong("no statistics.csv", "pass")
        self.assert_wrong("no end within 1 s", "time.sleep(60)", timeout=1)

    def test_failures(self):
        fails = {"exit": 2, "message": "did not converge"}
        self.assert_wrong("exit code 0, expected 2", WRITE, **fails)
        self.assert_wrong("there is no snapshot", f"{WRITE}; {STOP}", **fails)
        self.assert_wrong("lacks 'inverted'", f"{WRITE}; {SNAPSHOT}; {STOP}",
                          exit=2, message="inverted")
        self.assert_wrong("not say at what time",
                          f"{WRITE}; {SNAPSHOT}; sys.exit(2)", **fails)
        self.assert_wrong("not say how to resume",
                          f"{WRITE}; {SNAPSHOT}; sys.exit(2)", **fails)

    def test_resume(self):
        fails = {"exit": 2, "message": "did not converge"}
        first = f"'--resume' in sys.argv or ({WRITE}, {SNAPSHOT})".replace(
            "; ", ", ")
        self.assert_wrong("--resume ends with exit code 3", f"{first}; "
                          f"'--resume' in sys.argv and sys.exit(3); {STOP}",
                          **fails)
        self.assert_wrong("not gone on from the rows", f"{first}; '--resume' "
                          "in sys.argv and open(statistics, 'w').write('x'); "
                          f"{STOP}", **fails)

    def test_bad_input_writes_nothing(self):
        self.assert_wrong("an output directory was made",
                          f"{WRITE}; print('Key'); sys.exit(1)", exit=1,
                          message="Key")

    def test_numbers(self):
        for number in ("nan", "-nan", "inf", "NaN"):
            row = f"1,1,{number},0,0,1\\n"
            self.assert_wrong("statistics.csv:3 is not finite",
                              f"{WRITE}; open(statistics, 'a').write('{row}')")
        self.assertEqual("", self.wrong(
            f"{WRITE}; open(directory + '/timings.csv', 'w')"
            ".write('section,inf\\nbanana,1\\n')"))

    def test_ranks(self):
        """One rank's run against two that differ in a position."""
        cells = ("open(directory + '/cells-0000.csv', 'w').write('id,parent,"
                 "phase,x,y,z\\n0,-1,9,0,0,' + os.environ.get("
                 "'OMPI_COMM_WORLD_SIZE', '0') + '\\n')")
        one = f"os.environ.get('OMPI_COMM_WORLD_RANK', '0') == '0' or sys.exit"
        do = f"{one}(0); {WRITE}; {cells}"
        self.assert_wrong("cells 2 µm apart", do, ranks=(1, 2))
        self.assertEqual("", self.wrong(do, ranks=(1, 2), agreement=3))

    def test_findings(self):
        self.assertTrue(Finding("x", 1, at_most=1, at_least=1).holds())
        self.assertTrue(Finding("x", 1, equals=(1.1, 0.2)).holds())
        for limits in ({"at_most": 0.9}, {"at_least": 1.1},
                       {"equals": (1.1, 0.05)}):
            self.assertFalse(Finding("x", 1, **limits).holds())
            self.assertFalse(Finding("x", float("nan"), **limits).holds())
        self.assertRaises(ValueError, Finding, "x", 1)
        self.assertRaises(ValueError, Trial, "x", SCENE, exit=2)

    def test_kept(self):
        """A run in order is not repeated, one with another key is."""
        count = "open(directory + '/../count', 'a').write('x')"
        for do, runs in ((f"{WRITE}; {count}", 1), (f"{WRITE}; {count}", 1),
                         (f"{WRITE}; {count};", 2)):
            self.assertEqual(self.wrong(do), "")
            written = (self.work / "quick/hard/case/trial/count").read_text()
            self.assertEqual(len(written), runs)

