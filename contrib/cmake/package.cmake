# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors

# What CPack needs to make a Debian package of all that is installed;
# contrib/upkeep/package calls it. It fits the release that it was built on: dpkg
# finds the libraries of the program there. What the library, the example project and
# the tools need besides is recommended, which apt installs unless told not to.

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME morula)
set(MORULA_PACKAGE_CONTACT "The Morula authors <morula@example.org>" CACHE STRING
    "Name and mail address of whoever makes Debian packages for others")
mark_as_advanced(MORULA_PACKAGE_CONTACT)
set(CPACK_PACKAGE_CONTACT "${MORULA_PACKAGE_CONTACT}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY
  "growth and proliferation of tissues with continuum-based cell particles")
set(CPACK_PACKAGE_DESCRIPTION
"Morula computes how tissues grow: cells are particles of a continuum that
divides and deforms, and the equilibrium of the whole is found by extended
B-splines. This package has the program, its tools, its library with an example
project, scenes and pages.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/package_files.cmake)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS mpi-default-bin)

set(recommended
  python3 python3-numpy python3-scipy python3-pandas python3-jinja2
  python3-matplotlib python3-pil python3-skimage python3-tifffile python3-h5py
  python3-zarr xvfb
  "python3-vtk9 | python3-paraview" libjs-three
  libdeal.ii-dev cmake make g++ libcgal-dev libgmp-dev libmpfr-dev
  libboost-program-options-dev)
if(DEAL_II_LINKER_FLAGS MATCHES "-fuse-ld=(mold|lld)") # others come with g++
  list(APPEND recommended ${CMAKE_MATCH_1})
endif()
list(JOIN recommended ", " CPACK_DEBIAN_PACKAGE_RECOMMENDS)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS paraview)
include(CPack)
