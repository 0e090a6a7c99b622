// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_present_depth_h
#define morula_simulation_present_depth_h

#include <morula/effects/state/state_columns.h>
#include <morula/particles/tissue.h>

namespace Morula
{
  /** Sets the variable present_depth of all cells: their distance from the
   *  surface as it is now. Nothing if no expression uses it. Collective. */
  template <int dim>
  void
  set_present_depth(Tissue<dim> &tissue, const StateColumns<dim> &state);
} // namespace Morula

#endif
