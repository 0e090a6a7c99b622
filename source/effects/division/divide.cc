// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/send_records.h>
#include <morula/effects/division/divide.h>
#include <morula/particles/point_exchange.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

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
} // namespace Morula
