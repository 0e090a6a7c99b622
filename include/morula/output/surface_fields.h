// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_surface_fields_h
#define morula_output_surface_fields_h

#include <morula/output/point_fields.h>
#include <morula/particles/cell_state.h>

#include <deal.II/base/array_view.h>
#include <deal.II/base/tensor.h>

namespace Morula
{
  /**
   * The table behind surface-NNNN.csv and surface-NNNN.vtu. The latter also
   * gets normal and displacement as vectors.
   */
  template <int dim>
  class SurfaceFields
  {
  public:
    /** @param time day */
    explicit SurfaceFields(const double time);

    /**
     * Adds one boundary point of this rank.
     * @param properties layout BoundarySlots
     * @param position   current, µm
     */
    void
    add(const types::particle_index    id,
        const ArrayView<const double> &properties,
        const Point<dim>              &position);

    const PointFields<dim> &
    fields() const
    {
      return table;
    }

  private:
    double           time;
    PointFields<dim> table;
  };
} // namespace Morula

#endif
