// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/grid/grid_window.h>

#include <deal.II/base/mpi.templates.h>

#include <algorithm>
#include <limits>

namespace Morula
{
  namespace
  {
    /** Around the core at first: for rows of tissue (Occupancy) and for inner
     *  grid cells as far away as outer splines mostly look for them. */
    constexpr int first_rings = 12;

    /** Splines reach so far beyond the grid cells of points, whose quadrature
     *  points may lie on the other side of a grid line. */
    constexpr int reach_of_splines = 2;

    template <int dim>
    GridRange<dim>
    nothing()
    {
      GridRange<dim> range;
      range.first.fill(std::numeric_limits<int>::max());
      range.last.fill(std::numeric_limits<int>::lowest());
      return range;
    }

    template <int dim>
    GridBox<dim>
    box_of(const GridRange<dim> &range, const GridBox<dim> &lines)
    {
      GridIndex<dim> first = lines.first(), n{};
      if (!range.empty())
        for (unsigned int d = 0; d < dim; ++d)
          {
            first[d] = range.first[d];
            n[d]     = range.last[d] - range.first[d] + 1;
          }
      return {first, n, lines.spacing(), lines.corner(GridIndex<dim>{})};
    }

    /** The grid cells of a box, each once, that splines of the points in
     *  @p ranges may stand on. */
    template <int dim>
    std::vector<GridIndex<dim>>
    grid_cells_of_splines(const std::vector<GridRange<dim>> &ranges,
                          const GridRange<dim>              &all,
                          const GridBox<dim>                &whole)
    {
      const GridBox<dim> box =
        box_of(all.grown(reach_of_splines, whole), whole);
      std::vector<char> reached(box.size(), 0), near(box.size(), 0);
      for (const GridRange<dim> &range : ranges)
        box.for_overlap(range.first,
                        range.last,
                        [&](const unsigned int number, const auto &) {
                          reached[number] = 1;
                        });
      for (unsigned int number = 0; number < box.size(); ++number)
        if (reached[number])
          box.for_neighbors(box.index(number),
                            reach_of_splines,
                            [&](const unsigned int other, const auto &) {
                              near[other] = 1;
                            });
      std::vector<GridIndex<dim>> list;
      for (unsigned int number = 0; number < box.size(); ++number)
        if (near[number])
          list.push_back(box.index(number));
      return list;
    }
  } // namespace


  template <int dim>
  bool
  GridRange<dim>::empty() const
  {
    for (unsigned int d = 0; d < dim; ++d)
      if (first[d] > last[d])
        return true;
    return false;
  }


  template <int dim>
  bool
  GridRange<dim>::contains(const GridIndex<dim> &index) const
  {
    for (unsigned int d = 0; d < dim; ++d)
      if (index[d] < first[d] || index[d] > last[d])
        return false;
    return true;
  }


  template <int dim>
  void
  GridRange<dim>::unite(const GridRange &other)
  {
    for (unsigned int d = 0; d < dim; ++d)
      {
        first[d] = std::min(first[d], other.first[d]);
        last[d]  = std::max(last[d], other.last[d]);
      }
  }


  template <int dim>
  GridRange<dim>
  GridRange<dim>::grown(const int rings, const GridBox<dim> &box) const
  {
    if (empty())
      return *this;
    GridRange range;
    for (unsigned int d = 0; d < dim; ++d)
      {
        range.first[d] = std::max(first[d] - rings, box.first()[d]);
        range.last[d] =
          std::min(last[d] + rings, box.first()[d] + box.n()[d] - 1);
      }
    return range;
  }


  template <int dim>
  GridWindow<dim>::GridWindow(const GridBox<dim> &box)
    : whole_(box)
    , box_(box)
  {}


  template <int dim>
  GridWindow<dim>::GridWindow(const BackgroundGrid<dim> &grid,
                              const std::vector<Extent> &extents)
    : whole_(grid.box())
    , box_(grid.box())
    , core(nothing<dim>())
    , rings(first_rings)
    , rank(Utilities::MPI::this_mpi_process(grid.communicator()))
    , comm(grid.communicator())
  {
    if (Utilities::MPI::n_mpi_processes(comm) == 1)
      return;
    std::vector<GridRange<dim>> ranges;
    GridRange<dim>              all = nothing<dim>();
    for (const auto &[lower, upper] : extents)
      {
        ranges.push_back({whole_.locate(lower), whole_.locate(upper)});
        all.unite(ranges.back());
      }
    // Other ranks own some of these grid cells: they must know of them.
    std::map<unsigned int, GridRange<dim>> of_others;
    if (!all.empty())
      for (const GridIndex<dim> &index :
           grid_cells_of_splines(ranges, all, whole_))
        {
          core.unite({index, index});
          if (const unsigned int owner = grid.owner(index); owner != rank)
            of_others.emplace(owner, nothing<dim>())
              .first->second.unite({index, index});
        }
    for (const auto &[sender, range] :
         Utilities::MPI::some_to_some(comm, of_others))
      core.unite(range);
    make();
  }


  template <int dim>
  void
  GridWindow<dim>::widen()
  {
    if (windows.empty())
      return; // one rank knows all
    rings *= 2;
    make();
  }


  template <int dim>
  void
  GridWindow<dim>::make()
  {
    const GridRange<dim> window = core.grown(rings, whole_);
    box_                        = box_of(window, whole_);
    windows                     = Utilities::MPI::all_gather(comm, window);
  }


  template <int dim>
  const GridBox<dim> &
  GridWindow<dim>::box() const
  {
    return box_;
  }


  template <int dim>
  const GridBox<dim> &
  GridWindow<dim>::whole() const
  {
    return whole_;
  }


  template <int dim>
  bool
  GridWindow<dim>::holds(const GridIndex<dim> &center, const int radius) const
  {
    return inner(radius).contains(center);
  }


  template <int dim>
  GridRange<dim>
  GridWindow<dim>::inner(const int rings) const
  {
    GridRange<dim> range;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const int first = box_.first()[d], end = first + box_.n()[d];
        const int whole_end = whole_.first()[d] + whole_.n()[d];
        range.first[d]      = first + (first > whole_.first()[d] ? rings : 0);
        range.last[d]       = end - 1 - (end < whole_end ? rings : 0);
      }
    return range;
  }


  template <int dim>
  MPI_Comm
  GridWindow<dim>::communicator() const
  {
    return comm;
  }


  template struct GridRange<2>;
  template struct GridRange<3>;
  template class GridWindow<2>;
  template class GridWindow<3>;
} // namespace Morula
