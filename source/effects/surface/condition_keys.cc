// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/surface/condition_keys.h>

namespace Morula
{
  ConditionKeys::ConditionKeys(const std::string &path,
                               const std::string &documentation,
                               const std::string &anywhere)
    : where(path, anywhere, documentation, Evaluated::founder)
  {}


  bool
  ConditionKeys::is_on() const
  {
    // A condition without a place acts nowhere, so it does not exist in this
    // scene.
    return !where.empty();
  }
} // namespace Morula
