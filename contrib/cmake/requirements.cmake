# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors

# What Morula needs of deal.II and of the machine, checked before anything is
# compiled: a missing header would show only after minutes, a missing linker at
# the very end.

include(CheckCXXSourceCompiles)

# Whether the source compiles, or links. A failure is not kept: what is missing
# may have been installed when CMake runs again.
macro(morula_check source result)
  set(CMAKE_REQUIRED_QUIET TRUE)
  check_cxx_source_compiles("${source}" ${result})
  if(NOT ${result})
    unset(${result} CACHE)
  endif()
endmacro()

set(cure "On Debian and Ubuntu, contrib/setup installs a good one; for other \
systems see doc/install.md.")

foreach(feature MPI P4EST TRILINOS HDF5 MUPARSER LAPACK UMFPACK)
  if(NOT DEAL_II_WITH_${feature})
    message(FATAL_ERROR
      "Morula needs a deal.II built with ${feature}; the one in "
      "${DEAL_II_PATH} is not. ${cure}")
  endif()
endforeach()

# The programs are linked with deal.II's own flags, which may ask for a linker
# that deal.II's packages do not bring with them (mold, in Debian 13).
set(flags "${DEAL_II_LINKER_FLAGS}")
separate_arguments(CMAKE_REQUIRED_LINK_OPTIONS UNIX_COMMAND "${flags}")
morula_check("int main() { return 0; }" MORULA_LINKS_WITH_FLAGS_OF_DEAL_II)
unset(CMAKE_REQUIRED_LINK_OPTIONS)
if(NOT MORULA_LINKS_WITH_FLAGS_OF_DEAL_II)
  if(flags MATCHES "-fuse-ld=([^ ]+)")
    message(FATAL_ERROR
      "The linker '${CMAKE_MATCH_1}' is missing, or the compiler "
      "${CMAKE_CXX_COMPILER} does not know it: deal.II's flags ask for it "
      "(${flags}). Install it (Debian and Ubuntu: apt-get install "
      "${CMAKE_MATCH_1}; contrib/setup does so).")
  endif()
  message(FATAL_ERROR
    "The compiler ${CMAKE_CXX_COMPILER} cannot link an empty program with "
    "deal.II's flags (${flags}). Take the compiler that deal.II was built "
    "with, by -DCMAKE_CXX_COMPILER=..., in an empty build directory.")
endif()

# A Trilinos that satisfies deal.II may lack NOX. The header alone is looked for.
include(${DEAL_II_TARGET_CONFIG})
set(DEAL_II_TARGET_CONFIG_INCLUDED TRUE)
set(CMAKE_REQUIRED_INCLUDES ${DEAL_II_INCLUDE_DIRS})
foreach(target dealii::interface_trilinos dealii::interface_mpi)
  if(TARGET ${target})
    list(APPEND CMAKE_REQUIRED_LIBRARIES ${target})
  endif()
endforeach()
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
morula_check("#if !__has_include(<NOX_Solver_Generic.H>)\n#error missing\n#endif\n"
  MORULA_HAS_NOX)
if(NOT MORULA_HAS_NOX)
  message(FATAL_ERROR
    "Morula needs Trilinos with its package NOX; deal.II in ${DEAL_II_PATH} "
    "was built with one that lacks it (there is no NOX_Solver_Generic.H). "
    "${cure}")
endif()
unset(CMAKE_TRY_COMPILE_TARGET_TYPE)
unset(CMAKE_REQUIRED_INCLUDES)
unset(CMAKE_REQUIRED_LIBRARIES)

# Ends where something is missing, with Debian's packages of it, and what to set.
function(morula_require found what packages place)
  if(NOT ${found})
    message(FATAL_ERROR "${what} is missing (Debian and Ubuntu: apt-get install "
      "${packages}; contrib/setup does so). If it stands elsewhere, set ${place}.")
  endif()
endfunction()

set(CGAL_DO_NOT_WARN_ABOUT_CMAKE_BUILD_TYPE TRUE)
find_package(Boost 1.74 QUIET COMPONENTS program_options)
morula_require(Boost_FOUND "Boost.Program_options 1.74 or later"
  libboost-program-options-dev Boost_ROOT)
# deal.II brings muParser with it, as a library of its own or bundled.
find_path(MUPARSER_INCLUDE_DIR muParser.h
  HINTS ${DEAL_II_INCLUDE_DIRS}
  PATH_SUFFIXES deal.II/bundled/muparser deal.II/bundled)
morula_require(MUPARSER_INCLUDE_DIR "muParser's header muParser.h" libmuparser-dev
  MUPARSER_INCLUDE_DIR)
find_path(RANDOM123_INCLUDE_DIR Random123/philox.h)
morula_require(RANDOM123_INCLUDE_DIR Random123 librandom123-dev RANDOM123_INCLUDE_DIR)
find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse)
find_library(CHOLMOD_LIBRARY cholmod)
foreach(part CHOLMOD_INCLUDE_DIR CHOLMOD_LIBRARY)
  morula_require(${part} "CHOLMOD of SuiteSparse" libsuitesparse-dev ${part})
endforeach()
find_package(CGAL 5.5 QUIET)
morula_require(CGAL_FOUND "CGAL 5.5 or later, or its GMP or MPFR,"
  "libcgal-dev libgmp-dev libmpfr-dev" CGAL_DIR)
if(MORULA_TESTS)
  find_package(GTest QUIET)
  if(NOT TARGET GTest::gtest)
    message(FATAL_ERROR
      "The tests need GoogleTest (Debian: libgtest-dev; contrib/setup installs "
      "it). If it stands elsewhere, set GTest_ROOT; without the tests, set "
      "MORULA_TESTS=OFF.")
  endif()
endif()
