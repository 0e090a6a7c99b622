// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/grid/grid_contents.h>

#include <algorithm>
#include <cmath>

namespace Morula
{
  template <int dim>
  GridNodes<dim>::GridNodes(const GridWindow<dim>    &window,
                            const SharedParting<dim> &parting)
    : window(window)
    , parting_(parting)
  {
    // Without a contested grid cell there are no tables at all. Otherwise the
    // further parts of the window's grid cells get nodes in the order in which
    // the parting has them, those of one grid cell behind each other.
    if (parting_ == nullptr || parting_->is_trivial())
      return;
    first_further.assign(window.size(), 0);
    near_contest.assign(window.size(), 0);
    for (const auto &[number, part] : parting_->further_parts())
      if (const GridIndex<dim> index = window.whole().index(number);
          window.contains(index))
        {
          const unsigned int here = window.number(index);
          if (part == 1)
            first_further[here] = size();
          further.emplace_back(here, part);
        }
    for (unsigned int number = 0; number < window.size(); ++number)
      if (parting_->is_contested(window.whole().number(window.index(number))))
        window.for_neighbors(window.index(number),
                             1,
                             [&](const unsigned int neighbor, const auto &) {
                               near_contest[neighbor] = 1;
                             });
    // Each spline asks for the links of its support, and supports overlap: so
    // links are looked up once for each node.
    first_linked.assign(1, 0);
    for (unsigned int node = 0; node < size(); ++node)
      {
        if (near_contest[grid_cell(node)])
          window.for_neighbors(
            index(node), 1, [&](const unsigned int number, const auto &) {
              for_parts(number, [&](const unsigned int other) {
                if (are_linked(node, other))
                  linked.push_back(other);
              });
            });
        first_linked.push_back(linked.size());
      }
  }


  namespace
  {
    /** Points so near to a grid line are on it, in units of h: that is what
     *  rounding leaves of their places. */
    constexpr double on_line = 1e-9;
  } // namespace

  /** What ranks tell each other of a grid cell. */
  template <int dim>
  struct GridContents<dim>::Record
  {
    unsigned int number; // in the grid's box
    unsigned int part;
    Counts       counts;
    Reaches      reaches;
    std::int64_t volume;
  };

  template <int dim>
  GridContents<dim>::GridContents(const GridWindow<dim>    &window,
                                  const SharedParting<dim> &parting)
    : window_(window)
    , nodes_(window, parting)
  {
    clear();
  }


