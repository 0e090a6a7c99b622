# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What `cmake --install` makes: whole, movable, and found by CMake in programs of
another build type; what such a program lacks is said.
"""
import os
import shutil

from tests.common.program import TESTS, ProgramTest

from tests.common.installation import EXAMPLE, Installation

ROOT = TESTS.parent


class Install(Installation, ProgramTest):
    def project(self, name, text, *files):
        """A project that needs Morula, with a CMakeLists.txt of this text."""
        folder = self.work / name
        folder.mkdir()
        for file in files:
            shutil.copy(file, folder)
        (folder / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.16)\n" + text)
        return folder

    def test_files(self):
        """All that is promised, and nothing that names this tree. Programs
        with debug information name it, for the debugger."""
        prefix = self.install(self.work / "prefix")
        files = {file.relative_to(prefix).as_posix(): file.read_bytes()
                 for file in prefix.rglob("*") if file.is_file()}
        for header in (ROOT / "include").rglob("*.h"):
            name = header.relative_to(ROOT).as_posix()
            self.assertIn(name, files)
        for file in EXAMPLE.iterdir():
            if file.is_file():
                self.assertIn(f"share/morula/example-project/{file.name}",
                              files)
        for file in ("bin/morula", "lib/libmorula.a", "share/morula/LICENSE",
                     "share/morula/prm/demo.prm",
                     "share/morula/prm/paper/fig-4b.prm",
                     "share/doc/morula/copyright",
                     "share/doc/morula/doc/parameters.md",
                     "lib/cmake/Morula/MorulaConfig.cmake",
                     "lib/cmake/Morula/MorulaConfigVersion.cmake",
                     "lib/cmake/Morula/MorulaTargets.cmake"):
            self.assertIn(file, files)
        for file in (prefix / "bin").iterdir():
            self.assertIn(f"share/man/man1/{file.name}.1", files)
            self.assertIn(f"share/bash-completion/completions/{file.name}", files)
        self.assertEqual({name.split("/")[0] for name in files},
                         {"bin", "include", "lib", "share"})
        debug = "CMAKE_BUILD_TYPE:STRING=Debug" in (
            self.build / "CMakeCache.txt").read_text()
        for name, data in files.items():
            if debug and name in ("bin/morula", "lib/libmorula.a"):
                continue
            for place in (ROOT, self.build, prefix):
                self.assertNotIn(os.fsencode(place), data, name)

    def test_program_and_scenes(self):
        """The program runs from a place to which it was moved."""
        self.install(self.work / "prefix")
        moved = self.work / "moved"
        (self.work / "prefix").rename(moved)
        morula = moved / "bin/morula"
        self.assertRegex(self.call(morula, "--version"), r"^Morula \d")
        scenes = sorted((moved / "share/morula/prm").rglob("*.prm"))
        self.assertGreater(len(scenes), 10)
        for scene in scenes:
            self.call(morula, scene, "--explain")
        text = self.call(morula, scenes[0], "-s", "Time/End time=0.2",
                         "-s", "Tissue/Radius=60", "-s", "Grid/Spacing=30",
                         "-s", "Time/Step=0.1", "-s", "Output/Formats=none")
        self.assertIn("Finished: End time reached", text)

    def test_tools(self):
        """They find their modules, and the program beside them; what they make
        stands where they are called, as root alone may write to share/."""
        self.install(self.work / "prefix")
        moved = self.work / "moved"
        (self.work / "prefix").rename(moved)
        tools = moved / "bin"
        before = sorted(file for file in moved.rglob("*")
                        if "__pycache__" not in file.parts)
        scene = TESTS / "programs/small-cube.prm"
        self.call(tools / "morula-sweep", scene, "--seeds", "1-2",
                  "--vary", "Grid/Spacing=35,40", "-s", "Time/End time=0.125")
        self.assertTrue((self.work / "output/sweep/small-cube").is_dir())
        self.call(tools / "morula-accuracy", scene, "--vary",
                  "Grid/Spacing=60,50,40", "--measure", "total_volume",
                  "-s", "Time/End time=0.125", "--output", self.work / "cost")
        self.assertIn("Grid/Spacing", (self.work / "cost/table.md").read_text())
        package = self.call(moved / "share/morula/python/launch", "-c",
                            "import morula.run; print(morula.__file__)")
        self.assertEqual(package.strip(), str(
            moved / "share/morula/python/morula/__init__.py"))
        run = self.work / "run"
        self.call(tools / "morula", scene, "-s", "Time/End time=0.125",
                  "-s", f"Output directory={run}")
        self.call(tools / "morula-cell-shapes", run)
        self.call(tools / "morula-render", run, "--output",
                  self.work / "cells.png")
        self.assertTrue((self.work / "cells.png").is_file())
        self.call(tools / "morula-report", run, "--states", "0")
        self.assertIn("</html>", (run / "report.html").read_text())
        self.assertEqual(before, sorted(
            file for file in moved.rglob("*")
            if "__pycache__" not in file.parts))

    def test_all_headers_in_debug_mode(self):
        """A program that includes all headers, with warnings as errors, in
        another build type than the library's."""
        prefix = self.install(self.work / "prefix")
        include = prefix / "include"
        # Kernels are included by own_material.h, with what they ask for.
        headers = [file.relative_to(include).as_posix()
                   for file in sorted(include.rglob("*.h"))
                   if file.parent.name != "kernels"]
        source = self.write("all.cc", "".join(
            f"#include <{header}>\n" for header in headers) +
            "int main(int argc, char *argv[])\n"
            "{ return Morula::Program().run(argc, argv); }\n")
        folder = self.project(
            "headers", "project(headers LANGUAGES CXX)\n"
            "find_package(Morula REQUIRED)\nadd_executable(headers all.cc)\n"
            "target_compile_options(headers PRIVATE -Werror)\n"
            "target_link_libraries(headers Morula::morula)\n", source)
        release = "CMAKE_BUILD_TYPE:STRING=Release" in (
            self.build / "CMakeCache.txt").read_text()
        other = "Debug" if release else "Release"
        text = self.configure(folder, prefix, f"-DCMAKE_BUILD_TYPE={other}")
        self.assertRegex(" ".join(text.split()),
                         rf"Morula was built as .* whatever CMAKE_BUILD_TYPE \({other}\)")
        self.compile(folder)
        self.assertIn("Morula", self.call(folder / "build/headers", "--version"))
        self.call(folder / "build/headers", TESTS / "programs/small-cube.prm",
                  "-s", f"Output directory={self.work / 'output'}")

    def test_what_is_missing_is_said(self):
        prefix = self.install(self.work / "prefix")
        project = "project(none LANGUAGES CXX)\n"
        find = "find_package(Morula REQUIRED)\n"
        off = "set(CMAKE_DISABLE_FIND_PACKAGE_%s ON)\n"
        for name, text, said in (
                ("deal.II", project + off % "deal.II" + find,
                 "built with deal.II 9.* Set DEAL_II_DIR"),
                ("Boost", project + off % "Boost" + find,
                 "program_options is not found .* libboost-program-options-dev"),
                ("MPFR", project + "set(CMAKE_FIND_LIBRARY_PREFIXES no)\n" +
                 find, "needs the library mpfr.* libmpfr-dev"),
                ("order", find + project, "call project.* before"),
                ("version", project + "find_package(Morula 99 REQUIRED)\n",
                 'compatible with requested version "99"')):
            with self.subTest(name):
                folder = self.project(name, text)
                printed = self.configure(folder, prefix, code=1)
                self.assertRegex(" ".join(printed.split()), said)

