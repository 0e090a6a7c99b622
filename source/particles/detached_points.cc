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
#include <tuple>

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
      // looked at first.
      const GridBox<dim> &box      = tissue.grid().box();
      const auto         &store    = tissue.cells();
      double              shortest = std::numeric_limits<double>::infinity();
      const auto look_at = [&](const unsigned int number, const auto &) {
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
      const GridIndex<dim> index = box.locate(x);
      look_at(box.number(index), index);
      if (shortest > enough)
        box.for_neighbors(index, 1, look_at);
      return shortest;
    }

    /** How far a cell's part of the tissue reaches, µm: doc/theory.md (4.13).
     *  No surface of a lattice of cells lies farther from it. */
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

    /** A boundary point of this rank that may be far from the tissue, and the
     *  cell nearest to it. */
    template <int dim>
    struct FarPoint
    {
      unsigned int   p;     // in the list of points
      Tensor<1, dim> way;   // to the cell, µm
      Tensor<2, dim> F;     // of the cell
      double         reach; // its surface_reach(), µm
    };

    /** The points that have no cell of this rank within @p near (µm), at most a
     *  grid spacing, with their nearest cells of all ranks. Collective.
     *  @param squares of distances to a cell that are known already, or none */
    template <int dim>
    std::vector<FarPoint<dim>>
    far_points(const std::vector<Point<dim>> &points,
               const std::vector<Side<dim>>  &sides,
               const Tissue<dim>             &tissue,
               const double                   near,
               const std::vector<double>     &squares = {})
    {
      // Points with a cell of this rank nearby are settled without any message,
      // which is far cheaper than to find the nearest cells. Only for the
      // others ranks exchange what their cells near them have. If no rank has
      // any, no rank enters the second part.
      std::vector<FarPoint<dim>> far;
      std::vector<Point<dim>>    queries;
      std::vector<Side<dim>>     of_queries;
      for (unsigned int p = 0; p < points.size(); ++p)
        if ((squares.empty() || squares[p] > near * near) &&
            distance_square_here(points[p],
                                 sides.empty() ? nullptr : &sides[p],
                                 tissue,
                                 near * near) > near * near)
          {
            far.push_back({p, {}, {}, 0.});
            queries.push_back(points[p]);
            if (!sides.empty())
              of_queries.push_back(sides[p]);
          }
      if (!Utilities::MPI::logical_or(!far.empty(), tissue.communicator()))
        return far;
      using NearCell          = std::tuple<Point<dim>, Tensor<2, dim>, double>;
      const Cells<dim> &cells = tissue.cells();
      const double      h     = tissue.grid().box().spacing();
      const auto        value = [&](const unsigned int p) {
        return NearCell(cells.position(p),
                        cells[p].F(),
                        surface_reach<dim>(cells[p], h));
      };
      const auto nearest = nearest_values(
        queries, cells, value, Ties::lowest_id, tissue.grid(), of_queries);
      for (std::size_t k = 0; k < far.size(); ++k)
        {
          const auto &[x, F, reach] = nearest[k];
          far[k]                    = {far[k].p, x - queries[k], F, reach};
        }
      return far;
    }

    /** The largest distance from a boundary point to its nearest cell, on the
     *  point's side where it has one, µm. Collective. */
    template <int dim>
    double
    largest_distance(const Tissue<dim> &tissue)
    {
      // The first pass knows the cells of this rank only, and each point only
      // until it has a cell nearer than the largest distance so far. The
      // nearest cells of all ranks are then asked for by the few points that
      // may be the farthest ones. Where another rank's cell was nearer than the
      // first pass knew, the answers are a lower bound, and the points beyond
      // it are asked.
      const std::vector<Point<dim>> points =
        tissue.boundary_points().positions();
      const std::vector<Side<dim>> sides  = tissue.boundary_points().sides();
      const MPI_Comm               comm   = tissue.communicator();
      double                       square = 0.;
      std::vector<double>          squares;
      for (unsigned int p = 0; p < points.size(); ++p)
        {
          squares.push_back(distance_square_here(
            points[p], sides.empty() ? nullptr : &sides[p], tissue, square));
          square = std::max(square, squares.back());
        }
      // Several cells may be equally near but for rounding, and the lowest id
      // counts then: points that are farthest but for rounding are asked as
      // well.
      constexpr double equal = 1. - 1e-8;
      double largest = Utilities::MPI::max(std::sqrt(square), comm), near;
      do
        {
          // far_points() looks no farther than a grid spacing.
          near    = std::min(equal * largest, tissue.grid().box().spacing());
          largest = 0.;
          for (const auto &point :
               far_points(points, sides, tissue, near, squares))
            largest = std::max(largest, point.way.norm());
          largest = Utilities::MPI::max(largest, comm);
      } while (largest < near);
      return largest;
    }

    /** All detached points. Collective. */
    template <int dim>
    std::vector<FarPoint<dim>>
    all_detached(const Tissue<dim> &tissue)
    {
      // No reach is shorter than the distance that is looked at first. 1e-9
      // keeps a point that was pulled to the limit from being pulled again.
      const BoundaryPoints<dim> &points = tissue.boundary_points();
      const double               near =
        most_reaches * least_reach * tissue.grid().box().spacing();
      std::vector<FarPoint<dim>> list;
      for (const auto &point :
           far_points(points.positions(), points.sides(), tissue, near))
        if (point.way.norm() > most_reaches * point.reach * (1. + 1e-9))
          list.push_back(point);
      return list;
    }
  } // namespace

  template <int dim>
  std::vector<double>
  attachment(const std::vector<Point<dim>> &points,
             const Tissue<dim>             &tissue,
             const std::vector<Side<dim>>  &sides)
  {
    std::vector<double> list(points.size(), 1.);
    for (const auto &point : far_points(
           points, sides, tissue, least_reach * tissue.grid().box().spacing()))
      list[point.p] =
        std::clamp((most_reaches - point.way.norm() / point.reach) /
                     (most_reaches - 1.),
                   0.,
                   1.);
    return list;
  }

  template <int dim>
  std::vector<unsigned int>
  detached_points(const Tissue<dim> &tissue)
  {
    std::vector<unsigned int> list;
    for (const auto &point : all_detached(tissue))
      list.push_back(point.p);
    return list;
  }

  template <int dim>
  std::uint64_t
  pull_back_detached_points(Tissue<dim> &tissue)
  {
    const BoundaryPoints<dim> &points    = tissue.boundary_points();
    std::vector<Point<dim>>    positions = points.positions();
    std::uint64_t              n         = 0;
    for (const auto &[p, way, F, reach] : all_detached(tissue))
      {
        // Fixed points stay where they are held, slip points in their plane.
        if (points.condition(p) == SurfaceCondition::fixed)
          continue;
        Tensor<1, dim> motion  = (1. - most_reaches * reach / way.norm()) * way;
        const Tensor<1, dim> N = points[p].initial_normal();
        if (points.condition(p) == SurfaceCondition::slip)
          motion -= (motion * N) * N;
        positions[p] += motion;
        tissue.boundary_point(p).set(points.columns().deformation, F);
        ++n;
      }
    n = Utilities::MPI::sum(n, tissue.communicator());
    // Points may change their grid cell and their rank, so the move is one of
    // all ranks, or of none.
    if (n > 0)
      tissue.move(tissue.cells().positions(), positions);
    return n;
  }

  MORULA_INSTANTIATE(detached_points);
  MORULA_INSTANTIATE(pull_back_detached_points);
  MORULA_INSTANTIATE(attachment);


  template <int dim>
  SurfaceFit
  surface_fit(const Tissue<dim> &tissue, const std::optional<double> &volume)
  {
    // Everything follows from sums over the patches of this rank, a, a n, a x
    // and a n·x, and over its cells, V. One reduction makes them those of all
    // ranks. The enclosed volume is taken from the surface's middle, as in
    // doc/theory.md (4.8g), so that a surface that is not quite closed has the
    // same anywhere: (4.12f). Last comes the distance, which asks ranks for
    // their cells.
    double                     area = 0., flux = 0., cells = 0.;
    Tensor<1, dim>             vector, moment;
    const BoundaryPoints<dim> &points = tissue.boundary_points();
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        const Tensor<1, dim> A = points[p].area_vector();
        const Tensor<1, dim> x = points.position(p);
        area += A.norm();
        flux += A * x;
        vector += A;
        moment += A.norm() * x;
      }
    for (unsigned int p = 0; p < tissue.cells().size() && !volume; ++p)
      cells += tissue.cells().volume(p);
    using Sums =
      std::tuple<double, double, double, Tensor<1, dim>, Tensor<1, dim>>;
    std::vector<double> sums;
    append_flat(sums, Sums(area, flux, cells, vector, moment));
    Utilities::MPI::sum(sums, tissue.communicator(), sums);
    std::tie(area, flux, cells, vector, moment) = Flat<Sums>::read(sums.data());

    SurfaceFit fit;
    fit.cells = volume.value_or(cells);
    if (!(area > 0.) || !(fit.cells > 0.))
      return fit;
    for (unsigned int d = 0; d < dim; ++d)
      flux -= vector[d] * moment[d] / area;
    fit.enclosed = flux / dim;
    fit.opening  = vector.norm() / area;
    fit.distance = largest_distance(tissue);
    return fit;
  }

  MORULA_INSTANTIATE(surface_fit);
} // namespace Morula
