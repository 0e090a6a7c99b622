// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_touching_points_h
#define morula_particles_touching_points_h

#include <morula/particles/tissue.h>

#include <vector>

namespace Morula
{
  /**
   * Whether the surface touches another one at each boundary point, by the
   * points' numbers: that of another body, or, where bodies can touch
   * themselves, any that faces it. Where they do, one tissue goes on behind the
   * other. Collective.
   */
  template <int dim>
  std::vector<char>
  touching_points(const Tissue<dim> &tissue);
} // namespace Morula

#endif
