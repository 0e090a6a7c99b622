// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/effect.h>

#include <algorithm>

namespace Morula
{
  std::string
  EffectKeys::details() const
  {
    // The list begins with a comma since the name of the effect stands before
    // it. Defaults that switch something off or on are left out, unless there
    // is nothing else.
    const auto list = this->list();
    const bool all =
      std::all_of(list.begin(), list.end(), [](const AnyKey *key) {
        return key->is_default();
      });
    std::string text;
    for (const AnyKey *key : list)
      if (const std::string value = key->text();
          !value.empty() &&
          (all || !key->is_default() || (value != "0" && value != "true")))
        text += ", " + key->short_name() + " = " + value;
    return text;
  }
} // namespace Morula
