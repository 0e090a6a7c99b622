// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_surface_fields_h
#define morula_output_surface_fields_h

#include <morula/output/declared_fields.h>
#include <morula/output/point_fields.h>
#include <morula/particles/boundary_state.h>

#include <deal.II/base/tensor.h>

#include <utility>

namespace Morula
{
  /**
   * The table behind surface-NNNN.csv and surface-NNNN.vtu. The latter also
   * gets the normal and the displacement as vectors. Columns that effects have
   * declared for the output are the last ones of the CSV file.
   */
  template <int dim>
  class SurfaceFields
  {
  public:
    /**
     * @param time    day
     * @param columns of the boundary points
     * @throws std::invalid_argument for declared columns with heads that the
     *                table has already
     */
    SurfaceFields(const double time, const BoundaryColumns<dim> &columns);

    /**
     * Adds one boundary point of this rank.
     * @param position current, µm
     */
    void
    add(const types::particle_index id,
        const BoundaryView<dim>    &point,
        const Point<dim>           &position);

    const PointFields<dim> &
    fields() const &
    {
      return table;
    }

    /** The fields of a table that is no longer needed. */
    PointFields<dim>
    fields() &&
    {
      return std::move(table);
    }

  private:
    double              time;
    DeclaredFields<dim> declared;
    PointFields<dim>    table;
  };
} // namespace Morula

#endif
