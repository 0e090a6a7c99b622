// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_boundary_points_h
#define morula_particles_boundary_points_h

#include <morula/particles/boundary_state.h>
#include <morula/particles/point_store.h>
#include <morula/particles/side.h>

#include <numeric>
#include <vector>

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
      : PointStore<dim>(columns.n_numbers(), columns.body, columns.part)
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

    /** Which cells each point may look at; empty without contact. */
    std::vector<Side<dim>>
    sides() const
    {
      std::vector<unsigned int> all(this->size());
      std::iota(all.begin(), all.end(), 0u);
      return sides_of(all);
    }

    /** The same of some points of this rank. */
    std::vector<Side<dim>>
    sides_of(const std::vector<unsigned int> &points) const
    {
      std::vector<Side<dim>> list;
      if (this->has_bodies())
        for (const unsigned int p : points)
          list.push_back({this->body(p),
                          this->has_parts() ?
                            area_vector(p) / area_vector(p).norm() :
                            Tensor<1, dim>()});
      return list;
    }

  private:
    const BoundaryColumns<dim> columns_;
  };
} // namespace Morula

#endif
