// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/particles/detached_points.h>
#include <morula/particles/nearest.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/symmetric_tensor.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace Morula
{
  namespace
  {
    /** How many reaches a boundary point may be away from its nearest cell. */
    constexpr double most_reaches = 4. / 3.;

    /** No reach is shorter than this, in units of h: splines do not resolve how
     *  cells move that are much smaller than the grid. */
    constexpr double least_reach = 0.25;

    /** The squared distance to the nearest cell of this rank in the grid cell
     *  of @p x and those around it, among those of a side if one is given;
     *  infinity if there is none. The search ends at the first cell that is as
     *  near as @p enough, also squared. */
    template <int dim>
    double
    distance_square_here(const Point<dim>  &x,
                         const Side<dim>   *side,
                         const Tissue<dim> &tissue,
                         const double       enough)
    {
      // Most boundary points have a cell in their own grid cell. So this is
      // looked at first, then the neighbours that may have a cell near enough,
      // and all of them only if none has.
      const GridBox<dim> &box      = tissue.grid().box();
      const auto         &store    = tissue.cells();
      double              shortest = std::numeric_limits<double>::infinity();
      const auto          look_at  = [&](const unsigned int number) {
        auto cell = std::lower_bound(store.grid_cells().begin(),
                                     store.grid_cells().end(),
                                     number,
                                     [](const auto &c, const unsigned int n) {
                                       return c.number < n;
                                     });
        for (; cell != store.grid_cells().end() && cell->number == number;
             ++cell)
          for (unsigned int p = cell->begin; p < cell->end && shortest > enough;
               ++p)
            if (side == nullptr || (side->body == store.body(p) &&
                                    side->has(x, store.position(p))))
              shortest =
                std::min(shortest, x.distance_square(store.position(p)));
      };
      const auto look_around = [&](const unsigned int number, const auto &) {
        if (shortest > enough)
          look_at(number);
      };
      const GridIndex<dim> index = box.locate(x);
      look_at(box.number(index));
      if (shortest > enough)
        {
          const double   reach = std::sqrt(enough);
          GridIndex<dim> lower = index, upper = index;
          for (unsigned int d = 0; d < dim; ++d)
            {
              const double xi = box.unit_position(x, index)[d] * box.spacing();
              lower[d] -= xi <= reach;
              upper[d] += xi + reach >= box.spacing();
            }
          box.for_overlap(lower, upper, look_around);
        }
      if (shortest > enough)
        box.for_neighbors(index, 1, look_around);
      return shortest;
    }

    /** The numbers of those points of this rank that have none of its cells
     *  within @p near (µm), which is at most a grid spacing. Other ranks may
     *  have one. This is far cheaper than to find the nearest ones. */
    template <int dim>
    std::vector<unsigned int>
    points_without_cell(const std::vector<Point<dim>> &points,
                        const Tissue<dim>             &tissue,
                        const double                   near,
                        const std::vector<Side<dim>>  &sides)
    {
      std::vector<unsigned int> found;
      for (unsigned int p = 0; p < points.size(); ++p)
        if (distance_square_here(points[p],
                                 sides.empty() ? nullptr : &sides[p],
                                 tissue,
                                 near * near) > near * near)
          found.push_back(p);
      return found;
    }

    /** Some of the points, and their sides if they have any. */
    template <int dim>
    std::pair<std::vector<Point<dim>>, std::vector<Side<dim>>>
    selected(const std::vector<unsigned int> &selection,
             const std::vector<Point<dim>>   &points,
             const std::vector<Side<dim>>    &sides)
    {
      std::vector<Point<dim>> places;
      std::vector<Side<dim>>  of_places;
      for (const unsigned int p : selection)
        {
          places.push_back(points[p]);
          if (!sides.empty())
            of_places.push_back(sides[p]);
        }
      return {places, of_places};
    }

    /** A cell near a boundary point. */
    template <int dim>
    using NearCell = std::tuple<Point<dim>,     // where it is, µm
                                Tensor<2, dim>, // F
                                double>;        // its surface_reach(), µm

    /** Points that may be farther away than @p reaches, and the
     *  cells nearest to them. Collective. */
    template <int dim>
    std::pair<std::vector<unsigned int>, std::vector<NearCell<dim>>>
    far_points(const std::vector<Point<dim>> &points,
               const std::vector<Side<dim>>  &sides,
               const Tissue<dim>             &tissue,
               const double                   reaches)
    {
      // Points with a cell of this rank nearby are settled without any message:
      // a reach is never below a quarter of a grid spacing. Only for the others
      // ranks exchange what their cells near them have. If no rank has any, no
      // rank enters the second part.
      const std::vector<unsigned int> far =
        points_without_cell(points,
                            tissue,
                            reaches * least_reach *
                              tissue.grid().box().spacing(),
                            sides);
      if (!Utilities::MPI::logical_or(!far.empty(), tissue.communicator()))
        return {};
      const auto [queries, of_queries] = selected(far, points, sides);
      const Cells<dim> &cells          = tissue.cells();
      const double      h              = tissue.grid().box().spacing();
      const auto        nearest        = nearest_values(
        queries,
        cells,
        [&](const unsigned int p) {
          return NearCell<dim>(cells.position(p),
                               cells.F(p),
                               surface_reach<dim>(cells[p], h));
        },
        Ties::lowest_id,
        tissue.grid(),
        of_queries);
      return {far, nearest};
    }

    /** How far a point may be from the cell, µm. */
    template <int dim>
    double
    farthest(const NearCell<dim> &cell)
    {
      return most_reaches * std::get<2>(cell);
    }

    /** The way from a point to its nearest cell, if it is detached; else 0. */
    template <int dim>
    Tensor<1, dim>
    way_back(const Point<dim> &point, const NearCell<dim> &cell)
    {
      // 1e-9 keeps a point that was pulled to the limit from being pulled
      // again.
      const Tensor<1, dim> way = std::get<0>(cell) - point;
      return way.norm() <= farthest(cell) * (1. + 1e-9) ? Tensor<1, dim>() :
                                                          way;
    }

    /** The part of a motion that the point's condition leaves free. */
    template <int dim>
    Tensor<1, dim>
    free_part(const BoundaryView<dim> &point, const Tensor<1, dim> &motion)
    {
      if (point.condition() == SurfaceCondition::slip)
        return motion -
               (motion * point.initial_normal()) * point.initial_normal();
      return motion;
    }
  } // namespace

  template <int dim>
  double
  largest_distance(const Tissue<dim> &tissue)
  {
    // The first pass knows the cells of this rank only, and each point only
    // until it has a cell nearer than the largest distance so far. The nearest
    // cells of all ranks are then asked for by the few points that may be the
    // farthest ones. Where another rank's cell was nearer than the first pass
    // knew, the answers are a lower bound, and the points beyond it are asked.
    const std::vector<Point<dim>> points = tissue.boundary_points().positions();
    const std::vector<Side<dim>>  sides  = tissue.boundary_points().sides();
    const Cells<dim>             &cells  = tissue.cells();
    const MPI_Comm                comm   = tissue.communicator();
    const double                  h      = tissue.grid().box().spacing();
    double                        square = 0.;
    for (unsigned int p = 0; p < points.size(); ++p)
      square =
        std::max(square,
                 distance_square_here(points[p],
                                      sides.empty() ? nullptr : &sides[p],
                                      tissue,
                                      square));
    // Several cells may be equally near but for rounding, and the lowest id
    // counts then: points that are farthest but for rounding are asked as well.
    constexpr double equal   = 1. - 1e-8;
    double           largest = Utilities::MPI::max(std::sqrt(square), comm);
    double           near    = h;
    do
      {
        // points_without_cell() looks no farther than a grid spacing.
        near = std::min(equal * largest, h);
        const auto [queries, of_queries] =
          selected(points_without_cell(points, tissue, near, sides),
                   points,
                   sides);
        const auto nearest = nearest_values(
          queries,
          cells,
          [&cells](const unsigned int p) { return cells.position(p); },
          Ties::lowest_id,
          tissue.grid(),
          of_queries);
        largest = 0.;
        for (std::size_t k = 0; k < queries.size(); ++k)
          largest = std::max(largest, queries[k].distance(nearest[k]));
        largest = Utilities::MPI::max(largest, comm);
    } while (largest < near);
    return largest;
  }

  template <int dim>
  double
  surface_reach(const CellView<dim, const double> &cell, const double h)
  {
    const Tensor<2, dim> F_g = cell.growth();
    const Tensor<2, dim> F_e = cell.elastic_deformation();
    // The largest row sum is an upper bound of the largest eigenvalue, and
    // exact without shear: doc/theory.md (4.13). The eigenvalues of nearly
    // isotropic tensors may come out as no numbers.
    const double stretch = std::sqrt(l1_norm(F_e * transpose(F_e)));
    const double width =
      std::pow(cell.initial_volume() * determinant(F_g), 1. / dim);
    return std::max(1.5 * stretch * width, least_reach * h);
  }

  double
  attachment(const double distance, const double reach)
  {
    // The part falls from 1 at one reach to 0 at 4/3 of it.
    const double part = (most_reaches - distance / reach) / (most_reaches - 1.);
    return std::min(1., std::max(0., part));
  }

  template <int dim>
  std::vector<double>
  attachment(const std::vector<Point<dim>> &points,
             const Tissue<dim>             &tissue,
             const std::vector<Side<dim>>  &sides)
  {
    const auto [far, nearest] = far_points(points, sides, tissue, 1.);
    std::vector<double> list(points.size(), 1.);
    for (std::size_t k = 0; k < far.size(); ++k)
      {
        const auto &[x, F, reach] = nearest[k];
        list[far[k]] = attachment(points[far[k]].distance(x), reach);
      }
    return list;
  }

  template <int dim>
  std::vector<unsigned int>
  detached_points(const Tissue<dim> &tissue)
  {
    const std::vector<Point<dim>> positions =
      tissue.boundary_points().positions();
    const auto [far, nearest] = far_points(positions,
                                           tissue.boundary_points().sides(),
                                           tissue,
                                           most_reaches);
    std::vector<unsigned int> found;
    for (std::size_t k = 0; k < far.size(); ++k)
      if (way_back(positions[far[k]], nearest[k]).norm() > 0.)
        found.push_back(far[k]);
    return found;
  }

  template <int dim>
  std::uint64_t
  pull_back_detached_points(Tissue<dim> &tissue)
  {
    const BoundaryPoints<dim> &points    = tissue.boundary_points();
    std::vector<Point<dim>>    positions = points.positions();
    const auto [far, nearest] =
      far_points(positions, points.sides(), tissue, most_reaches);

    std::uint64_t n = 0;
    for (std::size_t k = 0; k < far.size(); ++k)
      {
        const unsigned int   p   = far[k];
        const Tensor<1, dim> way = way_back(positions[p], nearest[k]);
        // Fixed points stay where they are held.
        if (way.norm() == 0. || points.condition(p) == SurfaceCondition::fixed)
          continue;
        ++n;
        positions[p] +=
          free_part(points[p], (1. - farthest(nearest[k]) / way.norm()) * way);
        tissue.boundary_point(p).set(points.columns().deformation,
                                     std::get<1>(nearest[k]));
      }
    n = Utilities::MPI::sum(n, tissue.communicator());
    // Points may change their grid cell and their rank, so the move is one of
    // all ranks, or of none.
    if (n > 0)
      tissue.move(tissue.cells().positions(), positions);
    return n;
  }

  template <int dim>
  std::uint64_t
  pull_to_cells(Tissue<dim> &tissue, const double farthest)
  {
    // As in pull_back_detached_points(), with one distance for all cells: first
    // the points without a cell of this rank within it, then, if any rank has
    // some, the nearest cells of all ranks. A point is moved along the way to
    // its cell until it is as near as allowed; slip points take only the part
    // of the way in their plane.
    const BoundaryPoints<dim>      &points    = tissue.boundary_points();
    const Cells<dim>               &cells     = tissue.cells();
    std::vector<Point<dim>>         positions = points.positions();
    const std::vector<unsigned int> far =
      points_without_cell(positions, tissue, farthest, points.sides());
    if (!Utilities::MPI::logical_or(!far.empty(), tissue.communicator()))
      return 0;
    const auto [queries, sides] = selected(far, positions, points.sides());
    const auto nearest          = nearest_values(
      queries,
      cells,
      [&cells](const unsigned int p) { return cells.position(p); },
      Ties::lowest_id,
      tissue.grid(),
      sides);
    std::uint64_t n = 0;
    for (std::size_t k = 0; k < far.size(); ++k)
      {
        const unsigned int   p        = far[k];
        const Tensor<1, dim> way      = nearest[k] - positions[p];
        const double         distance = way.norm();
        if (distance <= farthest ||
            points.condition(p) == SurfaceCondition::fixed)
          continue;
        ++n;
        positions[p] += free_part(points[p], (1. - farthest / distance) * way);
      }
    n = Utilities::MPI::sum(n, tissue.communicator());
    if (n > 0)
      tissue.move(cells.positions(), positions);
    return n;
  }

  MORULA_INSTANTIATE(largest_distance);
  MORULA_INSTANTIATE(surface_reach);
  MORULA_INSTANTIATE(detached_points);
  MORULA_INSTANTIATE(pull_back_detached_points);
  MORULA_INSTANTIATE(pull_to_cells);
  MORULA_INSTANTIATE(attachment);


  template <int dim>
  SurfaceFit
  surface_fit(const Tissue<dim> &tissue, const std::optional<double> &volume)
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
    for (unsigned int p = 0; p < tissue.cells().size() && !volume; ++p)
      sums[2] += tissue.cells().volume(p);
    Utilities::MPI::sum(sums, tissue.communicator(), sums);

    SurfaceFit fit;
    fit.cells = volume.value_or(sums[2]);
    if (!(sums[0] > 0.) || !(fit.cells > 0.))
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
