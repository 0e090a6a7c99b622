// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_version_h
#define morula_base_version_h

#include <string>

namespace Morula
{
  /** The number of the release, such as "0.3.0"; snapshots and the first line
   *  of parameters.prm have it. */
  std::string
  version_number();

  /** The number of the release, and in brackets the commit that the program
   *  was built from, as `git describe` says it; without brackets where that is
   *  the release itself, or where there was no git. */
  std::string
  version_in_words();
} // namespace Morula

#endif
