# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors

# What `cmake --install` puts below its prefix: the program, the library with
# its headers and the package that find_package(Morula) reads, scenes to start
# from, and a project to start one's own effects from. Nothing of it names the
# build or the source directory, and the whole may be moved.

if(MORULA_SANITIZE)
  install(CODE "message(FATAL_ERROR \"Not installed: this build finds memory \
errors (MORULA_SANITIZE), and programs that link with it would not. Install \
one without.\")")
  return()
endif()

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package_directory ${CMAKE_INSTALL_LIBDIR}/cmake/Morula)
set(share_directory ${CMAKE_INSTALL_DATADIR}/morula)

# A deal.II that stands in no system directory is found by its path.
set_target_properties(morula PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON)
install(TARGETS morula RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})

set_target_properties(morula_lib PROPERTIES EXPORT_NAME morula)
install(TARGETS morula_lib EXPORT MorulaTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/morula
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  FILES_MATCHING PATTERN "*.h"
  PATTERN kernels EXCLUDE) # parts of three files in source/, nobody else's

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

install(FILES ${PROJECT_SOURCE_DIR}/prm/demo.prm
  DESTINATION ${share_directory}/prm)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/prm/paper
  DESTINATION ${share_directory}/prm)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/contrib/example-project
  DESTINATION ${share_directory}
  PATTERN build EXCLUDE
  PATTERN output EXCLUDE)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/CITATION.cff
  DESTINATION ${share_directory})
