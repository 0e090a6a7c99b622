# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""How CMake refuses what Morula cannot use, before it compiles anything: a deal.II whose
configuration is changed, and libraries that are not found. And a Trilinos without Epetra."""
import json
import re
import shlex
import shutil
from pathlib import Path

import pytest
from morula.execute import call
from tests.common.program import TESTS

pytestmark = pytest.mark.release


@pytest.mark.parametrize("change, message", (
    ("set(DEAL_II_WITH_LAPACK OFF)", "needs a deal.II built with LAPACK;"),
    ('set(DEAL_II_LINKER_FLAGS "-fuse-ld=absent -Wl,-z,relro")', "linker 'absent' is missing"),
    ('set(DEAL_II_LINKER_FLAGS "-Wl,--wrong")', "cannot link an empty program"),
    ("set(DEAL_II_TARGET_CONFIG /dev/null)\nset(DEAL_II_INCLUDE_DIRS /none)",
     "needs Trilinos with its package NOX;"),
    ("set(CMAKE_DISABLE_FIND_PACKAGE_Boost ON)", "Boost.Program_options 1.74 or later"),
    ("set(CMAKE_DISABLE_FIND_PACKAGE_CGAL ON)", "CGAL 5.5 or later"),
    ("set(CMAKE_DISABLE_FIND_PACKAGE_GTest ON)", "The tests need GoogleTest")))
def test_refusal(runs, tmp_path, change, message):
    cache = (Path(runs.options.morula).parent / "CMakeCache.txt").read_text()
    real = Path(re.search(r"^deal.II_DIR:\w+=(.+)$", cache, re.M)[1])
    shutil.copy(real / "deal.IIConfigVersion.cmake", tmp_path)
    text = (real / "deal.IIConfig.cmake").read_text()
    text = text.replace("${CMAKE_CURRENT_LIST_DIR}", str(real))
    (tmp_path / "deal.IIConfig.cmake").write_text(f"{text}\n{change}\n")
    ended = call(["env", "-u", "DEAL_II_DIR", "cmake", "-S", TESTS.parent, "-B",
                  tmp_path / "build", f"-Ddeal.II_DIR={tmp_path}", "-DMORULA_TESTS=ON"])
    assert ended.code == 1, ended.text
    assert message in " ".join(ended.text.split())
    assert not (tmp_path / "build/Makefile").exists()


def test_without_epetra(runs):
    """All sources compile where Trilinos has no Epetra, nor what stands on it, and deal.II none of
    its classes: their headers are errors, as releases since Trilinos 17 do without."""
    hidden, build = runs.work / "hidden", runs.work / "build"
    ended = call(["cmake", "-S", TESTS.parent, "-B", build, "-DMORULA_TESTS=OFF",
                  "-DMORULA_PRECOMPILED_HEADERS=OFF", "-DMORULA_UNITY=ON",
                  "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON"])
    assert ended.code == 0, ended.text
    commands = [shlex.split(one["command"])
                for one in json.loads((build / "compile_commands.json").read_text())]
    (hidden / "deal.II/base").mkdir(parents=True)
    (hidden / "deal.II/base/config.h").write_text(
        "#include_next <deal.II/base/config.h>\n#undef DEAL_II_WITH_TRILINOS\n")
    headers = [file.name for folder in {*commands[0]} for file in Path(folder).glob("*.[hH]*")
               if re.match("(NOX_)?Epetra|Amesos_|AztecOO|Ifpack_|ml_", file.name)]
    assert "Epetra_Map.h" in headers
    for name in headers:
        (hidden / name).write_text("#error hidden\n")
    for compiler, *words in commands:
        ended = call([compiler, "-I", hidden, *words, "-O0", "-fsyntax-only"], cwd=build)
        assert ended.code == 0, ended.text
