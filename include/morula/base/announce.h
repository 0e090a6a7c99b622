// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_announce_h
#define morula_base_announce_h

#include <functional>
#include <string>

namespace Morula
{
  /** Writes a message to the terminal and into log.txt. To be called on all
   *  ranks; rank 0 writes. */
  using Announce = std::function<void(const std::string &text)>;
} // namespace Morula

#endif
