# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A screen for VTK where there is none."""
import os
import shutil
import subprocess
import sys
from contextlib import contextmanager

# Where a virtual screen may be. As it starts, Open MPI looks for graphics cards
# on the displays 0 to 9, in mpiexec, too, and the server that ends just then
# ends the program that looks.
DISPLAYS = range(99, 199)


def require_virtual_screen():
    """Ends the program if there can be none."""
    if not shutil.which("Xvfb"):
        sys.exit("Drawing: Xvfb is missing; contrib/setup installs it.")


def server_for(number):
    """An X server for a display; None if another process has it."""
    reading, writing = os.pipe()
    # The server must not reset when its last client leaves: VTK comes and goes
    # several times.
    server = subprocess.Popen(["Xvfb", f":{number}", "-displayfd", str(writing), "-screen", "0",
                               "640x480x24", "-nolisten", "tcp", "-noreset"], pass_fds=[writing],
                              stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL)
    os.close(writing)
    with os.fdopen(reading) as pipe:
        if pipe.readline().strip():
            return server
    server.wait()
    return None


@contextmanager
def virtual_screen():
    """While it lasts, this process and those that it starts draw on a screen of their own: VTK's
    OpenGL needs an X server, and a virtual one gives equal pictures everywhere."""
    require_virtual_screen()
    for number in DISPLAYS:
        server = server_for(number)
        if server:
            break
    else:
        sys.exit("Drawing: Xvfb did not start.")
    before = {**os.environ}
    os.environ["DISPLAY"] = f":{number}"
    os.environ.pop("XAUTHORITY", None)
    try:
        yield
    finally:
        os.environ.clear()
        os.environ.update(before)
        server.terminate()
        server.wait()
