// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_displacement_field_h
#define morula_mechanics_displacement_field_h

#include <morula/grid/spline_space.h>
#include <morula/mechanics/term.h>
#include <morula/particles/point_store.h>

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
    on_grid_cell(const unsigned int grid_cell) const;

    /**
     * Calls action(p, field, splines) for each point of a store in order:
     * with its position p in the store, the field on its grid cell, and
     * the splines at its place.
     */
    template <typename Action>
    void
    at_points(const PointStore<dim> &store, const Action &action) const;

  private:
    const SplineSpace<dim>       &space;
    TrilinosWrappers::MPI::Vector relevant;
  };

  template <int dim>
  template <typename Action>
  void
  DisplacementField<dim>::at_points(const PointStore<dim> &store,
                                    const Action          &action) const
  {
    unsigned int c = 0;
    for (const auto &grid_cell : store.grid_cells())
      {
        while (space.grid_cells()[c].number != grid_cell.number)
          ++c;
        const LocalField<dim> field = on_grid_cell(c);
        const GridIndex<dim>  index = space.box().index(grid_cell.number);
        for (unsigned int p = grid_cell.begin; p < grid_cell.end; ++p)
          action(p,
                 field,
                 SplineValues<dim>(space.box().unit_position(store.position(p),
                                                             index),
                                   space.box().spacing()));
      }
  }
} // namespace Morula

#endif
