# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Morula for Spack, from a clone: doc/install.md says how."""
from spack.package import *


class Morula(CMakePackage):
    """Growth and proliferation of tissues with continuum-based cell particles."""

    license("GPL-3.0-or-later")

    version("0.3.0", preferred=True)
    has_code = False  # until releases have an address: spack develop gives the tree

    variant("tools", default=True,
            description="Python packages of the tools (report, render, export ...)")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.16:", type="build")
    # What contrib/cmake/requirements.cmake asks for, which deal.II's recipe leaves
    # open.
    depends_on("dealii@9.4: +mpi +p4est +hdf5 +muparser +trilinos ~int64 cxxstd=17")
    depends_on("trilinos +nox")
    depends_on("suite-sparse")
    depends_on("boost@1.74: +program_options")
    depends_on("cgal@5.5:")
    depends_on("gmp")
    depends_on("mpfr")
    depends_on("random123", type="build")

    with when("+tools"):
        depends_on("python@3.11:", type="run")
        for library in ("h5py", "jinja2", "matplotlib", "numpy", "pandas", "pillow",
                        "scikit-image", "scipy", "tifffile", "zarr"):
            depends_on(f"py-{library}", type="run")
        depends_on("vtk@9: +python", type="run")

    def cmake_args(self):
        return [self.define("MORULA_TESTS", False), self.define("MORULA_UNITY", True),
                self.define("DEAL_II_DIR", self.spec["dealii"].prefix),
                self.define("RANDOM123_INCLUDE_DIR", self.spec["random123"].prefix.include)]
