// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_review_h
#define morula_base_review_h

#include <morula/base/key.h>

#include <string>
#include <vector>

namespace Morula
{
  /** What is legal in a scene but unwise, the same on all ranks. */
  struct Review
  {
    /** A line each. */
    std::vector<std::string> warnings = {};

    /**
     * Adds a warning. It needs a measurement in doc/, or must follow from what
     * the keys say.
     * @param key    full path
     * @param value  with its unit
     * @param why    what goes wrong, and where that was measured
     * @param remedy what to do, a full sentence
     */
    void
    warn(const std::string &key,
         const std::string &value,
         const std::string &why,
         const std::string &remedy)
    {
      warnings.push_back("Warning: " + key + " = '" + value + "': " + why +
                         ' ' + remedy);
    }
  };
} // namespace Morula

#endif
