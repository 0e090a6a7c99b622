// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/simulation/step_checks.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <limits>
#include <sstream>

namespace Morula
{
  template <int dim>
  bool
  inverts(const DisplacementField<dim> &displacement,
          const PointStore<dim>        &store,
          const MPI_Comm                comm)
  {
    // f is taken at each point's own position, in the configuration at t. The
    // sum makes all ranks agree, so that they reject the step together.
    unsigned int inverted = 0;
    displacement.at_points(store,
                           [&](const unsigned int,
                               const LocalField<dim>   &field,
                               const SplineValues<dim> &splines) {
                             const Tensor<2, dim> f =
                               field.step_deformation(splines);
                             if (!(determinant(f) > 0.))
                               ++inverted;
                           });
    return Utilities::MPI::sum(inverted, comm) > 0;
  }

  template <int dim>
  void
  check_gap(const Extremes<dim> &extremes,
            const double         largest_gap,
            const double         h)
  {
    // The extremes are those of all ranks, so that all throw.
    if (largest_gap == 0. || extremes.largest_gap <= largest_gap * h)
      return;
    std::ostringstream text;
    text << "The tissue slips through its clamp: a held point at ("
         << extremes.place_of_gap << ") um is " << extremes.largest_gap
         << " um from where it is held, more than Solver/Largest gap = "
         << largest_gap << " grid spacings. A higher Boundary "
         << "conditions/Nitsche penalty holds it";
    throw StepFailed(text.str());
  }

  template <int dim>
  std::string
  torn_tissue_message(const std::vector<Point<dim>> &cells,
                      const std::vector<Point<dim>> &boundary_points,
                      const GridBox<dim>            &box,
                      const MPI_Comm                 comm)
  {
    // The box around all points follows from one reduction: the largest
    // coordinates, and the largest of the negative ones for the lower corner.
    // Its grid cells are counted as a floating-point number, as an integer
    // could overflow just where this matters. A rank without points leaves the
    // box alone.
    constexpr double    infinity = std::numeric_limits<double>::infinity();
    std::vector<double> reach(2 * dim, -infinity);
    for (const auto *points : {&cells, &boundary_points})
      for (const Point<dim> &x : *points)
        for (unsigned int d = 0; d < dim; ++d)
          {
            reach[d]       = std::max(reach[d], x[d]);
            reach[dim + d] = std::max(reach[dim + d], -x[d]);
          }
    Utilities::MPI::max(reach, comm, reach);
    double     n_grid_cells = 1.;
    Point<dim> lower, upper;
    for (unsigned int d = 0; d < dim; ++d)
      {
        upper[d] = reach[d];
        lower[d] = -reach[dim + d];
        n_grid_cells *= (upper[d] - lower[d]) / box.spacing() + 1.;
      }
    const double n_cells = Utilities::MPI::sum(1. * cells.size(), comm);
    // Tables over two million grid cells fit in any memory, and tissue of many
    // cells may have more of them, also where it is as sparse as one cell in
    // 100. The third bound lets a step double the box in each of three
    // directions.
    if (n_grid_cells <= std::max(2e6 + 100. * n_cells, 8. * box.size()))
      return "";
    std::ostringstream text;
    text << "points have left the tissue: it would reach from (" << lower
         << ") to (" << upper << ") um, over " << n_grid_cells
         << " grid cells. Look at the surface in the last output; choose a "
            "shape without corners that stand off from the cells, another "
            "Grid/Spacing, or Grid/Points per cell = 2";
    return text.str();
  }

  MORULA_INSTANTIATE(inverts);
  MORULA_INSTANTIATE(check_gap);
  MORULA_INSTANTIATE(torn_tissue_message);
} // namespace Morula
