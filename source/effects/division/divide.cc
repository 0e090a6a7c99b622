// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/send_records.h>
#include <morula/effects/division/divide.h>
#include <morula/particles/point_exchange.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Morula
{
  namespace
  {
    /** The dividing cells as daughter_distances() sees them. */
    template <int dim>
    std::vector<DividingCell<dim>>
    dividing_cells(const Tissue<dim>               &tissue,
                   const CellDevelopment<dim>      &development,
                   const std::vector<unsigned int> &due)
    {
      const Cells<dim>              &cells = tissue.cells();
      std::vector<DividingCell<dim>> list;
      for (const unsigned int p : due)
        list.push_back({cells.id(p),
                        cells.position(p),
                        development.placement_axis(cells[p]),
                        std::pow(cells.volume(p), 1. / dim)});
      return list;
    }

    /** Ids and positions of this rank's cells and those within reach. */
    template <int dim>
    PointList<dim>
    neighborhood(const Tissue<dim> &tissue, const double reach)
    {
      // The halo holds the cells of other ranks that may be within reach of
      // this rank's grid cells. A rank with no dividing cell takes part, too,
      // since the exchange is collective.
      PointList<dim> points;
      for (unsigned int p = 0; p < tissue.cells().size(); ++p)
        points.add(tissue.cells().id(p), tissue.cells().position(p), {});
      points.append(halo(points, tissue.grid(), reach));
      return points;
    }

    /** Fixed and slip boundary points of this rank, or all with
     *  @p whole_surface, and those of others whose wall a ray of length
     *  @p longest may hit. */
    template <int dim>
    std::vector<WallPoint<dim>>
    walls(const Tissue<dim> &tissue,
          const double       longest,
          const bool         whole_surface)
    {
      // A patch is its present normal and its spacing.
      using Patch = std::tuple<Tensor<1, dim>, double>;
      // This rank's walls come first, then the halo with those of other ranks.
      // A wall counts where the ray hits it within its own spacing, so the
      // reach is the longest ray plus the largest spacing of all ranks.
      const BoundaryPoints<dim> &store = tissue.boundary_points();
      PointList<dim>             points(Flat<Patch>::n);
      double                     largest_spacing = 0.;
      for (unsigned int p = 0; p < store.size(); ++p)
        {
          const auto point = store[p];
          if (!whole_surface && !is_held(point.condition()))
            continue;
          const Tensor<1, dim> area    = point.area_vector();
          const double         spacing = point.spacing();
          points.add_value(store.id(p),
                           store.position(p),
                           Patch(area / area.norm(), spacing));
          largest_spacing = std::max(largest_spacing, spacing);
        }
      largest_spacing =
        Utilities::MPI::max(largest_spacing, tissue.communicator());
      points.append(halo(points, tissue.grid(), longest + largest_spacing));
      std::vector<WallPoint<dim>> list;
      for (std::size_t i = 0; i < points.size(); ++i)
        {
          const auto [normal, spacing] = points.template value<Patch>(i);
          list.push_back({points.positions[i], normal, spacing});
        }
      return list;
    }

    /**
     * Halves the shape of a daughter, doc/theory.md (6.10b); nothing if the
     * shape of cells is not followed.
     * @param daughter has the shape of her mother, and her F
     * @param axis     unit vector from one daughter to the other, in the
     *                 present configuration
     */
    template <int dim>
    void
    halve_shape(const CellView<dim, double> &daughter,
                const Tensor<1, dim>        &axis)
    {
      // V⁰ has the volume, so the determinant of the shape is kept at 1.
      const Column<Tensor<2, dim>> &shape = daughter.columns().shape;
      if (!shape.exists())
        return;
      const Tensor<2, dim> whole = daughter.shape();
      const Tensor<2, dim> half =
        whole - 0.5 * outer_product(axis, axis * whole);
      daughter.set(shape,
                   std::pow(2., 1. / dim) *
                     (invert(daughter.unrelaxed_deformation()) * half));
    }
  } // namespace


  std::vector<types::particle_index>
  number_daughters(const std::vector<DivisionEvent> &events,
                   types::particle_index            &next_id,
                   const MPI_Comm                    comm)
  {
    // The places of this rank's events among those of all ranks say which pairs
    // of ids they get. All ranks advance the next free id alike.
    const GlobalOrder order = global_order(events, comm);

    std::vector<types::particle_index> first_daughters;
    first_daughters.reserve(events.size());
    for (const std::uint64_t place : order.places)
      first_daughters.push_back(next_id + 2 * place);
    next_id += 2 * order.n_keys;
    return first_daughters;
  }


  template <int dim>
  std::vector<unsigned int>
  cells_due(const Tissue<dim>          &tissue,
            const CellDevelopment<dim> &development,
            const double                t)
  {
    const Cells<dim>         &cells = tissue.cells();
    std::vector<unsigned int> due;
    for (unsigned int p = 0; p < cells.size(); ++p)
      if (std::isfinite(development.time_of_division(cells[p], t)))
        due.push_back(p);
    return due;
  }

  template <int dim>
  std::vector<Birth<dim>>
  divide(Tissue<dim>                     &tissue,
         const CellDevelopment<dim>      &development,
         const std::vector<unsigned int> &due,
         const double                     t1,
         types::particle_index           &next_id,
         std::vector<CellEvent>          &events)
  {
    // First come the places of daughters, which need neighbours and walls of
    // other ranks, then the numbers of daughters, which need the divisions of
    // all ranks. Both are collective, so every rank comes here if one has a
    // dividing cell. Only then are rows made, all from the configuration before
    // the divisions. The mothers go and the daughters come in a single last
    // pass, since that one renumbers the cells of the rank.
    const MPI_Comm          comm     = tissue.communicator();
    const Cells<dim>       &cells    = tissue.cells();
    const CellColumns<dim> &columns  = cells.columns();
    const auto              dividing = dividing_cells(tissue, development, due);
    double                  longest  = 0.;
    for (const auto &cell : dividing)
      longest = std::max(longest, cell.length);
    longest = Utilities::MPI::max(longest, comm);

    // A wall farther than a cell's length counts as absent, and the wall
    // against a neighbour is at least at half its distance. So neighbours
    // within two lengths make all walls: doc/theory.md (6.5).
    // Daughters stay inside the whole surface, or only inside its held parts.
    const PointList<dim> neighbors = neighborhood(tissue, 2. * longest);
    const auto          &axes      = development.fates().dividing->axes;
    const auto           distances =
      daughter_distances(dividing,
                         neighbors.ids,
                         neighbors.positions,
                         walls(tissue, longest, axes && axes->stay_inside),
                         tissue.grid().box());

    std::vector<DivisionEvent> divisions;
    for (const unsigned int p : due)
      divisions.push_back(
        {development.time_of_division(cells[p], t1), cells.id(p)});
    // Ids follow the exact times on all ranks, not the ranks or the order of
    // cells on them, so that any number of ranks gives the same cells.
    const auto first_ids = number_daughters(divisions, next_id, comm);

    PointList<dim>          daughters(columns.n_numbers());
    std::vector<Birth<dim>> births;
    for (std::size_t k = 0; k < due.size(); ++k)
      {
        const auto         mother     = cells[due[k]];
        const unsigned int generation = mother.generation() + 1;
        for (unsigned int which = 0; which < 2; ++which)
          {
            // The columns' rules make the row: most values are copied, V⁰ is
            // halved. What they cannot know, as parent and generation, is set
            // after them.
            std::vector<double>         row = columns.daughter(mother.row());
            const CellView<dim, double> daughter(make_array_view(row), columns);
            daughter.set(columns.parent, static_cast<int>(divisions[k].mother));
            daughter.set(columns.generation, generation);
            halve_shape(daughter, dividing[k].axis);

            const Point<dim> position =
              dividing[k].position +
              (which == 0 ? -1. : 1.) * distances[k][which] * dividing[k].axis;
            const auto id = first_ids[k] + which;
            // The division lies before the end of the step, by up to a whole
            // step. She lives that time here, so that an onset or a change of
            // type in it is not lost.
            const unsigned int type = development.make_daughter(
              daughter, id, position, which, divisions[k].time, t1, events);
            daughters.add(id, position, make_array_view(row));
            const CellView<dim, const double> born(
              make_array_view(std::as_const(row)), columns);
            births.push_back({id,
                              static_cast<int>(divisions[k].mother),
                              generation,
                              divisions[k].time,
                              position,
                              type,
                              development.state().named_numbers(&born)});
          }
      }
    tissue.replace(due, daughters);
    return births;
  }

  MORULA_INSTANTIATE(cells_due);
  MORULA_INSTANTIATE(divide);


  namespace
  {
    /** What counts as touching, as a fraction of the cell's length. */
    constexpr double contact = 1e-3;

    /** How far a cell may stand outside a half-space and still be bounded by
     *  it, as a fraction of its length. */
    constexpr double deepest_overlap = 0.1;

    /** Relative slack of searches, so that rounding cannot hide a candidate. */
    constexpr double search_slack = 1e-9;

    /** Distances of the nearest walls along -axis and +axis, none farther than
     *  the cell's length; infinite where there is none. */
    using WallDistances = std::array<double, 2>;

    void
    take_nearer(double &nearest, const double distance, const double cap)
    {
      if (distance <= cap)
        nearest = std::min(nearest, distance);
    }


    /**
     * Where the rays from a cell meet a half-space of the Dirichlet boundary. A
     * cell on or beyond it counts as standing 1e-3 lengths inside: daughters
     * neither leave nor coincide.
     */
    template <int dim>
    void
    meet_dirichlet_wall(const DividingCell<dim> &cell,
                        const WallPoint<dim>    &wall,
                        WallDistances           &distances)
    {
      // The half-space is behind the plane through the point with the outward
      // normal. The ray that goes outward meets it at depth/|axis·normal|, and
      // only that one of the two. The hit counts near the point alone, since
      // the plane stands for the surface only there.
      const double depth = (wall.position - cell.position) * wall.normal;
      // A cell far behind the plane belongs to another part of the body, which
      // this plane does not bound.
      if (depth < -deepest_overlap * cell.length)
        return;

      const double slope = cell.axis * wall.normal;
      if (slope == 0.)
        return;

      const double distance =
        std::max(depth, contact * cell.length) / std::abs(slope);
      const Point<dim> hit =
        cell.position + (slope > 0. ? distance : -distance) * cell.axis;
      if (hit.distance(wall.position) <= wall.spacing)
        take_nearer(distances[slope > 0.], distance, cell.length);
    }


    /**
     * Where the rays from a cell meet the wall against a neighbour. It is no
     * nearer than half the neighbour's distance, so that neighbours within
     * twice the cell's length hold all walls that count. Being a minimum over
     * these, the result does not depend on the order of the points.
     *
     * Neighbours within 1e-3 lengths count as coinciding and bound nothing; a
     * wall is therefore at least 5e-4 lengths away.
     */
    template <int dim>
    void
    meet_voronoi_wall(const DividingCell<dim> &cell,
                      const Point<dim>        &neighbor,
                      WallDistances           &distances)
    {
      // The wall is the plane half way to the neighbour, and a ray meets it at
      // |r|²/(2 |r·n|): doc/theory.md (6.5). The sign of r·n says which ray
      // does.
      const Tensor<1, dim> r     = neighbor - cell.position;
      const double         along = r * cell.axis;
      if (r.norm() >= contact * cell.length && along != 0.)
        take_nearer(distances[along > 0.],
                    r.norm_square() / (2. * std::abs(along)),
                    cell.length);
    }


    /** Equations (16), (19), (20): half way to the walls. */
    std::array<double, 2>
    place_daughters(const WallDistances &distances, const double length)
    {
      // A side without a wall takes the distance of the other one, equation
      // (19) of the paper. A cell without walls has its daughters a quarter of
      // its length away, (20), which is what walls at half a length on both
      // sides would give.
      const double nearer = std::min(distances[0], distances[1]);
      const double instead =
        std::isfinite(nearer) ? 0.5 * nearer : 0.25 * length;
      const auto place = [&](const double distance) {
        return std::isfinite(distance) ? 0.5 * distance : instead;
      };
      return {{place(distances[0]), place(distances[1])}};
    }
  } // namespace


  template <int dim>
  std::vector<std::array<double, 2>>
  daughter_distances(const std::vector<DividingCell<dim>>     &dividing,
                     const std::vector<types::particle_index> &ids,
                     const std::vector<Point<dim>>            &positions,
                     const std::vector<WallPoint<dim>>        &walls,
                     const GridBox<dim>                       &box)
  {
    AssertDimension(ids.size(), positions.size());

    std::vector<std::array<double, 2>> result;
    if (dividing.empty())
      return result;
    result.reserve(dividing.size());

    // Cells and walls are sorted into bins first, so that each dividing cell
    // looks only at those near it. The search for walls must reach as far as
    // the largest spacing beyond the cell's length, because a hit may be that
    // far from its point. Each visit takes the minimum over what it finds, so
    // the order of points and the copies from other ranks do not matter.
    double                  largest_spacing = 0.;
    std::vector<Point<dim>> wall_positions;
    for (const WallPoint<dim> &wall : walls)
      {
        largest_spacing = std::max(largest_spacing, wall.spacing);
        wall_positions.push_back(wall.position);
      }
    const PointBins<dim> cell_bins(box, positions);
    const PointBins<dim> wall_bins(box, wall_positions);

    for (const DividingCell<dim> &cell : dividing)
      {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        WallDistances    distances{{infinity, infinity}};
        if (!walls.empty())
          wall_bins.visit_within(
            cell.position,
            (1. + search_slack) * (cell.length + largest_spacing),
            [&](const unsigned int w) {
              meet_dirichlet_wall(cell, walls[w], distances);
            });
        cell_bins.visit_within(cell.position,
                               2. * (1. + search_slack) * cell.length,
                               [&](const unsigned int q) {
                                 if (ids[q] != cell.id)
                                   meet_voronoi_wall(cell,
                                                     positions[q],
                                                     distances);
                               });
        result.push_back(place_daughters(distances, cell.length));
      }
    return result;
  }


  MORULA_INSTANTIATE(daughter_distances);
} // namespace Morula
