// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/method.h>

namespace Morula::Method
{
  std::vector<std::pair<std::string, std::string>>
  values(const std::string &method)
  {
    if (method != "consistent")
      return {};
    return {{"Boundary conditions/Nitsche penalty", "20"},
            {"Boundary conditions/Nitsche form", "unsymmetric"}};
  }
} // namespace Morula::Method
