# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A screen for VTK where there is none."""
import os
import shutil
import subprocess
import sys
from contextlib import contextmanager

VARIABLE = "MORULA_VIRTUAL_SCREEN"

# Where a virtual screen may be. As it starts, Open MPI looks for graphics cards
# on the displays 0 to 9, in mpiexec, too, and the server that ends just then
# ends the program that looks.
DISPLAYS = range(99, 199)


def on_virtual_screen():
    """Whether this process draws on a screen of run_on_virtual_screen()."""
    return VARIABLE in os.environ


def require_virtual_screen():
    """Ends the program if there can be none."""
    if not shutil.which("Xvfb"):
        sys.exit("Drawing: Xvfb is missing; contrib/setup installs it.")


@contextmanager
def virtual_screen(number):
    """An X server for a display; whether it runs, as another may have it."""
    reading, writing = os.pipe()
    # The server must not reset when its last client leaves: VTK comes and goes
    # several times.
    with subprocess.Popen(
            ["Xvfb", f":{number}", "-displayfd", str(writing), "-screen", "0",
             "640x480x24", "-nolisten", "tcp", "-noreset"],
            pass_fds=[writing], stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as server:
        try:
            os.close(writing)
            with os.fdopen(reading) as pipe:
                runs = bool(pipe.readline().strip())
            yield runs
        finally:
            server.terminate()


def run_on_virtual_screen(command):
    """Runs a command with a virtual screen as its display and returns its
    exit code: VTK's OpenGL needs an X server, and a virtual one gives equal
    pictures everywhere."""
    require_virtual_screen()
    for number in DISPLAYS:
        with virtual_screen(number) as runs:
            if runs:
                environment = {**os.environ, "DISPLAY": f":{number}",
                               VARIABLE: str(number)}
                environment.pop("XAUTHORITY", None)
                return subprocess.call(command, env=environment)
    sys.exit("Drawing: Xvfb did not start.")
