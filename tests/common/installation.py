# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""For tests of what is installed, and of programs that are built with it."""
from pathlib import Path

from morula.execute import call

from tests.common.kept import ROOT

EXAMPLE = ROOT / "contrib/example-project"


class Installation:
    """What a ProgramTest needs besides: a home of its own, and CMake."""

    def setUp(self):
        super().setUp()
        self.build = Path(self.options.morula).parent
        self.home = self.work / "home"
        self.home.mkdir()

    def call(self, *words, cwd=None, code=0):
        """What a command prints, with a home of its own, and without this
        tree's packages for Python."""
        ended = call(["env", "-u", "PYTHONPATH", f"HOME={self.home}", *words],
                     cwd=cwd or self.work)
        self.assertEqual(ended.code, code,
                         f"{' '.join(map(str, words))}\n{ended.text}")
        return ended.text

    def install(self, prefix):
        self.call("cmake", "--install", self.build, "--prefix", prefix)
        return prefix

    def configure(self, source, prefix, *options, code=0):
        return self.call("cmake", "-S", source, "-B", source / "build",
                         f"-DCMAKE_PREFIX_PATH={prefix}", *options, code=code)

    def compile(self, source):
        return self.call("cmake", "--build", source / "build")
