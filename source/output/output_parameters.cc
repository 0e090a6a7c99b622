// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/time_parameters.h>
#include <morula/output/output_parameters.h>

#include <algorithm>
#include <set>

namespace Morula
{
  OutputParameters::OutputParameters()
  {
    using Words = std::vector<std::string>;
    // Words that exclude each other cannot be said by the list of allowed
    // words.
    formats.require(
      [](const Words &words) {
        return std::set<std::string>(words.begin(), words.end()).size() ==
               words.size();
      },
      "each format once",
      "Remove what is written twice.");
  }
} // namespace Morula
