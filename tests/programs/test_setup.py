# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What contrib/setup asks for, of a pretended package manager, a list of installed
packages; and what contrib/build and contrib/check call."""
import os
import shutil

import pytest
from morula.execute import call
from tests.common.program import TESTS

pytestmark = pytest.mark.release
CONTRIB = TESTS.parent / "contrib"
PROGRAMS = {
    "dpkg-query": """if [ "$1" = --listfiles ]; then
  grep -qx "$2" packages && echo "$PWD/deal.IIConfig.cmake"
  exit
fi
sed 's/$/ installed/' packages""",
    "apt-get": """[ "$1" = install ] || exit 0
echo "${@:4}" >>calls
printf '%s\\n' "${@:4}" >>packages
if [ "${*:4}" = mold ]; then cp "$0" bin/ld.mold; fi""",
    "apt-cache": "true",
    "sudo": '"$@"',
    **{name: 'echo "${0##*/} $*" >>"${0%/*}/../calls"' for name in ("cmake", "ctest", "ninja")}}


@pytest.fixture
def machine(tmp_path):
    """Calls a command of contrib there; what the programs were called with."""
    for folder in ("bin", "contrib", "build"):
        (tmp_path / folder).mkdir()
    for name, text in PROGRAMS.items():
        file = tmp_path / "bin" / name
        file.write_text(f"#!/bin/bash\n{text}\n")
        file.chmod(0o755)
    (tmp_path / "deal.IIConfig.cmake").write_text(
        'set(DEAL_II_LINKER_FLAGS "-rdynamic -fuse-ld=mold -Wl,-z")\n')
    for name in ("setup", "build", "check"):
        shutil.copy(CONTRIB / name, tmp_path / "contrib")

    def run(*words):
        (tmp_path / "calls").write_text("")
        ended = call(["env", "-u", "DEAL_II_DIR", "-u", "CI",
                      f"PATH={tmp_path}/bin:{os.environ['PATH']}", *words], cwd=tmp_path)
        assert ended.code == 0, ended.text
        return (tmp_path / "calls").read_text().splitlines()

    run.packages = tmp_path / "packages"
    run.packages.write_text("python3-paraview\n")
    return run


def test_setup(machine):
    """Each package once; deal.II's linker is known when deal.II is there, and ParaView's
    Python, which conflicts with python3-vtk9, is left alone."""
    first, linker = machine("contrib/setup", "program")
    assert "libdeal.ii-dev" in first and "libgtest-dev" not in first
    assert linker == "mold"
    rest, = machine("contrib/setup")
    assert "python3-pytest" in rest and "python3-scipy" in rest
    assert not {"libdeal.ii-dev", "python3-vtk9", "clang-format-19"} & set(rest.split())
    assert machine("contrib/setup") == []


def test_build_and_check(machine):
    """With what is built, what is set up, and which tests are run."""
    first, _, configure, _ = machine("contrib/build", "morula")
    assert "libdeal.ii-dev" in first and "-DMORULA_TESTS=OFF" in configure
    configure, _ = machine("DEAL_II_DIR=/somewhere", "contrib/build")
    assert "-DMORULA_TESTS=ON" in configure
    for words, chosen in (([], ["-LE release"]), (["--quick", "-R", "x"], ["-L quick -R x"]),
                          (["--release"], [])):
        *_, tests = machine("DEAL_II_DIR=/somewhere", "contrib/check", *words)
        assert tests.startswith("ctest ") and tests.split(" ", 4)[4:] == chosen
