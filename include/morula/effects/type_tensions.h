// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_type_tensions_h
#define morula_effects_type_tensions_h

#include <vector>

namespace Morula
{
  /** Tensions of the interfaces between types of cells, and of the free surface
   *  of each type, kPa µm; by the types' numbers. Empty: there are none. */
  struct TypeTensions
  {
    /** Symmetric; 0 on the diagonal. */
    std::vector<std::vector<double>> between;
    std::vector<double>              with_surface;

    /** Whether the free surface of some type has one. */
    bool
    any_with_surface() const
    {
      for (const double gamma : with_surface)
        if (gamma != 0.)
          return true;
      return false;
    }
  };
} // namespace Morula

#endif
