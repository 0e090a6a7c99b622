// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_rule_h
#define morula_base_rule_h

#include <functional>
#include <string>

namespace Morula
{
  /** A condition on the values of a key. */
  template <typename T>
  struct Rule
  {
    std::function<bool(const T &)> holds;
    /** A noun phrase. */
    std::string allowed;
    /** A full sentence. */
    std::string remedy;
  };

  /** Refuses values <= 0. @param unit e.g. "kPa", for the message */
  inline Rule<double>
  positive(const std::string &unit, const std::string &remedy)
  {
    return {[](const double value) { return value > 0.; },
            "a value > 0 " + unit,
            remedy};
  }

  /** Refuses values < 0. */
  inline Rule<double>
  not_negative(const std::string &unit, const std::string &remedy)
  {
    return {[](const double value) { return value >= 0.; },
            "a value >= 0 " + unit,
            remedy};
  }
} // namespace Morula

#endif
