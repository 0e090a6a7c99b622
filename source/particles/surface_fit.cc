// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/particles/detached_points.h>
#include <morula/particles/surface_fit.h>

#include <deal.II/base/mpi.h>

namespace Morula
{
  template <int dim>
  SurfaceFit
  surface_fit(const Tissue<dim> &tissue)
  {
    // Everything follows from sums over the patches of this rank, a, a n, a x
    // and a n·x, and over its cells, V. One reduction makes them those of all
    // ranks. The enclosed volume is taken from the surface's middle, so that a
    // surface that is not quite closed has the same anywhere: doc/theory.md
    // (4.12f). Last comes the distance, which asks ranks for their cells.
    std::vector<double>        sums(2 * dim + 3, 0.);
    const BoundaryPoints<dim> &points = tissue.boundary_points();
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        const Tensor<1, dim> A = points[p].area_vector();
        const Point<dim>    &x = points.position(p);
        sums[0] += A.norm();
        sums[1] += A * x;
        for (unsigned int d = 0; d < dim; ++d)
          {
            sums[3 + d] += A[d];
            sums[3 + dim + d] += A.norm() * x[d];
          }
      }
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      sums[2] += tissue.cells().volume(p);
    Utilities::MPI::sum(sums, tissue.communicator(), sums);

    SurfaceFit fit;
    fit.cells = sums[2];
    if (!(sums[0] > 0.) || !(sums[2] > 0.))
      return fit;
    Tensor<1, dim> opening;
    fit.enclosed = sums[1];
    for (unsigned int d = 0; d < dim; ++d)
      {
        opening[d] = sums[3 + d];
        // The volume is that seen from the surface's middle, as in
        // doc/theory.md (4.8g).
        fit.enclosed -= opening[d] * sums[3 + dim + d] / sums[0];
      }
    fit.enclosed /= dim;
    fit.opening  = opening.norm() / sums[0];
    fit.distance = largest_distance(tissue);
    return fit;
  }

  MORULA_INSTANTIATE(surface_fit);
} // namespace Morula
