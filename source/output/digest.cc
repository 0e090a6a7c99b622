// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/digest.h>

#include <cstdio>

namespace Morula
{
  std::string
  digest_text(const std::uint64_t digest)
  {
    char text[32];
    std::snprintf(text,
                  sizeof(text),
                  "%016llx",
                  static_cast<unsigned long long>(digest));
    return text;
  }

  std::vector<int>
  as_integers(const std::uint64_t digest)
  {
    return {static_cast<int>(digest >> 32),
            static_cast<int>(digest & 0xffffffffu)};
  }

  std::uint64_t
  digest_of_integers(const std::vector<int> &halves)
  {
    return (std::uint64_t(static_cast<std::uint32_t>(halves[0])) << 32) |
           static_cast<std::uint32_t>(halves[1]);
  }
} // namespace Morula
