// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_redistribution_h
#define morula_simulation_redistribution_h

#include <morula/scene/tissue_model.h>

namespace Morula
{
  /**
   * Gives cells the places that their volumes ask for, and volumes that fit the
   * space there, doc/theory.md, section 6.11, after what a step has divided,
   * removed and exchanged, and puts them out of obstacles. Collective.
   * @param t           now, day
   * @param has_surface without one no space is known, and volumes stay
   * @param numbers get the columns of statistics.csv
   */
  template <int dim>
  void
  redistribute(Tissue<dim>            &tissue,
               const TissueModel<dim> &model,
               const double            t,
               const bool              has_surface,
               NamedNumbers           &numbers);
} // namespace Morula

#endif
