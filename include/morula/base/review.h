// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_review_h
#define morula_base_review_h

#include <morula/base/key.h>

#include <functional>
#include <string>
#include <vector>

namespace Morula
{
  /** What is legal in a scene but unwise, the same on all ranks. */
  struct Review
  {
    /** Whether the scene itself has set a key. */
    std::function<bool(const AnyKey &)> has_set;

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

    /** Whether the scene itself gives the key a value that is not the default.
     */
    bool
    is_given(const AnyKey &key) const
    {
      return has_set(key) && !key.is_default();
    }

    /** Warns of a key that does nothing, if is_given().
     *  @param why half a sentence */
    void
    warn_of_idle(const AnyKey      &key,
                 const std::string &why,
                 const std::string &remedy)
    {
      if (is_given(key))
        warn(key.path(),
             key.text(),
             "it does nothing here: " + why + '.',
             remedy);
    }
  };
} // namespace Morula

#endif
