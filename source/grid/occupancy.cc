// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/send_records.h>
#include <morula/grid/occupancy.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace Morula
{
  namespace
  {
    /** Tissue thinner than so many cells counts as one or two cells thick.
     *  Cells on a lattice have a whole number of layers, so half a cell is the
     *  widest margin on both sides. */
    constexpr double one_layer = 1.5, two_layers = 2.5;
  } // namespace

  template <int dim>
  Occupancy<dim>::Occupancy(const GridWindow<dim>    &window,
                            const unsigned int        points_per_cell,
                            const bool                share_points,
                            const SharedParting<dim> &parting)
    : points_per_cell(points_per_cell)
    , share_points(share_points)
    , contents(window, parting)
  {}

  template <int dim>
  Occupancy<dim>::Occupancy(const GridBox<dim> &box)
    : Occupancy(GridWindow<dim>(box))
  {}

  template <int dim>
  void
  Occupancy<dim>::add_particle(const ParticleDomain<dim>  &domain,
                               const types::particle_index id)
  {
    contents.add_particle(domain, id);
  }

  template <int dim>
  void
  Occupancy<dim>::add_boundary_point(const Point<dim>  &x,
                                     const unsigned int part)
  {
    contents.add_boundary_point(x, part);
  }

  template <int dim>
  void
  Occupancy<dim>::sum()
  {
    // The sums of one rank are complete. Rows follow from volumes and reaches;
    // the quadrature points of the second round depend on them.
    contents.find_own();
    find_crowded();
    rows = TissueRows<dim>(contents);
  }

  template <int dim>
  void
  Occupancy<dim>::sum(const BackgroundGrid<dim> &grid)
  {
    if (Utilities::MPI::n_mpi_processes(grid.communicator()) == 1)
      return sum();
    // The same follows as on one rank, but from the sums over ranks.
    contents.sum(grid);
    find_crowded();
    rows = TissueRows<dim>(contents);
  }

  template <int dim>
  void
  Occupancy<dim>::add_quadrature_points(const ParticleDomain<dim>  &domain,
                                        const types::particle_index id)
  {
    // A point on a grid line may be shared: each share is a point of its own.
    unsigned int n_points = 0;
    domain.for_quadrature_points(
      n_points_per_edge(domain, id), [&](const Point<dim> &point) {
        for_each_share(point, [&](const Point<dim> &share, unsigned int) {
          contents.add_quadrature_point(share, id);
          ++n_points;
        });
      });
    subdivides_ = subdivides_ || n_points > 1;
  }

  template <int dim>
  void
  Occupancy<dim>::sum_quadrature_points(const BackgroundGrid<dim> &grid)
  {
    if (Utilities::MPI::n_mpi_processes(grid.communicator()) > 1)
      contents.sum_quadrature_points(grid);
  }

  template <int dim>
  void
  Occupancy<dim>::widen(const BackgroundGrid<dim> &grid, const bool here)
  {
    // The contents travel to the wider window; rows are found anew from these.
    contents.widen(grid, here);
    rows = TissueRows<dim>(contents);
  }

  template <int dim>
  void
  Occupancy<dim>::find_crowded()
  {
    // Owners look at their sums, and all ranks get the list: a boundary point
    // may be in a grid cell of any rank when its patch is to be split. It is
    // short, as only crumpled surfaces have such grid cells.
    std::vector<unsigned int> found;
    for (const unsigned int number : own())
      if (contents.n_boundary_points(number) > Utilities::pow(4, dim))
        found.push_back(window().whole().number(nodes().index(number)));
    crowded_.clear();
    for (const auto &list : gather_everywhere(found, window().communicator()))
      crowded_.insert(crowded_.end(), list.begin(), list.end());
    std::sort(crowded_.begin(), crowded_.end());
  }

  template <int dim>
  typename ParticleDomain<dim>::Numbers
  Occupancy<dim>::n_points_per_edge(const ParticleDomain<dim>  &domain,
                                    const types::particle_index id) const
  {
    // Thin tissue needs more points than its volume asks for, doc/theory.md,
    // section 3.2: two across a sheet, three across a rod, two where a rod is
    // two cells thick.
    const unsigned int number =
      nodes().node_of_cell(boxes().locate(domain.position()), id);
    const double h = boxes().spacing(), side = domain.side();
    const bool   rod   = rows.n_thin(number) > 1; // or a cluster
    const auto   below = [&](const double n_layers) {
      // Most tissue is thick: the first test spares the neighbours' one.
      return rows.least_thickness(number) * h < n_layers * side &&
             thickness(number) < n_layers * side;
    };
    unsigned int least = points_per_cell;
    if (below(one_layer))
      least = std::max(rod ? 3u : 2u, least);
    else if (rod && below(two_layers))
      least = std::max(2u, least);
    return domain.n_per_edge(h, least);
  }

  template <int dim>
  std::pair<Point<dim>, Point<dim>>
  Occupancy<dim>::bounds(const unsigned int number) const
  {
    // The reaches are units of h from the lower and the upper end of the grid
    // cell.
    Point<dim> lower = boxes().corner(nodes().index(number)), upper = lower;
    for (unsigned int d = 0; d < dim; ++d)
      {
        upper[d] += contents.up(number, d) * boxes().spacing();
        lower[d] += (1. - contents.down(number, d)) * boxes().spacing();
      }
    return {lower, upper};
  }

  template <int dim>
  bool
  Occupancy<dim>::crowded(const Point<dim> &x) const
  {
    const GridBox<dim>  &whole = window().whole();
    const GridIndex<dim> index = whole.locate(x);
    return whole.contains(index) && std::binary_search(crowded_.begin(),
                                                       crowded_.end(),
                                                       whole.number(index));
  }

  template <int dim>
  const GridBoxes<dim> &
  Occupancy<dim>::boxes() const
  {
    return contents.boxes();
  }

  template <int dim>
  const GridWindow<dim> &
  Occupancy<dim>::window() const
  {
    return contents.window();
  }

  template class Occupancy<2>;
  template class Occupancy<3>;
} // namespace Morula
