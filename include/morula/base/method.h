// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_method_h
#define morula_base_method_h

#include <string>
#include <utility>
#include <vector>

/**
 * The key `Method`: one word for several keys of a scene. With `paper` they
 * have the defaults with which they are declared, those of Yokoyama, Kameo and
 * Adachi (2023); with `consistent` the values here. A key that the scene sets
 * itself keeps the scene's value. doc/accuracy-and-cost.md says why it is these
 * keys.
 */
namespace Morula::Method
{
  /** What `Method` may be, as a pattern of deal.II. */
  inline const std::string choices = "paper|consistent";

  /** What a scene has that says nothing. */
  inline const std::string by_default = "paper";

  /** (full path, value) of the keys that have other defaults with @p method
   *  than those with which they are declared. */
  std::vector<std::pair<std::string, std::string>>
  values(const std::string &method);
} // namespace Morula::Method

#endif
