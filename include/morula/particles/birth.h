// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_birth_h
#define morula_particles_birth_h

#include <deal.II/base/point.h>
#include <deal.II/particles/property_pool.h>

namespace Morula
{
  using namespace dealii;

  /** A cell's row in lineage.csv. */
  template <int dim>
  struct Birth
  {
    types::particle_index id;
    int                   parent;     // -1 for founders
    unsigned int          generation; // of founders 0, or as their file says
    double                time;       // day, exact
    Point<dim>            position;   // at birth, µm
    unsigned int          type = 0;   // number of the type
  };
} // namespace Morula

#endif
