// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/division/divide.h>
#include <morula/effects/division/numbering.h>
#include <morula/effects/division/wall_distance.h>
#include <morula/particles/boundary_state.h>
#include <morula/particles/point_exchange.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace Morula
{
  namespace
  {
    /** The dividing cells as the Voronoi room sees them. */
    template <int dim>
    std::vector<DividingCell<dim>>
    dividing_cells(const Tissue<dim>               &tissue,
                   const CellCycle<dim>            &cycle,
                   const std::vector<unsigned int> &due)
    {
      std::vector<DividingCell<dim>> list;
      for (const unsigned int i : due)
        {
          const auto &particle                   = tissue.cells().order()[i];
          const CellView<dim, const double> cell = tissue.cell(particle);
          list.push_back({particle->get_id(),
                          particle->get_location(),
                          cycle.placement_axis(CycleState<dim>::load(cell),
                                               elastic_deformation(cell)),
                          std::pow(volume(cell), 1. / dim)});
        }
      return list;
    }

    /** Ids and positions of this rank's cells and those within reach. */
    template <int dim>
    PointList<dim>
    neighborhood(const Tissue<dim> &tissue, const double reach)
    {
      PointList<dim> points;
      for (const auto &particle : tissue.cells().order())
        {
          points.ids.push_back(particle->get_id());
          points.positions.push_back(particle->get_location());
        }
      const PointList<dim> others = halo(points, tissue.grid(), reach);
      points.ids.insert(points.ids.end(), others.ids.begin(), others.ids.end());
      points.positions.insert(points.positions.end(),
                              others.positions.begin(),
                              others.positions.end());
      return points;
    }

    /** Fixed and slip boundary points of this rank, and those of others whose
     *  wall a ray of length @p longest may hit. */
    template <int dim>
    std::vector<WallPoint<dim>>
    walls(const Tissue<dim> &tissue, const double longest)
    {
      PointList<dim> points;
      double         largest_spacing = 0.;
      points.n_slots                 = dim + 1;
      for (const auto &particle : tissue.boundary_points().order())
        {
          const BoundaryView<dim> point(boundary_properties<dim>(particle));
          if (point.condition() != SurfaceCondition::fixed &&
              point.condition() != SurfaceCondition::slip)
            continue;
          points.ids.push_back(particle->get_id());
          points.positions.push_back(particle->get_location());
          const Tensor<1, dim> area = point.area_vector();
          for (unsigned int d = 0; d < dim; ++d)
            points.properties.push_back(area[d] / area.norm());
          points.properties.push_back(point.spacing());
          largest_spacing = std::max(largest_spacing, points.properties.back());
        }
      std::vector<WallPoint<dim>> list;
      largest_spacing =
        Utilities::MPI::max(largest_spacing, tissue.communicator());
      const PointList<dim> others =
        halo(points, tissue.grid(), longest + largest_spacing);
      for (const PointList<dim> *from :
           std::array<const PointList<dim> *, 2>{{&points, &others}})
        for (std::size_t i = 0; i < from->size(); ++i)
          {
            const double  *slots = &from->properties[i * from->n_slots];
            Tensor<1, dim> normal;
            for (unsigned int d = 0; d < dim; ++d)
              normal[d] = slots[d];
            list.push_back({from->positions[i], normal, slots[dim]});
          }
      return list;
    }
  } // namespace

  template <int dim>
  std::vector<unsigned int>
  cells_due(const Tissue<dim>    &tissue,
            const CellCycle<dim> &cycle,
            const double          t)
  {
    std::vector<unsigned int> due;
    for (unsigned int i = 0; i < tissue.cells().order().size(); ++i)
      {
        const auto cell = tissue.cell(tissue.cells().order()[i]);
        if (cycle.divides(CycleState<dim>::load(cell),
                          cell.founder_position(),
                          t))
          due.push_back(i);
      }
    return due;
  }

  template <int dim>
  std::vector<Birth<dim>>
  divide(Tissue<dim>                     &tissue,
         const CellCycle<dim>            &cycle,
         const std::vector<unsigned int> &due,
         types::particle_index           &next_id)
  {
    const MPI_Comm comm     = tissue.communicator();
    const auto     dividing = dividing_cells(tissue, cycle, due);
    double         longest  = 0.;
    for (const auto &cell : dividing)
      longest = std::max(longest, cell.length);
    longest = Utilities::MPI::max(longest, comm);

    const PointList<dim> neighbors = neighborhood(tissue, 2. * longest);
    const auto           distances = daughter_distances(dividing,
                                              neighbors.ids,
                                              neighbors.positions,
                                              walls(tissue, longest),
                                              tissue.grid().box());

    std::vector<DivisionEvent>                      events;
    std::vector<typename PointStore<dim>::Iterator> mothers;
    for (const unsigned int i : due)
      {
        mothers.push_back(tissue.cells().order()[i]);
        const auto cell = tissue.cell(mothers.back());
        events.push_back({cycle.division_time(CycleState<dim>::load(cell),
                                              cell.founder_position()),
                          mothers.back()->get_id()});
      }
    const auto first_ids = number_daughters(events, next_id, comm);

    PointList<dim>          daughters;
    std::vector<Birth<dim>> births;
    const CellSlots<dim>   &slots = tissue.slots();
    daughters.n_slots             = slots.n_slots;
    for (std::size_t k = 0; k < mothers.size(); ++k)
      {
        const CellView<dim, const double> mother = tissue.cell(mothers[k]);
        const auto [minus, plus] =
          cycle.daughters(CycleState<dim>::load(mother));
        for (unsigned int which = 0; which < 2; ++which)
          {
            std::vector<double>         properties(mother.raw().begin(),
                                           mother.raw().end());
            const CellView<dim, double> daughter(make_array_view(properties),
                                                 slots);
            (which == 0 ? minus : plus).store(daughter);
            daughter.set_scalar(slots.initial_volume,
                                0.5 * mother.initial_volume());
            daughter.set_scalar(slots.parent, events[k].mother);
            daughter.set_scalar(slots.generation, mother.generation() + 1);

            const Point<dim> position =
              dividing[k].position +
              (which == 0 ? -1. : 1.) * distances[k][which] * dividing[k].axis;
            daughters.ids.push_back(first_ids[k] + which);
            daughters.positions.push_back(position);
            daughters.properties.insert(daughters.properties.end(),
                                        properties.begin(),
                                        properties.end());
            births.push_back({first_ids[k] + which,
                              static_cast<int>(events[k].mother),
                              mother.generation() + 1,
                              events[k].time,
                              position});
          }
      }
    tissue.replace(mothers, daughters);
    return births;
  }

#define INSTANTIATE(dim)                                                   \
  template std::vector<unsigned int> cells_due(const Tissue<dim> &,        \
                                               const CellCycle<dim> &,     \
                                               const double);              \
  template std::vector<Birth<dim>>   divide(Tissue<dim> &,                 \
                                            const CellCycle<dim> &,        \
                                            const std::vector<unsigned> &, \
                                            types::particle_index &);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
