// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/json.h>

#include <boost/algorithm/string/join.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace Morula
{
  std::string
  Json::text(const std::string &value)
  {
    std::string quoted = "\"";
    // JSON wants quotes, backslashes and control characters in other words.
    for (const char c : value)
      if (c == '"' || c == '\\')
        quoted += std::string("\\") + c;
      else if (static_cast<unsigned char>(c) < 0x20)
        {
          char code[8];
          std::snprintf(code, sizeof(code), "\\u%04x", c);
          quoted += code;
        }
      else
        quoted += c;
    return quoted + '"';
  }


  std::string
  Json::number(const double value)
  {
    if (!std::isfinite(value))
      return "null";
    char digits[32];
    // 15 digits suffice for most numbers, 17 for all. The first that reads back
    // as the same number is the shortest.
    for (const int n : {15, 16, 17})
      {
        std::snprintf(digits, sizeof(digits), "%.*g", n, value);
        if (std::strtod(digits, nullptr) == value)
          break;
      }
    return digits;
  }


  std::string
  Json::texts(const std::vector<std::string> &values)
  {
    std::vector<std::string> quoted;
    for (const std::string &value : values)
      quoted.push_back(text(value));
    return list(quoted);
  }


  std::string
  Json::list(const std::vector<std::string> &values)
  {
    return "[" + boost::join(values, ", ") + "]";
  }


  std::string
  Json::object(const std::vector<std::pair<std::string, std::string>> &members)
  {
    std::vector<std::string> pairs;
    for (const auto &[name, value] : members)
      pairs.push_back(text(name) + ": " + value);
    return "{" + boost::join(pairs, ", ") + "}";
  }
} // namespace Morula
