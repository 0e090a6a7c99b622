# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What contrib/setup asks for, and when contrib/build calls it.

The package manager is a pretended one: a list of installed packages.
"""
import os
import re
import shutil

from morula.execute import call
from tests.common.program import TESTS, ProgramTest

ROOT = TESTS.parent
SETUP = ROOT / "contrib/setup"

DPKG_QUERY = """#!/bin/bash
if [ "$1" = --listfiles ]; then
  grep -qx "$2" "$PACKAGES" && echo "$CONFIG/deal.IIConfig.cmake"
  exit
fi
for package; do
  grep -qx "$package" "$PACKAGES" && echo "$package installed"
done
exit 1
"""
# Installs everything, and tells it; `ld.mold` with mold.
APT_GET = """#!/bin/bash
[ "$1" = install ] || exit 0
echo "${@:4}" >>"$ASKED"
for package in "${@:4}"; do
  echo "$package" >>"$PACKAGES"
  if [ "$package" = mold ]; then cp "$0" "$(dirname "$0")/ld.mold"; fi
done
"""
TOOLS = ("bash", "cat", "cp", "dirname", "env", "grep", "id", "mktemp", "rm",
         "sed", "sudo", "tail")


class Setup(ProgramTest):
    def setUp(self):
        super().setUp()
        self.bin = self.work / "bin"
        self.bin.mkdir()
        for tool in TOOLS:
            if shutil.which(tool):
                (self.bin / tool).symlink_to(shutil.which(tool))
        self.packages = self.write("packages", "")
        self.write("deal.IIConfig.cmake",
                   'set(DEAL_II_LINKER_FLAGS "-rdynamic -fuse-ld=mold -Wl,-z")\n'
                   'SET(DEAL_II_LINKER_FLAGS_DEBUG "-ggdb")\n')

    def pretend(self, name, text):
        self.write(f"bin/{name}", text).chmod(0o755)

    def debian(self, *installed, clang_format=True):
        self.packages.write_text("".join(f"{name}\n" for name in installed))
        self.pretend("dpkg-query", DPKG_QUERY)
        self.pretend("apt-get", APT_GET)
        self.pretend("sudo", '#!/bin/bash\nexec "$@"\n')
        self.pretend("apt-cache", "#!/bin/bash\n"
                     + ("echo Package: $3\n" if clang_format else ""))

    def setup(self, *words, code=0):
        """What it prints, and the packages that it asks for, call by call."""
        asked = self.work / "asked"
        asked.unlink(missing_ok=True)
        ended = call(
            ["env", "-i", f"PATH={self.bin}", f"PACKAGES={self.packages}",
             f"ASKED={asked}", f"CONFIG={self.work}", f"TMPDIR={self.work}",
             self.bin / "bash", SETUP, *words], cwd=self.work)
        text = ended.text
        self.assertEqual(ended.code, code, text)
        calls = asked.read_text().splitlines() if asked.exists() else []
        return text, [line.split() for line in calls]

    def test_linker_of_deal_ii(self):
        """Known only when deal.II is there: a second call asks for it."""
        self.debian()
        _, (first, second) = self.setup("program")
        self.assertIn("libdeal.ii-dev", first)
        self.assertEqual(second, ["mold"])
        self.assertEqual(self.setup("program")[1], [])
        (self.bin / "ld.mold").unlink()
        self.assertEqual(self.setup("program")[1], [["mold"]])

    def test_program_alone(self):
        self.debian()
        _, calls = self.setup("program")
        for package in ("libgtest-dev", "python3-vtk9", "chromium"):
            self.assertNotIn(package, calls[0])
        _, (rest,) = self.setup()
        for package in ("libgtest-dev", "python3-vtk9", "chromium"):
            self.assertIn(package, rest)
        self.assertNotIn("libdeal.ii-dev", rest)
        self.assertEqual(self.setup()[1], [])
        self.assertIn("'programme' is unknown",
                      self.setup("programme", code=1)[0])

    def test_paraview_is_left_alone(self):
        """Its Python conflicts with python3-vtk9, and does the same."""
        self.debian("python3-paraview")
        _, calls = self.setup()
        self.assertNotIn("python3-vtk9", calls[0])
        self.assertIn("python3-scipy", calls[0])

    def test_formatter_that_the_release_lacks(self):
        self.debian(clang_format=False)
        _, calls = self.setup()
        self.assertNotIn("clang-format-19", calls[0])
        self.assertEqual(self.setup()[1], [])

    def test_format_without_the_formatter(self):
        """A word, and no failure of all the other checks."""
        words = ["env", "-i", f"PATH={self.bin}", self.bin / "bash",
                 ROOT / "contrib/upkeep/indent"]
        for version, found in ((None, "none"), (14, "14")):
            if version:
                self.pretend("clang-format", "#!/bin/bash\n"
                             f"echo Debian clang-format version {version}.0\n")
            ended = call([*words, "--check"], cwd=self.work)
            self.assertEqual(ended.code, 0, ended.text)
            self.assertIn(f"clang-format 19 is missing (found: {found})",
                          ended.text)
            self.assertEqual(call(words, cwd=self.work).code, 1)

    def test_other_systems(self):
        text, _ = self.setup(code=1)
        self.assertIn("this is not a Debian system", text)
        self.assertIn("DEAL_II_DIR=", text)


class Build(ProgramTest):
    """contrib/build in a tree of its own, with a CMake that only notes what it
    is told."""

    def setUp(self):
        super().setUp()
        for folder in ("contrib", "bin", "build"):
            (self.work / folder).mkdir()
        shutil.copy(ROOT / "contrib/build", self.work / "contrib")
        note = '#!/bin/bash\necho "${0##*/} $*" >>"$CALLS"\n'
        for name in ("contrib/setup", "bin/cmake"):
            self.write(name, note).chmod(0o755)

    def calls(self, target, **environment):
        calls = self.work / "calls"
        calls.write_text("")
        ended = call(
            ["env", "-u", "DEAL_II_DIR", f"CALLS={calls}",
             f"PATH={self.work / 'bin'}:{os.environ['PATH']}",
             *(f"{key}={value}" for key, value in environment.items()),
             self.work / "contrib/build", target], cwd=self.work)
        self.assertEqual(ended.code, 0, ended.text)
        first, *rest = calls.read_text().splitlines()
        configure = next(line for line in [first, *rest] if " -S " in line)
        return first, re.search("-DMORULA_TESTS=(ON|OFF)", configure)[1]

    def test_what_is_set_up(self):
        self.assertEqual(self.calls("morula"), ("setup program", "OFF"))
        self.assertEqual(self.calls("all"), ("setup ", "ON"))
        self.assertEqual(self.calls("half-fixed-sphere"), ("setup ", "ON"))
        self.write("build/CMakeCache.txt", "MORULA_TESTS:BOOL=ON\n")
        self.assertEqual(self.calls("morula"), ("setup program", "ON"))

    def test_check(self):
        """What is built and tried, quickly or all; ctest's exit code."""
        shutil.copy(ROOT / "contrib/check", self.work / "contrib")
        note = '#!/bin/bash\necho "${0##*/} $*" >>"$CALLS"\n'
        self.write("contrib/build", note).chmod(0o755)
        self.write("bin/ctest", note + "exit $FAILED\n").chmod(0o755)
        for words, chosen, failed in (([], "", 0), (["--quick"], "-L quick", 0),
                                      (["--quick", "-R", "grid"],
                                       "-L quick -R grid", 8)):
            calls = self.write("calls", "")
            ended = call(["env", "-u", "CI", f"CALLS={calls}", f"FAILED={failed}",
                          f"PATH={self.work / 'bin'}:{os.environ['PATH']}",
                          self.work / "contrib/check", *words], cwd=self.work)
            self.assertEqual(ended.code, failed, ended.text)
            self.assertRegex(ended.text, r"check: \d+ processor seconds")
            build, ctest = calls.read_text().splitlines()
            self.assertEqual(build, "build all -DMORULA_TESTS=ON")
            self.assertRegex(ctest, rf"^ctest --output-on-failure --parallel \d+ ?"
                             rf"{chosen}$")

    def test_with_a_deal_ii_of_ones_own(self):
        for target in ("morula", "all"):
            first, _ = self.calls(target, DEAL_II_DIR="/somewhere")
            self.assertTrue(first.startswith("cmake -S"), first)

