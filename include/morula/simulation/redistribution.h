// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_redistribution_h
#define morula_simulation_redistribution_h

#include <morula/scene/tissue_model.h>

namespace Morula
{
  /**
   * The strain of a step that displaces a cell against its neighbours:
   * doc/theory.md (6.11). F_g must be that of the end of the step.
   * @param p       the cell's place in @p of_step
   * @param f       of the step
   * @param flows   whether its shear is a flow, whatever its own one
   */
  template <int dim>
  double
  displacing_strain(const CellView<dim, const double> &cell,
                    const unsigned int                 p,
                    const Tensor<2, dim>              &f,
                    const DevelopmentOfStep<dim>      &of_step,
                    const bool                         flows);

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
