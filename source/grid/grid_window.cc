// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/grid/grid_window.h>

#include <deal.II/base/mpi.templates.h>

namespace Morula
{
  namespace
  {
    /** Whoever looks for a grid cell looks into each range. Where there would
     *  be more, wider gaps are closed, which covers more grid cells but never
     *  misses one. */
    constexpr std::size_t most_ranges = 32;

    /** Adds a range to others that are more than @p gap apart, and unites what
     *  no longer is. */
    template <int dim>
    void
    add(std::vector<GridRange<dim>> &apart, GridRange<dim> range, const int gap)
    {
      // A range that is united with near ones may come near to further ones. So
      // the search begins again until nothing is near.
      while (true)
        {
          const auto near = std::partition(apart.begin(),
                                           apart.end(),
                                           [&](const GridRange<dim> &other) {
                                             return range.gap(other) > gap;
                                           });
          if (near == apart.end())
            // The list is a set: the order does not matter before separated()
            // sorts it.
            break;
          for (auto other = near; other != apart.end(); ++other)
            range.unite(*other);
          apart.erase(near, apart.end());
        }
      apart.push_back(range);
    }
  } // namespace



  template <int dim>
  std::vector<GridRange<dim>>
  separated(const std::vector<GridRange<dim>> &ranges, int gap)
  {
    // Each range is added on its own. Whenever there are too many, the allowed
    // gap doubles and those that are nearer share one: so no list of boxes gets
    // long, however scattered the tissue is.
    std::vector<GridRange<dim>> apart;
    for (const GridRange<dim> &range : ranges)
      if (!range.empty())
        {
          add(apart, range, gap);
          while (apart.size() > most_ranges)
            {
              gap = 2 * gap + 1;
              std::vector<GridRange<dim>> wider;
              for (const GridRange<dim> &one : apart)
                add(wider, one, gap);
              apart = std::move(wider);
            }
        }
    // The order must not depend on that of the input.
    std::sort(apart.begin(), apart.end(), [](const auto &a, const auto &b) {
      return a.first < b.first;
    });
    return apart;
  }


  namespace
  {
    /** The rings around the core at first: enough for rows of tissue
     *  (Occupancy), and for inner grid cells as far away as outer splines
     *  mostly look for them. */
    constexpr int first_rings = 12;

    /** Splines reach so far beyond the grid cells of points, whose quadrature
     *  points may lie on the other side of a grid line. */
    constexpr int reach_of_splines = 2;

    /** The grid cells of a box that are so many @p rings inside of it, or at
     *  the edge of the grid's box. */
    template <int dim>
    GridRange<dim>
    shrunk(const GridBox<dim> &box, const int rings, const GridBox<dim> &whole)
    {
      // At the edge of the grid's box there is nothing beyond, so nothing is
      // cut off there.
      GridRange<dim> range;
      for (unsigned int d = 0; d < dim; ++d)
        {
          const int first = box.first()[d], end = first + box.n()[d],
                    whole_first = whole.first()[d],
                    whole_end   = whole_first + whole.n()[d];
          range.first[d]        = first + (first > whole_first ? rings : 0);
          range.last[d]         = end - 1 - (end < whole_end ? rings : 0);
        }
      return range;
    }
  } // namespace


  template <int dim>
  GridWindow<dim>::GridWindow(const GridBox<dim> &box)
    : whole_(box)
    , boxes_(1, box)
    , begins{0, box.size()}
  {}


  template <int dim>
  void
  GridWindow<dim>::set_boxes(const Ranges &ranges)
  {
    boxes_.clear();
    begins.assign(1, 0);
    for (const GridRange<dim> &range : ranges)
      {
        GridIndex<dim> n;
        for (unsigned int d = 0; d < dim; ++d)
          n[d] = range.last[d] - range.first[d] + 1;
        boxes_.emplace_back(range.first,
                            n,
                            whole_.spacing(),
                            whole_.corner(GridIndex<dim>{}));
        begins.push_back(begins.back() + boxes_.back().size());
      }
  }


