// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/near_tree.h>
#include <morula/base/rounded_sums.h>
#include <morula/particles/point_exchange.h>
#include <morula/surface/cell_surface.h>
#include <morula/surface/surface_from_cells.h>

#include <deal.II/base/symmetric_tensor.h>

#include <functional>
#include <set>

namespace Morula
{
  namespace
  {
    /** How far a held point hands on its gap, in spacings of the lattice. */
    constexpr double reach_of_gap = 3.;

    /** The least part of a patch's area that goes to another wall, and the
     * least that is free beside a wall: less is unevenness. */
    constexpr double slight = 0.05, uneven = 0.3;

    /** How far before a wall cells end that stand at it, and in the rounded
     *  corner with another one, in spacings of the lattice. */
    constexpr double at_wall = 1., at_corner = 3.;

    /** How far patches move at most to enclose the volume, in spacings of the
     *  lattice. */
    constexpr double farthest = 1.;

    /** The new boundary points of a body. */
    template <int dim>
    class NewPoints
    {
    public:
      /** Collective. */
      NewPoints(const Tissue<dim>      &tissue,
                const SurfaceWish<dim> &wish,
                const CellSurface<dim> &surface)
        : columns(tissue.boundary_points().columns())
        , wish(wish)
        , surface(surface)
        , former(wish.former)
        , list(columns.n_numbers())
      {
        // A list by id lets the lowest one of equally near points count.
        former.append(halo(wish.former, tissue.grid(), wish.reach));
        former = by_id(former);
        tree.emplace(former.positions);
      }

      /** Whether some patch of this rank has none of the points that are there
       *  still: the nearest former one was lost, or there is none. */
      bool
      has_cut(PointList<dim> present, const BackgroundGrid<dim> &grid) const
      {
        present.append(halo(present, grid, wish.reach));
        const std::set<types::particle_index> ids(present.ids.begin(),
                                                  present.ids.end());
        for (std::size_t k = 0; k < surface.positions.size(); ++k)
          {
            const auto i = nearest(surface.positions[k],
                                   surface.areas[k],
                                   wish.reach,
                                   [](const SurfaceCondition) { return true; });
            if (!i || ids.count(former.ids[*i]) == 0)
              return true;
          }
        return false;
      }

      /** Adds patch number @p k, as several points where it stands on a wall:
       *  the part of its area that faces this does so, while the rest, where
       *  the surface bends away, goes to the next wall or is free. */
      void
      add_patch(const std::size_t k, const types::particle_index id)
      {
        const double   area = surface.areas[k].norm();
        Tensor<1, dim> left = surface.areas[k];
        for (unsigned int part = 0; part < dim && left.norm() > slight * area;
             ++part)
          {
            Point<dim>                               x = surface.positions[k];
            Tensor<1, dim>                           A = left;
            std::optional<typename Walls<dim>::Foot> foot;
            if (wish.walls)
              foot = wish.walls->at(wish.body,
                                    x,
                                    A / A.norm(),
                                    surface.offset,
                                    surface.edge,
                                    part == 0 ? at_wall : at_corner);
            if (!foot && part > 0 && left.norm() < uneven * area)
              return;
            auto row =
              foot ? put_on_wall(*foot, x, A) : free_row(x, A, part > 0);
            if (cavity.exists())
              cavity.set(make_array_view(row),
                         faced_cavity(wish.body, surface.faced[k]));
            list.add(id + part, x, make_array_view(row));
            areas.push_back(A);
            is_free.push_back(!foot);
            left -= A;
          }
      }

      /**
       * Corrects points that are on no wall so that with all others they are
       * closed and enclose the volume: their areas in proportion, and their
       * places by one distance along their normals. Collective.
       */
      void
      close_and_enclose(const Point<dim> &apex, const MPI_Comm comm)
      {
        // The sums are the area vector of all, the area of those that change,
        // and the volume, then its change. The lattice's spacing is the unit.
        const double unit = Utilities::fixed_power<dim - 1>(surface.edge);
        const auto   flux = [&](const std::size_t i, const Tensor<1, dim> &A) {
          return (list.positions[i] - apex) * A / (dim * unit * surface.edge);
        };
        RoundedSums sums(dim + 2, comm), after(2, comm);
        for (std::size_t i = 0; i < areas.size(); ++i)
          {
            for (unsigned int d = 0; d < dim; ++d)
              sums.add(d, areas[i][d] / unit);
            sums.add(dim, is_free[i] ? areas[i].norm() / unit : 0.);
            sums.add(dim + 1, flux(i, areas[i]));
          }
        const std::vector<double> first = sums.all();
        if (first[dim] == 0.)
          return;
        Tensor<1, dim> opening;
        for (unsigned int d = 0; d < dim; ++d)
          opening[d] = first[d] / first[dim];
        for (std::size_t i = 0; i < areas.size(); ++i)
          if (is_free[i])
            {
              const Tensor<1, dim> change = -areas[i].norm() * opening;
              after.add(0, flux(i, change));
              areas[i] += change;
              after.add(1, areas[i].norm() / unit);
            }
        // A way along the normals counts by 1/dim of the area, as the flux of x
        // does.
        const std::vector<double> second = after.all();
        const double              missing =
          surface.volume / (unit * surface.edge) - first[dim + 1] - second[0];
        const double way =
          surface.edge *
          std::clamp(dim * missing / second[1], -farthest, farthest);
        for (std::size_t i = 0; i < areas.size(); ++i)
          if (is_free[i])
            list.positions[i] += way / areas[i].norm() * areas[i];
      }

