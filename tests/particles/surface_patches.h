// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_particles_surface_patches_h
#define morula_tests_particles_surface_patches_h

#include <morula/particles/boundary_state.h>
#include <morula/particles/point_list.h>

namespace Morula
{
  /** What splitting and merging patches must keep. */
  template <int dim>
  struct PatchSums
  {
    double         initial_area = 0., area = 0., volume = 0., conditions = 0.;
    Tensor<1, dim> initial_vector, vector, moment;

    PatchSums(const PointList<dim> &points, const BoundaryColumns<dim> &columns)
    {
      for (std::size_t i = 0; i < points.size(); ++i)
        {
          const BoundaryView<dim> point(points.row(i), columns);
          initial_area += point.initial_area();
          area += point.area_vector().norm();
          initial_vector += point.initial_area() * point.initial_normal();
          vector += point.area_vector();
          volume += point.area_vector() * points.positions[i] / dim;
          moment += point.area_vector().norm() * points.positions[i];
          conditions +=
            point.initial_area() * static_cast<int>(point.condition());
        }
    }
  };
} // namespace Morula

#endif
