// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/table.h>

#include <charconv>
#include <cmath>
#include <cstdint>

namespace Morula
{
  void
  append_number(std::string &text, const double value)
  {
    // %.10g needs at most sign, 10 digits, point and exponent. to_chars() gives
    // the same several times faster, in every locale. Whole numbers of up to 10
    // digits are printed as such, which is faster again; -0 becomes 0.
    char       digits[32];
    const auto whole =
      std::abs(value) < 1e10 ? static_cast<std::int64_t>(value) : 0;
    const auto end =
      static_cast<double>(whole) == value ?
        std::to_chars(digits, digits + sizeof(digits), whole).ptr :
        std::to_chars(digits,
                      digits + sizeof(digits),
                      value,
                      std::chars_format::general,
                      10)
          .ptr;
    text.append(digits, end);
  }
} // namespace Morula
