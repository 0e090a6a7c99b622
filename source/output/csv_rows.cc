// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/csv_rows.h>

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

  std::string
  csv_header(const std::vector<std::string> &names)
  {
    std::string line;
    for (const std::string &name : names)
      line += (line.empty() ? "" : ",") + name;
    return line + '\n';
  }

  void
  append_row(std::string &text, const double *values, const unsigned int n)
  {
    for (unsigned int i = 0; i < n; ++i)
      {
        if (i > 0)
          text += ',';
        append_number(text, values[i]);
      }
    text += '\n';
  }

  std::string
  csv_row(const double *values, const unsigned int n)
  {
    std::string row;
    append_row(row, values, n);
    return row;
  }
} // namespace Morula
