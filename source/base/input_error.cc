// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>

#include <algorithm>

namespace Morula
{
  namespace
  {
    /** Messages show at most so many bytes of a text. */
    constexpr std::size_t longest = 400;
  } // namespace


  std::string
  printable(const std::string &text)
  {
    std::size_t end = std::min(text.size(), longest);
    // UTF-8 characters are not cut: bytes that continue one begin with the bits
    // 10.
    while (end > 0 && end < text.size() && (text[end] & 0xC0) == 0x80)
      --end;

    const std::string digits = "0123456789abcdef";
    std::string       result;
    for (std::size_t i = 0; i < end; ++i)
      if (const auto byte = static_cast<unsigned char>(text[i]);
          byte < 0x20 || byte == 0x7F)
        result += std::string("\\x") + digits[byte / 16] + digits[byte % 16];
      else
        result += text[i];
    return end < text.size() ? result + "..." : result;
  }
} // namespace Morula
