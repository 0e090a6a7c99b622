// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_type_change_h
#define morula_particles_type_change_h

#include <deal.II/particles/property_pool.h>

namespace Morula
{
  using namespace dealii;

  /** A cell becomes one of another type: a row of events.csv. */
  struct TypeChange
  {
    double                time; // day, exact
    types::particle_index id;   // of the cell
    unsigned int          from; // numbers of the types
    unsigned int          to;
  };
} // namespace Morula

#endif
