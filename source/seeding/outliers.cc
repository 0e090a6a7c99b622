// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/seeding/outliers.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/patterns.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace Morula
{
  namespace
  {
    std::string
    text(const double value)
    {
      std::ostringstream out;
      out << value;
      return out.str();
    }

    template <int dim>
    bool
    is_near(const Point<dim> &x, const double farthest)
    {
      for (unsigned int d = 0; d < dim; ++d)
        // A NaN is not near either.
        if (!(std::abs(x[d]) <= farthest))
          return false;
      return true;
    }

    /** Mean coordinate of all @p n rows. Each is divided by n before it is
     *  added, so that the sum of large coordinates cannot overflow. */
    template <int dim>
    double
    mean(const PointsFileRows<dim> &rows,
         const unsigned int         d,
         const std::uint64_t        n,
         const MPI_Comm             comm)
    {
      double mine = 0.;
      for (const Point<dim> &x : rows.positions)
        mine += x[d] / n;
      return Utilities::MPI::sum(mine, comm);
    }
  } // namespace

  template <int dim>
  BoundingBox<dim>
  bounding_box(const PointsFileRows<dim> &rows, const MPI_Comm comm)
  {
    std::pair<Point<dim>, Point<dim>> corners;
    // First each rank finds its own box, then all find that of all.
    for (unsigned int d = 0; d < dim; ++d)
      {
        double lower = std::numeric_limits<double>::max(), upper = -lower;
        for (const Point<dim> &x : rows.positions)
          {
            lower = std::min(lower, x[d]);
            upper = std::max(upper, x[d]);
          }
        corners.first[d]  = Utilities::MPI::min(lower, comm);
        corners.second[d] = Utilities::MPI::max(upper, comm);
      }
    return BoundingBox<dim>(corners);
  }

  template <int dim>
  LineProblem
  find_row_beyond_limits(const PointsFileRows<dim> &rows,
                         const SeedingLimits<dim>  &limits)
  {
    // Each rank looks at its own rows; the first bad one of all ranks is found
    // by the caller.
    for (std::size_t i = 0; i < rows.positions.size(); ++i)
      {
        if (!is_near(rows.positions[i], limits.farthest))
          return {rows.lines[i],
                  Patterns::Tools::to_string(rows.positions[i]),
                  "a place at most " + text(limits.farthest) +
                    " um from the origin (a number of times Grid/Spacing)",
                  "Correct the line. If the file is in another unit, scale it "
                  "to um."};
        if (!(std::pow(rows.volumes[i], 1. / dim) <= limits.cell_length))
          return {rows.lines[i],
                  text(rows.volumes[i]),
                  "a volume of at most " +
                    text(std::pow(limits.cell_length, dim)) + " um^" +
                    std::to_string(dim) + ": cells are no longer than " +
                    text(limits.cell_length) +
                    " um (a number of times Grid/Spacing)",
                  "Correct the volume, or raise Grid/Spacing: a cell deforms "
                  "as a whole."};
      }
    return {};
  }

  template <int dim>
  LineProblem
  find_outlier(const PointsFileRows<dim> &rows,
               const double               extent,
               const std::uint64_t        n,
               const MPI_Comm             comm)
  {
    if (n == 0)
      return {};
    // Along each axis the extent of all cells is compared with the limit. If it
    // is exceeded the cell farthest from the mean is named: of a file with one
    // wrong number that is the wrong one. The rank that has it returns it; the
    // others return nothing, and the caller throws on all of them.
    const BoundingBox<dim> box = bounding_box(rows, comm);
    for (unsigned int d = 0; d < dim; ++d)
      {
        // Halves are compared, since the difference of large numbers may
        // overflow.
        if (0.5 * box.upper_bound(d) - 0.5 * box.lower_bound(d) <= 0.5 * extent)
          continue;
        const double center   = mean(rows, d, n, comm);
        const auto   distance = [&](const Point<dim> &x) {
          return std::abs(0.5 * x[d] - 0.5 * center);
        };
        const auto farthest =
          std::max_element(rows.positions.begin(),
                           rows.positions.end(),
                           [&](const Point<dim> &a, const Point<dim> &b) {
                             return distance(a) < distance(b);
                           });
        const bool   any  = farthest != rows.positions.end();
        const double mine = any ? distance(*farthest) : -1.;
        if (mine < Utilities::MPI::max(mine, comm))
          return {};
        return {rows.lines[farthest - rows.positions.begin()],
                Patterns::Tools::to_string(*farthest),
                "cells that are at most " + text(extent) +
                  " um apart along an axis (a number of times Grid/Spacing)",
                "This one is the farthest from the others: correct or drop it. "
                "If the file is in another unit, scale it to um."};
      }
    return {};
  }

  MORULA_INSTANTIATE(bounding_box);
  MORULA_INSTANTIATE(find_row_beyond_limits);
  MORULA_INSTANTIATE(find_outlier);
} // namespace Morula
