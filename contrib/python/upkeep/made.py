# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""With what figures are made: the day, the commit, the program, the machine."""
import datetime
import subprocess
from pathlib import Path

from morula.execute import cores
from morula.program import Program

# What figures depend on, for git.
MEASURED = ("CMakeLists.txt", "contrib", "include", "prm", "source", "tests")


def made_with(root, morula=None):
    """In a sentence; morula: the executable, by default that of the build."""
    program = Program(morula or root / "build/morula")
    today = datetime.date.today().isoformat()
    return (f"{today}: {commit(root)}, {program.version}, {processor()}, "
            f"{cores()} cores")


def commit(root):
    """The commit of a tree, and whether what is measured differs from it."""
    try:
        short = git(root, "rev-parse", "--short", "HEAD")
        changed = git(root, "status", "--porcelain", "--", *MEASURED)
    except (OSError, subprocess.CalledProcessError):
        return "unknown commit"
    return f"commit {short}" + (" with changes" if changed else "")


def git(root, *words):
    return subprocess.run(["git", "-C", root, *words], check=True, text=True,
                          stdout=subprocess.PIPE,
                          stderr=subprocess.DEVNULL).stdout.strip()


def processor():
    for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            return line.split(":")[1].strip()
    return "unknown processor"
