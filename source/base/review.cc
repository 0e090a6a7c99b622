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


  void
  Review::warn_of_idle(const AnyKey      &key,
                       const std::string &why,
                       const std::string &remedy)
  {
    if (is_given(key))
      warn(key.path(),
           key.text(),
           "it does nothing here: " + why + '.',
           remedy);
  }
} // namespace Morula
