# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""One version everywhere; and the commit that --version names, of a clone, of
a release, and of sources without git (contrib/cmake/version.cmake).
"""
import re
import shutil

from tests.common.program import TESTS, ProgramTest
from upkeep.version_data import version

ROOT = TESTS.parent


class Version(ProgramTest):
    def setUp(self):
        super().setUp()
        self.tree = self.work / "tree"
        (self.tree / "source/base").mkdir(parents=True)
        shutil.copy(ROOT / "source/base/version.cc.in", self.tree / "source/base")

    def git(self, *words):
        self.run_words(["git", "-C", self.tree, "-c", "user.name=A", "-c",
                        "user.email=a@b", *words])

    def commit(self):
        """What the file says that is written in a build of the tree."""
        file = self.work / "version.cc"
        self.run_words(["cmake", f"-Dsource={self.tree}", "-Dnumber=1.2.3",
                        f"-Doutput={file}", "-P",
                        ROOT / "contrib/cmake/version.cmake"])
        text = file.read_text()
        self.assertIn('return "1.2.3";', text)
        return re.search(r'commit = "(.*)"', text)[1]

    def test_commit(self):
        self.assertEqual(self.commit(), "")  # sources without git
        self.git("init", "-q")
        self.assertEqual(self.commit(), "")  # a clone without a commit
        self.git("add", ".")
        self.git("commit", "-qm", "One")
        self.assertRegex(self.commit(), "^[0-9a-f]{10}$")
        self.git("tag", "v1.2.3")
        self.assertEqual(self.commit(), "")  # the release itself
        self.git("commit", "-qm", "Two", "--allow-empty")
        self.assertRegex(self.commit(), "^v1.2.3-1-g[0-9a-f]{10}$")
        with (self.tree / "source/base/version.cc.in").open("a") as file:
            file.write("\n")
        self.assertRegex(self.commit(), "^v1.2.3-1-g[0-9a-f]{10}-dirty$")

    def test_nothing_is_compiled_for_the_same_version(self):
        self.commit()
        file = self.work / "version.cc"
        before = file.stat().st_mtime_ns
        self.commit()
        self.assertEqual(file.stat().st_mtime_ns, before)

    def test_the_program(self):
        said = self.run_words([self.options.morula, "--version"]).stdout
        self.assertRegex(said, rf"^Morula {re.escape(version())}"
                         r"( \((v[0-9.]+(-\d+-g[0-9a-f]{10,})?|[0-9a-f]{10,})"
                         r"(-dirty)?\))? with deal\.II [0-9.]+\n$")

    def test_one_version_everywhere(self):
        for name, pattern in (
                ("CITATION.cff", r"^version: (\S+)$"),
                ("CHANGES.md", r"^## (\S+)$"),
                ("contrib/python/pyproject.toml", r'^version = "(.*)"$'),
                ("contrib/packaging/spack/packages/morula/package.py",
                 r'version\("(.*?)"'),
                ("contrib/packaging/conda/meta.yaml", r'version = "(.*)"'),
                ("doc/install.md", r"morula_([0-9.]+)_amd64\.deb")):
            with self.subTest(name):
                text = (ROOT / name).read_text(encoding="utf-8")
                self.assertEqual(re.search(pattern, text, re.M)[1], version())
        text = (ROOT / "contrib/example-project/CMakeLists.txt").read_text()
        self.assertEqual(re.search(r"find_package\(Morula ([0-9.]+)", text)[1],
                         version().rpartition(".")[0])

