// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_balance_warning_h
#define morula_simulation_balance_warning_h

#include <morula/output/forces.h>

#include <optional>
#include <string>
#include <vector>

namespace Morula
{
  /** A warning of forces at @p t (day) that the weak drag of scenes with
   *  obstacles balances, doc/theory.md (4.8f); nothing where they balance.
   *  @param least what counts as a force, kPa µm^(dim-1) */
  std::optional<std::string>
  balance_warning(const std::vector<ForceRow> &rows,
                  const double                 t,
                  const double                 least);
} // namespace Morula

#endif