      /** All of them, with their patches. */
      const PointList<dim> &
      finished()
      {
        for (std::size_t i = 0; i < areas.size(); ++i)
          {
            const auto row = list.row(i);
            columns.set_square_patch(row,
                                     columns.deformation.get(row),
                                     areas[i]);
            if (columns.body.exists())
              columns.body.set(row, wish.body);
          }
        return list;
      }

    private:
      /** The nearest former point of the side of @p n within @p distance (µm)
       *  whose condition @p counts. */
      std::optional<unsigned int>
      nearest(const Point<dim>                            &x,
              const Tensor<1, dim>                        &n,
              const double                                 distance,
              const std::function<bool(SurfaceCondition)> &counts) const
      {
        const auto i = tree->nearest(x, [&](const unsigned int i) {
          const BoundaryView<dim> point(former.row(i), columns);
          return counts(point.condition()) && point.area_vector() * n > 0.;
        });
        return i && x.distance(former.positions[*i]) <= distance ? i :
                                                                   std::nullopt;
      }

      /** The row of a point on a wall, its place and area there. */
      std::vector<double>
      put_on_wall(const typename Walls<dim>::Foot &foot,
                  Point<dim>                      &x,
                  Tensor<1, dim>                  &A) const
      {
        // The gap of the nearest held point goes on, so that no force jumps. A
        // slip point has one along its normal only.
        const Wall<dim>     &wall = *foot.wall;
        const Tensor<1, dim> N    = wall.N;
        A                         = (A * N) * N;
        x                         = foot.X + wall.motion;
        if (const auto i = nearest(x, N, reach_of_gap * surface.edge, is_held))
          {
            const Tensor<1, dim> gap =
              former.positions[*i] -
              columns.initial_position.get(former.row(*i)) - wall.motion;
            x += wall.condition == SurfaceCondition::slip ? (gap * N) * N : gap;
          }
        return columns.initial_point(foot.X, N, A.norm(), wall.condition);
      }

      /** The row of a point that no wall holds. What is left beside a wall has
       *  its place there, but not its normal: the scene's words do not hold
       *  it. */
      std::vector<double>
      free_row(const Point<dim>     &x,
               const Tensor<1, dim> &A,
               const bool            is_rest) const
      {
        // Only the geometry begins anew, a force is one of the area, and a dead
        // load is one of the area of t = 0.
        const Tensor<1, dim> n = A / A.norm();
        const auto           i =
          nearest(x, n, wish.reach, [](const SurfaceCondition condition) {
            return !is_held(condition);
          });
        SurfaceCondition condition = wish.scene.of_new(x, n);
        if (is_rest && is_held(condition))
          condition = SurfaceCondition::free;
        if (!i)
          return columns.initial_point(x, n, A.norm(), condition);
        std::vector<double> row(former.row(*i).begin(), former.row(*i).end());
        const BoundaryView<dim, double> point(make_array_view(row), columns);
        const double                    before = point.area_vector().norm();
        if (columns.force.exists())
          point.set(columns.force,
                    A.norm() / before * point.get(columns.force));
        const double stretch =
          wish.present ?
            std::pow(before / point.initial_area(), 1. / (dim - 1)) :
            1.;
        point.set(columns.deformation,
                  stretch * Tensor<2, dim>(unit_symmetric_tensor<dim>()));
        return row;
      }

      const BoundaryColumns<dim>  &columns;
      const SurfaceWish<dim>      &wish;
      const CellSurface<dim>      &surface;
      PointList<dim>               former; // near this rank's part, by id
      std::optional<NearTree<dim>> tree;
      PointList<dim>               list;
      const Column<unsigned int>   cavity = columns.cavity;
      std::vector<Tensor<1, dim>>  areas; // outward, µm^(dim-1)
      std::vector<bool>            is_free;
    };
  } // namespace


  template <int dim>
  PointList<dim>
  surface_from_cells(const Tissue<dim>      &tissue,
                     const SurfaceWish<dim> &wish,
                     types::particle_index  &next_id)
  {
    const GridBox<dim> &box   = tissue.grid().box();
    const Cells<dim>   &cells = tissue.cells();
    PointList<dim>      volumes(1);
    for (unsigned int p = 0; p < cells.size(); ++p)
      if (cells.body(p) == wish.body)
        volumes.add_value(cells.id(p), cells.position(p), cells.volume(p));
    const CellSurface<dim> surface =
      surface_of_cells(volumes, tissue.grid(), {wish.share});
    NewPoints<dim> points(tissue, wish, surface);
    if (wish.present &&
        !Utilities::MPI::logical_or(
          points.has_cut(*wish.present, tissue.grid()), tissue.communicator()))
      return *wish.present;
    for (std::size_t k = 0; k < surface.positions.size(); ++k)
      points.add_patch(k, next_id + dim * surface.places[k]);
    next_id += dim * surface.n_patches;
    points.close_and_enclose(box.corner(box.first()), tissue.communicator());
    return points.finished();
  }

  MORULA_INSTANTIATE(surface_from_cells);
} // namespace Morula
