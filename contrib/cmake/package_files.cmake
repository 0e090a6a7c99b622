# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors

# CPack runs this when the files of the package stand in their places: Debian wants
# manual pages and the list of changes compressed, without a name and a time in it.

set(share ${CPACK_TEMPORARY_INSTALL_DIRECTORY}${CPACK_PACKAGING_INSTALL_PREFIX}/share)

# The date in Debian's form. Releases are made in UTC.
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE ${share}/doc/morula/changelog
"${CPACK_PACKAGE_NAME} (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium

  * Release ${CPACK_PACKAGE_VERSION}: CHANGES.md in this directory says what is new.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")
file(GLOB files ${share}/man/man1/*.1 ${share}/doc/morula/changelog)
execute_process(COMMAND gzip -9 -n -f ${files} COMMAND_ERROR_IS_FATAL ANY)
