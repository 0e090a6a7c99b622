// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/review.h>

namespace Morula
{
  void
  Review::warn(const std::string &key,
               const std::string &value,
               const std::string &why,
               const std::string &remedy)
  {
    warnings.push_back("Warning: " + key + " = '" + value + "': " + why + ' ' +
                       remedy);
  }
} // namespace Morula
