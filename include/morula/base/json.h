// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_json_h
#define morula_base_json_h

#include <string>
#include <utility>
#include <vector>

namespace Morula
{
  /** Values as JSON, each a piece of text. (Boost's property trees write every
   *  number as text.) */
  namespace Json
  {
    /** A text in quotes. */
    std::string
    text(const std::string &value);

    /** A number with its shortest digits; null if it is not finite. */
    std::string
    number(const double value);

    /** A list of texts. */
    std::string
    texts(const std::vector<std::string> &values);

    /** A list of values. */
    std::string
    list(const std::vector<std::string> &values);

    /** An object: names, and values as JSON. */
    std::string
    object(const std::vector<std::pair<std::string, std::string>> &members);
  } // namespace Json
} // namespace Morula

#endif
