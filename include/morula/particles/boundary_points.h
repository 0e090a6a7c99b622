// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_boundary_points_h
#define morula_particles_boundary_points_h

#include <morula/particles/boundary_state.h>
#include <morula/particles/point_store.h>

namespace Morula
{
  /**
   * This rank's boundary points by their position p in the canonical order:
   * `points.F(p)`, `points.area_vector(p)`. A whole point is `points[p]`. The
   * ParticleHandler stores them.
   */
  template <int dim>
  class BoundaryPoints : public PointStore<dim>
  {
  public:
    /** No points yet, with these columns. */
    explicit BoundaryPoints(const BoundaryColumns<dim> &columns)
      : PointStore<dim>(columns.n_numbers(), columns.body)
      , columns_(columns)
    {}

    /** The columns of a boundary point. */
    const BoundaryColumns<dim> &
    columns() const
    {
      return columns_;
    }

    /** One boundary point. */
    BoundaryView<dim, const double>
    operator[](const unsigned int p) const
    {
      return {this->row(p), columns_};
    }

    /** One boundary point, for writing. */
    BoundaryView<dim, double>
    operator[](const unsigned int p)
    {
      return {this->row(p), columns_};
    }

    /** F. */
    Tensor<2, dim>
    F(const unsigned int p) const
    {
      return (*this)[p].F();
    }

    /** What holds or loads the point. */
    SurfaceCondition
    condition(const unsigned int p) const
    {
      return (*this)[p].condition();
    }

    /** The present area vector a n, µm^(dim-1). */
    Tensor<1, dim>
    area_vector(const unsigned int p) const
    {
      return (*this)[p].area_vector();
    }

  private:
    const BoundaryColumns<dim> columns_;
  };
} // namespace Morula

#endif
