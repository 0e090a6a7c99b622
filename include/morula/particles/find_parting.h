// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_find_parting_h
#define morula_particles_find_parting_h

#include <morula/grid/parting.h>
#include <morula/particles/tissue.h>

namespace Morula
{
  /** The parting of the tissue as it is now, on all ranks. Collective. */
  template <int dim>
  Parting<dim>
  find_parting(const Tissue<dim> &tissue);
} // namespace Morula

#endif
