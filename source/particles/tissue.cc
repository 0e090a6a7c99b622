// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/particles/cell_domain.h>
#include <morula/particles/tissue.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace Morula
{
  namespace
  {
    /** Load of the fullest rank over the mean that is put up with. */
    constexpr double worst_imbalance = 1.15;

    /** Corners of the domains of cells, whose states are state(i): the grid
     *  must reach as far. */
    template <int dim, typename State>
    std::vector<Point<dim>>
    domain_corners(const std::vector<Point<dim>> &positions, const State &state)
    {
      std::vector<Point<dim>> corners;
      corners.reserve(2 * positions.size());
      for (std::size_t i = 0; i < positions.size(); ++i)
        {
          const auto bounds = cell_domain(positions[i], state(i)).bounds();
          corners.push_back(bounds.first);
          corners.push_back(bounds.second);
        }
      return corners;
    }

    template <int dim>
    std::vector<Point<dim>>
    domain_corners(const PointList<dim> &cells, const CellSlots<dim> &slots)
    {
      return domain_corners(cells.positions, [&](const std::size_t i) {
        return CellView<dim, const double>(
          ArrayView<const double>(&cells.properties[i * cells.n_slots],
                                  cells.n_slots),
          slots);
      });
    }
  } // namespace

  template <int dim>
  Tissue<dim>::Tissue(const GridParameters &parameters,
                      const CellSlots<dim> &slots,
                      const MPI_Comm        comm,
                      const unsigned int    n_boundary_slots)
    : parameters(parameters)
    , slots_(slots)
    , grid_(parameters, comm)
    , cells_(slots.n_slots)
    , boundary_points_(n_boundary_slots)
  {}

  template <int dim>
  bool
  Tissue<dim>::balanced(const std::vector<unsigned int> &counts) const
  {
    const unsigned int n_ranks =
      Utilities::MPI::n_mpi_processes(grid_.communicator());
    if (n_ranks == 1)
      return true;
    std::vector<double> loads(n_ranks, 0.);
    for (unsigned int number = 0; number < counts.size(); ++number)
      loads[grid_.owner(number)] += counts[number];
    double total = 0., last_total = 0.;
    for (const double load : loads)
      total += load;
    for (const unsigned int weight : grid_.weights())
      last_total += weight;
    // A partition of few grid cells may not get better: try again only after
    // the tissue has changed.
    return *std::max_element(loads.begin(), loads.end()) * n_ranks <=
             worst_imbalance * total ||
           std::abs(total - last_total) <= 0.05 * last_total;
  }

  template <int dim>
  void
  Tissue<dim>::place(const PointList<dim> &cells,
                     const PointList<dim> &boundary_points)
  {
    cells_.clear();
    boundary_points_.clear();
    const std::vector<Point<dim>> corners = domain_corners(cells, slots_);
    const auto [first, last] =
      extent<dim>({&corners, &boundary_points.positions}, grid_);
    bool made_anew = !grid_.covers(first, last);
    if (made_anew)
      grid_.enclose(first, last);
    const std::vector<unsigned int> counts =
      count_points(cells.positions, grid_);
    if (made_anew || !balanced(counts))
      {
        grid_.partition(counts);
        made_anew = true;
      }
    if (made_anew)
      {
        cells_.attach(grid_);
        boundary_points_.attach(grid_);
      }
    cells_.insert(cells, grid_);
    boundary_points_.insert(boundary_points, grid_);
  }

  template <int dim>
  void
  Tissue<dim>::move(const std::vector<Point<dim>> &cells,
                    const std::vector<Point<dim>> &boundary_points)
  {
    const std::vector<Point<dim>> corners =
      domain_corners(cells, [&](const std::size_t i) {
        return cell(cells_.order()[i]);
      });
    const auto [first, last] = extent<dim>({&corners, &boundary_points}, grid_);
    if (!grid_.covers(first, last) || !balanced(count_points(cells, grid_)))
      {
        PointList<dim> all = cells_.copy(), surface = boundary_points_.copy();
        all.positions     = cells;
        surface.positions = boundary_points;
        place(all, surface);
        return;
      }
    cells_.move(cells, grid_);
    boundary_points_.move(boundary_points, grid_);
  }

  template <int dim>
  ArrayView<double>
  Tissue<dim>::cell_properties(const unsigned int p)
  {
    return cells_.properties(p);
  }

  template <int dim>
  ArrayView<double>
  Tissue<dim>::boundary_properties(const unsigned int p)
  {
    return boundary_points_.properties(p);
  }

  template <int dim>
  void
  Tissue<dim>::restore(const PointList<dim>            &cells,
                       const PointList<dim>            &boundary_points,
                       const GridIndex<dim>            &first,
                       const GridIndex<dim>            &n,
                       const std::vector<unsigned int> &weights)
  {
    grid_.make(first, n);
    grid_.partition(weights);
    cells_.attach(grid_);
    boundary_points_.attach(grid_);
    cells_.insert(cells, grid_);
    boundary_points_.insert(boundary_points, grid_);
  }

  template <int dim>
  void
  Tissue<dim>::replace(
    const std::vector<typename PointStore<dim>::Iterator> &mothers,
    const PointList<dim>                                  &daughters)
  {
    // Daughters stand next to their mothers, but that may be the box's edge.
    const std::vector<Point<dim>> corners = domain_corners(daughters, slots_);
    const auto [first, last]              = extent<dim>({&corners}, grid_);
    if (!grid_.covers(first, last))
      {
        PointList<dim> all = daughters, none;
        none.n_slots       = daughters.n_slots;
        cells_.replace(mothers, none, grid_);
        const PointList<dim> others = cells_.take();
        all.ids.insert(all.ids.end(), others.ids.begin(), others.ids.end());
        all.positions.insert(all.positions.end(),
                             others.positions.begin(),
                             others.positions.end());
        all.properties.insert(all.properties.end(),
                              others.properties.begin(),
                              others.properties.end());
        place(all, boundary_points_.copy());
        return;
      }
    cells_.replace(mothers, daughters, grid_);
  }

  template <int dim>
  void
  Tissue<dim>::replace_surface(const PointList<dim> &boundary_points)
  {
    const auto [first, last] = extent<dim>({&boundary_points.positions}, grid_);
    if (!grid_.covers(first, last))
      {
        place(cells_.copy(), boundary_points);
        return;
      }
    boundary_points_.clear();
    boundary_points_.insert(boundary_points, grid_);
  }

  template <int dim>
  void
  Tissue<dim>::defragment()
  {
    cells_.defragment(grid_);
    boundary_points_.defragment(grid_);
  }

  template <int dim>
  SplineSpace<dim>
  Tissue<dim>::splines(const bool share_points) const
  {
    Occupancy<dim> occupancy(grid_.box(),
                             parameters.points_per_cell,
                             share_points);
    for (const auto &particle : cells_.order())
      occupancy.add_particle(domain(particle));
    for (const auto &point : boundary_points_.order())
      occupancy.add_boundary_point(point->get_location());
    occupancy.sum(grid_.communicator());
    for (const auto &particle : cells_.order())
      occupancy.add_quadrature_points(domain(particle));
    occupancy.sum_quadrature_points(grid_.communicator());
    return SplineSpace<dim>(grid_, std::move(occupancy), parameters);
  }

  template <int dim>
  const BackgroundGrid<dim> &
  Tissue<dim>::grid() const
  {
    return grid_;
  }

  template <int dim>
  const PointStore<dim> &
  Tissue<dim>::cells() const
  {
    return cells_;
  }

  template <int dim>
  const PointStore<dim> &
  Tissue<dim>::boundary_points() const
  {
    return boundary_points_;
  }

  template <int dim>
  const CellSlots<dim> &
  Tissue<dim>::slots() const
  {
    return slots_;
  }

  template <int dim>
  CellView<dim, const double>
  Tissue<dim>::cell(const typename PointStore<dim>::Iterator &particle) const
  {
    const ArrayView<const double> properties =
      static_cast<const Particles::ParticleAccessor<dim> &>(*particle)
        .get_properties();
    return CellView<dim, const double>(properties, slots_);
  }

  template <int dim>
  ParticleDomain<dim>
  Tissue<dim>::domain(const typename PointStore<dim>::Iterator &particle) const
  {
    const auto state = cell(particle);
    return parameters.points_per_cell > 1 ?
             cell_domain(particle->get_location(), state) :
             ParticleDomain<dim>(particle->get_location(), volume(state));
  }

  template <int dim>
  MPI_Comm
  Tissue<dim>::communicator() const
  {
    return grid_.communicator();
  }

  template class Tissue<2>;
  template class Tissue<3>;
} // namespace Morula
