# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""How CMake refuses what Morula cannot use, before it compiles anything."""
import re
import shutil
from pathlib import Path

from morula.execute import call
from tests.common.program import TESTS, ProgramTest

ROOT = TESTS.parent


class Requirements(ProgramTest):
    """deal.II's configuration, changed; CMake's word on it, before the first
    file is compiled."""

    def refused(self, name, change, *options, morula_tests="OFF"):
        """What CMake says to a deal.II whose configuration ends in `change`."""
        build = Path(self.options.morula).parent
        cache = (build / "CMakeCache.txt").read_text()
        real = Path(re.search(r"^deal.II_DIR:\w+=(.+)$", cache, re.M)[1])
        folder = self.work / name
        folder.mkdir()
        shutil.copy(real / "deal.IIConfigVersion.cmake", folder)
        text = (real / "deal.IIConfig.cmake").read_text()
        text = text.replace("${CMAKE_CURRENT_LIST_DIR}", str(real))
        (folder / "deal.IIConfig.cmake").write_text(text + change)
        ended = call(
            ["env", "-u", "DEAL_II_DIR", "cmake", "-S", ROOT, "-B",
             folder / "build", f"-Ddeal.II_DIR={folder}",
             f"-DMORULA_TESTS={morula_tests}", *options], cwd=folder)
        self.assertEqual(ended.code, 1, ended.text)
        self.assertFalse((folder / "build/Makefile").exists())
        return " ".join(ended.text.split())

    def test_features(self):
        self.assertIn(
            "Morula needs a deal.II built with LAPACK;",
            self.refused("LAPACK", "set(DEAL_II_WITH_LAPACK OFF)\n"))
        self.assertIn(
            "Morula needs a deal.II with 32-bit indices",
            self.refused("64", "set(DEAL_II_WITH_64BIT_INDICES ON)\n"))

    def test_linker(self):
        self.assertIn(
            "The linker 'absent' is missing",
            self.refused("absent", "set(DEAL_II_LINKER_FLAGS "
                         '"-rdynamic -fuse-ld=absent -Wl,-z,relro")\n'))
        self.assertIn(
            "cannot link an empty program",
            self.refused("wrong", 'set(DEAL_II_LINKER_FLAGS "-Wl,--wrong")\n'))

    def test_packages_of_trilinos(self):
        """A Trilinos without NOX, and so on: links to all headers but those."""
        headers = Path("/usr/include/trilinos")
        if not headers.is_dir():
            self.skipTest("Trilinos does not stand where Debian has it")
        for package in ("Epetra", "EpetraExt", "NOX"):
            poor = self.work / f"trilinos-{package}"
            poor.mkdir()
            for header in headers.iterdir():
                if not re.match(rf"{package}[_.]", header.name):
                    (poor / header.name).symlink_to(header)
            targets = self.work / f"targets-{package}.cmake"
            found = self.refused(package, f"""
get_filename_component(there ${{DEAL_II_TARGET_CONFIG}} DIRECTORY)
file(READ ${{DEAL_II_TARGET_CONFIG}} text)
string(REPLACE "{headers}" "{poor}" text "${{text}}")
string(REPLACE "\\${{CMAKE_CURRENT_LIST_DIR}}" "${{there}}" text "${{text}}")
string(REPLACE "\\${{CMAKE_CURRENT_LIST_FILE}}"
  "${{DEAL_II_TARGET_CONFIG}}" text "${{text}}")
file(WRITE {targets} "${{text}}")
set(DEAL_II_TARGET_CONFIG {targets})
string(REPLACE "{headers}" "{poor}" DEAL_II_INCLUDE_DIRS
  "${{DEAL_II_INCLUDE_DIRS}}")
""")
            self.assertIn(f"Morula needs Trilinos with its package {package};",
                          found)

    def test_other_libraries(self):
        for package, word in (("Boost", "Boost.Program_options 1.74 or later"),
                              ("CGAL", "CGAL 5.5 or later"),
                              ("GTest", "The tests need GoogleTest")):
            self.assertIn(word, self.refused(
                package, "", f"-DCMAKE_DISABLE_FIND_PACKAGE_{package}=ON",
                morula_tests="ON"))
        self.assertIn("deal.II 9.4 or later is missing", self.refused(
            "none", "", "-DCMAKE_DISABLE_FIND_PACKAGE_deal.II=ON"))