  template <int dim>
  GridWindow<dim>::GridWindow(const BackgroundGrid<dim>         &grid,
                              const std::vector<GridRange<dim>> &reached)
    : whole_(grid.box())
    , alone(Utilities::MPI::n_mpi_processes(grid.communicator()) == 1)
    , rank(Utilities::MPI::this_mpi_process(grid.communicator()))
    , comm(grid.communicator())
  {
    // The core is what this rank's points reach, and the grid cells on which
    // their splines may stand. On several ranks it also includes the grid cells
    // that this rank owns in the cores of others, since it sums what they hold:
    // the others tell of them.
    for (const GridRange<dim> &range : reached)
      cores.push_back(range.grown(reach_of_splines, whole_));
    cores = separated(cores, 0);
    if (!alone)
      {
        rings = first_rings;
        for (const auto &[sender, list] :
             send_records(of_others(reached, grid), comm))
          for (const GridIndex<dim> &index : list)
            cores.push_back({index, index});
      }
    make();
  }


  /** Other ranks own some of the grid cells that this rank's points and splines
   *  reach. They must know of them, as they add up their contents. */
  template <int dim>
  std::map<unsigned int, std::vector<GridIndex<dim>>>
  GridWindow<dim>::of_others(const Ranges              &reached,
                             const BackgroundGrid<dim> &grid) const
  {
    GridWindow core(whole_);
    core.set_boxes(cores);
    std::vector<char> near(core.size(), 0);
    for (const GridRange<dim> &range : reached)
      // The cores' boxes hold more than what is near: where several ranges were
      // united only the grid cells of the ranges count.
      core.for_range(range.grown(reach_of_splines, whole_),
                     [&](const unsigned int number, const auto &) {
                       near[number] = 1;
                     });
    std::map<unsigned int, std::vector<GridIndex<dim>>> by_owner;
    for (unsigned int number = 0; number < core.size(); ++number)
      if (near[number])
        {
          const GridIndex<dim> index = core.index(number);
          if (const unsigned int owner = grid.owner(index); owner != rank)
            by_owner[owner].push_back(index);
        }
    return by_owner;
  }



  template <int dim>
  void
  GridWindow<dim>::make()
  {
    // Cores nearer than two rings share a box: no two boxes may touch.
    cores = separated(cores, 2 * rings);
    Ranges window;
    for (const GridRange<dim> &core : cores)
      window.push_back(core.grown(rings, whole_));
    set_boxes(window);
    if (alone)
      return;
    neighbors.clear();
    // Every rank learns all ranks' windows, some boxes each. It keeps those in
    // which some of its own core lies: these ranks want to be told of it.
    const auto windows = gather_everywhere(window, comm);
    for (unsigned int other = 0; other < windows.size(); ++other)
      for (const GridRange<dim> &range : windows[other])
        if (other != rank &&
            std::any_of(cores.begin(), cores.end(), [&](const auto &core) {
              return core.gap(range) < 0;
            }))
          neighbors[other].push_back(range);
  }



  template <int dim>
  bool
  GridWindow<dim>::holds(const GridIndex<dim> &center, const int radius) const
  {
    // On one rank all tissue is in the window; what is outside is empty.
    if (alone)
      return true;
    for (const GridBox<dim> &box : boxes_)
      if (shrunk(box, radius, whole_).contains(center))
        return true;
    return false;
  }


  template <int dim>
  std::vector<GridRange<dim>>
  GridWindow<dim>::inner(const int rings) const
  {
    Ranges ranges;
    for (const GridBox<dim> &box : boxes_)
      ranges.push_back(shrunk(box, alone ? 0 : rings, whole_));
    return ranges;
  }

  MORULA_INSTANTIATE(separated);
  template struct GridRange<2>;
  template struct GridRange<3>;
  template class GridWindow<2>;
  template class GridWindow<3>;
} // namespace Morula
