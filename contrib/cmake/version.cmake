# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors

# cmake -Dsource=TREE -Dnumber=VERSION -Doutput=FILE.cc -P version.cmake
#
# Writes the file of the version, in each build, as a commit changes nothing that
# a build system looks at. A file that would be the same is left alone, so that
# nothing is compiled or linked for it. Outside of a clone, as in the sources of a
# release, there is the number alone.

set(commit "")
find_program(git git)
if(git AND EXISTS ${source}/.git)
  execute_process(
    COMMAND ${git} -C ${source} describe --tags --match "v[0-9]*" --always
            --abbrev=10
    OUTPUT_VARIABLE commit ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
  # Pages and tables that a build does not see make no other program.
  execute_process(
    COMMAND ${git} -C ${source} status --porcelain -- CMakeLists.txt include source
    OUTPUT_VARIABLE changes ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(commit AND changes)
    string(APPEND commit "-dirty")
  endif()
  if(commit STREQUAL "v${number}")
    set(commit "")
  endif()
endif()
configure_file(${source}/source/base/version.cc.in ${output} @ONLY)
