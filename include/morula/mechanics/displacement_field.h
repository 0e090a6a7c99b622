// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_displacement_field_h
#define morula_mechanics_displacement_field_h

#include <morula/grid/spline_space.h>
#include <morula/mechanics/term.h>

#include <deal.II/lac/trilinos_vector.h>

#include <mpi.h>

namespace Morula
{
  /**
   * A displacement on this rank's active grid cells, with the unknowns of other
   * ranks that these need. Keeps a reference to the space.
   */
  template <int dim>
  class DisplacementField
  {
  public:
    /**
     * @param u in the layout of SplineSpace::owned_dofs(). Collective.
     */
    DisplacementField(const SplineSpace<dim>              &space,
                      const TrilinosWrappers::MPI::Vector &u,
                      const MPI_Comm                       comm);

    /** Coefficients of the splines of one active grid cell. */
    LocalField<dim>
    on_cell(const unsigned int cell) const;

  private:
    const SplineSpace<dim>       &space;
    TrilinosWrappers::MPI::Vector relevant;
  };
} // namespace Morula

#endif