  template <int dim>
  void
  GridContents<dim>::add_particle(const ParticleDomain<dim>  &domain,
                                  const types::particle_index id)
  {
    const Point<dim> lower = domain.lower(), upper = domain.upper();
    const double     h = window_.whole().spacing();
    window_.for_range(
      {window_.whole().locate(lower), window_.whole().locate(upper)},
      [&](const unsigned int, const GridIndex<dim> &index) {
        const unsigned int node = nodes_.node_of_cell(index, id);
        // The volume is spread over the axis-parallel cube of the particle,
        // doc/theory.md (3.1). The overlap with each grid cell is rounded to an
        // integer, so that sums do not depend on the order of the particles.
        // The reaches say how far the tissue comes from either side: their
        // maxima give the extents of pieces and rows.
        const Point<dim> corner  = window_.whole().corner(index);
        double           overlap = 1.;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double from = std::max(0., (lower[d] - corner[d]) / h);
            const double to   = std::min(1., (upper[d] - corner[d]) / h);
            overlap *= std::max(0., to - from);
            float &up   = reaches[node][2 * d];
            float &down = reaches[node][2 * d + 1];
            up          = std::max(up, static_cast<float>(to));
            down        = std::max(down, static_cast<float>(1. - from));
          }
        volumes[node] += std::llround(overlap * resolution);
      });
    ++counts[nodes_.node_of_cell(window_.whole().locate(domain.position()), id)]
            [particle];
  }


  // A point on a grid line counts on both sides, so the point is taken for a
  // box of the width of rounding.
  template <int dim>
  void
  GridContents<dim>::add_quadrature_point(const Point<dim>           &x,
                                          const types::particle_index id)
  {
    Point<dim> lower = x, upper = x;
    for (unsigned int d = 0; d < dim; ++d)
      {
        lower[d] -= on_line * window_.whole().spacing();
        upper[d] += on_line * window_.whole().spacing();
      }
    window_.for_range({window_.whole().locate(lower),
                       window_.whole().locate(upper)},
                      [&](const unsigned int, const GridIndex<dim> &index) {
                        ++counts[nodes_.node_of_cell(index, id)][quadrature];
                      });
  }


  template <int dim>
  void
  GridContents<dim>::sum_quadrature_points(const BackgroundGrid<dim> &grid)
  {
    // As for the other sums. What these have found is kept by the owners, and
    // others send them the numbers of quadrature points alone.
    if (Utilities::MPI::n_mpi_processes(grid.communicator()) == 1)
      return;
    const unsigned int rank =
      Utilities::MPI::this_mpi_process(grid.communicator());
    std::vector<Record> list;
    for (const Record &record : records())
      if (grid.owner(record.number) == rank)
        list.push_back(record);
      else if (const std::uint32_t n = record.counts[quadrature]; n > 0)
        list.push_back({record.number, record.part, {{n, 0u, 0u}}, {}, 0});
    spread(window_.to_owners(list, grid));
  }

  template <int dim>
  void
  GridContents<dim>::sum(const BackgroundGrid<dim> &grid)
  {
    // Owners add up what all ranks have counted, then tell all ranks in whose
    // windows their grid cells lie.
    spread(window_.to_owners(records(), grid));
  }


  template <int dim>
  void
  GridContents<dim>::widen(const BackgroundGrid<dim> &grid, const bool here)
  {
    const unsigned int rank =
      Utilities::MPI::this_mpi_process(grid.communicator());
    // Each owner keeps the sums of its own grid cells. The tables are made anew
    // for the wider window, and filled by another round of messages.
    std::vector<Record> own;
    for (const Record &record : records())
      if (grid.owner(record.number) == rank)
        own.push_back(record);
    window_.widen(here);
    nodes_ = GridNodes<dim>(window_, nodes_.parting());
    spread(own);
  }

  template <int dim>
  void
  GridContents<dim>::spread(const std::vector<Record> &list)
  {
    // Own grid cells come first, since find_own() takes all that is in the
    // tables by then for this rank's. Only after that come those of others.
    clear();
    for (const Record &record : list)
      add(record);
    find_own();
    for (const Record &record : window_.to_windows(records()))
      add(record);
  }

  /** Takes all that is in the tables for grid cells of this rank: those of
   *  other ranks are added afterwards. */
  template <int dim>
  void
  GridContents<dim>::find_own()
  {
    own_.clear();
    for (unsigned int node = 0; node < nodes_.size(); ++node)
      if (holds_something(node))
        own_.push_back(node);
  }

  template <int dim>
  bool
  GridContents<dim>::holds_something(const unsigned int node) const
  {
    return volumes[node] > 0 || active(node) ||
           std::any_of(reaches[node].begin(),
                       reaches[node].end(),
                       [](const float reach) { return reach > 0.f; });
  }

  template <int dim>
  std::vector<typename GridContents<dim>::Record>
  GridContents<dim>::records() const
  {
    std::vector<Record> list;
    for (unsigned int node = 0; node < nodes_.size(); ++node)
      if (holds_something(node))
        list.push_back({window_.whole().number(nodes_.index(node)),
                        nodes_.part(node),
                        counts[node],
                        reaches[node],
                        volumes[node]});
    return list;
  }

  template <int dim>
  void
  GridContents<dim>::add(const Record &record)
  {
    // Records carry the number in the grid's box, tables are by node.
    const unsigned int node =
      nodes_.node(window_.whole().index(record.number), record.part);
    volumes[node] += record.volume;
    for (unsigned int k = 0; k < record.counts.size(); ++k)
      counts[node][k] += record.counts[k];
    for (unsigned int k = 0; k < record.reaches.size(); ++k)
      reaches[node][k] = std::max(reaches[node][k], record.reaches[k]);
  }

  template class GridNodes<2>;
  template class GridNodes<3>;
  template class GridContents<2>;
  template class GridContents<3>;
} // namespace Morula
