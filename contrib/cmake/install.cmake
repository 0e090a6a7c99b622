# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors

# What `cmake --install` puts below its prefix: the program, the tools that work
# on scenes and runs, the library with its headers and the package that
# find_package(Morula) reads, scenes to start from, the step programs with their
# sources, a project to start one's own effects from, and the pages. Nothing of it
# names the build or the source directory, and the whole may be moved.

if(MORULA_SANITIZE)
  install(CODE "message(FATAL_ERROR \"Not installed: this build finds memory \
errors (MORULA_SANITIZE), and programs that link with it would not. Install \
one without.\")")
  return()
endif()

# Step programs and tests are not built for it.
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY TRUE)

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package_directory ${CMAKE_INSTALL_LIBDIR}/cmake/Morula)
set(share_directory ${CMAKE_INSTALL_DATADIR}/morula)

# A deal.II that stands in no system directory is found by its path.
if(NOT DEAL_II_PATH MATCHES "^/usr/?$")
  set_target_properties(morula PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON)
endif()
install(TARGETS morula RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})

set_target_properties(morula_lib PROPERTIES EXPORT_NAME morula)
install(TARGETS morula_lib EXPORT MorulaTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/morula
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  FILES_MATCHING PATTERN "*.h")

# The package. Programs get the flavour of deal.II that the library has.
if(CMAKE_BUILD_TYPE STREQUAL "Debug")
  set(flavour DEBUG)
else()
  set(flavour RELEASE)
endif()
set(deal_ii_version
  ${DEAL_II_VERSION_MAJOR}.${DEAL_II_VERSION_MINOR}.${DEAL_II_VERSION_SUBMINOR})
install(EXPORT MorulaTargets NAMESPACE Morula::
  DESTINATION ${package_directory})
configure_package_config_file(
  ${CMAKE_CURRENT_LIST_DIR}/MorulaConfig.cmake.in
  ${PROJECT_BINARY_DIR}/MorulaConfig.cmake
  INSTALL_DESTINATION ${package_directory}
  NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(
  ${PROJECT_BINARY_DIR}/MorulaConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/MorulaConfig.cmake
  ${PROJECT_BINARY_DIR}/MorulaConfigVersion.cmake
  DESTINATION ${package_directory})

install(DIRECTORY ${PROJECT_SOURCE_DIR}/prm DESTINATION ${share_directory}
  PATTERN hard EXCLUDE
  PATTERN showcase EXCLUDE
  PATTERN verification EXCLUDE)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/source/steps
  DESTINATION ${share_directory})
install(FILES ${PROJECT_SOURCE_DIR}/doc/data/half-fixed-sphere.csv
  DESTINATION ${share_directory}/doc/data)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/contrib/example-project
  DESTINATION ${share_directory}
  PATTERN build EXCLUDE
  PATTERN output EXCLUDE)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/CITATION.cff
  DESTINATION ${share_directory})

# The Python package, and for each tool of it a script: morula-report calls the
# launcher beside the package, as contrib/report does in this tree.
set(python_directory ${share_directory}/python)
install(PROGRAMS ${PROJECT_SOURCE_DIR}/contrib/python/launch
  DESTINATION ${python_directory})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/contrib/python/morula
  DESTINATION ${python_directory}
  PATTERN __pycache__ EXCLUDE)
file(RELATIVE_PATH launch
  ${CMAKE_INSTALL_FULL_BINDIR}
  ${CMAKE_INSTALL_FULL_DATADIR}/morula/python/launch)
foreach(tool accuracy cell-shapes export import render report sweep)
  configure_file(${CMAKE_CURRENT_LIST_DIR}/tool.in
    ${PROJECT_BINARY_DIR}/tools/morula-${tool} @ONLY)
  install(PROGRAMS ${PROJECT_BINARY_DIR}/tools/morula-${tool}
    DESTINATION ${CMAKE_INSTALL_BINDIR})
  list(APPEND commands morula-${tool})
endforeach()

set(pages_directory ${CMAKE_INSTALL_DATADIR}/doc/morula)
install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGES.md
  DESTINATION ${pages_directory})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/doc DESTINATION ${pages_directory}
  FILES_MATCHING PATTERN "*.md" PATTERN "*.ipynb"
  PATTERN changes EXCLUDE
  PATTERN data EXCLUDE
  PATTERN images EXCLUDE
  PATTERN man EXCLUDE)
install(FILES ${PROJECT_SOURCE_DIR}/contrib/packaging/copyright
  DESTINATION ${pages_directory})

# Manual pages and completion, by the names of the commands.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/doc/man/
  DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 FILES_MATCHING PATTERN "*.1")
foreach(command morula ${commands}) # bash looks for a file of the command's name
  install(FILES ${PROJECT_SOURCE_DIR}/contrib/completion/morula
    DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
    RENAME ${command})
endforeach()

include(${CMAKE_CURRENT_LIST_DIR}/package.cmake)

