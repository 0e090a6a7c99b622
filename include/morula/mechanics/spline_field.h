// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_spline_field_h
#define morula_mechanics_spline_field_h

#include <morula/mechanics/field_unknowns.h>
#include <morula/mechanics/local_system.h>
#include <morula/particles/point_store.h>

#include <deal.II/lac/trilinos_vector.h>

#include <mpi.h>

#include <vector>

namespace Morula
{
  /**
   * A field of n components on this rank's active grid cells, with the unknowns
   * of other ranks that these need. Keeps a reference to the space.
   */
  template <int dim, int n_components>
  class SplineField
  {
  public:
    /** @param u in the layout of FieldUnknowns::owned(). Neighbours exchange
     *  values. */
    SplineField(const SplineSpace<dim>                 &space,
                const FieldUnknowns<dim, n_components> &unknowns,
                const TrilinosWrappers::MPI::Vector    &u);

    /** Does as the one above, for a caller that has no FieldUnknowns.
     *  Collective. */
    SplineField(const SplineSpace<dim>              &space,
                const TrilinosWrappers::MPI::Vector &u,
                const MPI_Comm                       comm);

    /** Coefficients of the splines of one active grid cell. */
    LocalField<dim, n_components>
    on_grid_cell(const unsigned int grid_cell) const;

    /**
     * Calls action(p, field, splines) for each point of a store in order:
     * with its position p in the store, the field on its grid cell, and
     * the splines at its place.
     */
    template <typename Action>
    void
    at_points(const PointStore<dim> &store, const Action &action) const;

    /** The values at the points of a store, in order. */
    std::vector<Tensor<1, n_components>>
    values_at(const PointStore<dim> &store) const
    {
      std::vector<Tensor<1, n_components>> list(store.size());
      at_points(store,
                [&list](const unsigned int                   p,
                        const LocalField<dim, n_components> &field,
                        const SplineValues<dim>             &splines) {
                  list[p] = field.value(splines);
                });
      return list;
    }

    /** Calls action(grid_cell, field, index) for each grid cell of a store that
     *  holds points, in order. */
    template <typename Action>
    void
    on_grid_cells(const PointStore<dim> &store, const Action &action) const;

    /** The grid cells' numbers, coordinates and places. */
    const GridBox<dim> &
    box() const
    {
      return space.box();
    }

    /** The values at FieldUnknowns::relevant(). */
    const std::vector<double> &
    relevant_values() const
    {
      return values;
    }

  private:
    const SplineSpace<dim>   &space;
    const std::vector<double> values; // at FieldUnknowns::relevant()
  };

  /** The displacement. */
  template <int dim>
  using DisplacementField = SplineField<dim, dim>;

  template <int dim, int n_components>
  template <typename Action>
  void
  SplineField<dim, n_components>::at_points(const PointStore<dim> &store,
                                            const Action          &action) const
  {
    on_grid_cells(store,
                  [&](const auto                          &grid_cell,
                      const LocalField<dim, n_components> &field,
                      const GridIndex<dim>                &index) {
                    for (unsigned int p = grid_cell.begin; p < grid_cell.end;
                         ++p)
                      action(p,
                             field,
                             SplineValues<dim>(
                               box().unit_position(store.position(p), index),
                               box().spacing()));
                  });
  }

  template <int dim, int n_components>
  template <typename Action>
  void
  SplineField<dim, n_components>::on_grid_cells(const PointStore<dim> &store,
                                                const Action &action) const
  {
    unsigned int c = 0;
    for (const auto &grid_cell : store.grid_cells())
      {
        while (
          !space.is_at(space.grid_cells()[c], grid_cell.number, grid_cell.part))
          ++c;
        action(grid_cell, on_grid_cell(c), box().index(grid_cell.number));
      }
  }
} // namespace Morula

#endif
