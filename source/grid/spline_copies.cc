// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/grid/parts_on_ranks.h>
#include <morula/grid/spline_copies.h>

#include <deal.II/base/types.h>

#include <boost/pending/disjoint_sets.hpp>

#include <array>
#include <cstdlib>
#include <numeric>

namespace Morula
{
  namespace
  {
    constexpr unsigned int no_piece = numbers::invalid_unsigned_int;

    /** For each of the 3^dim grid cells of a spline's support, the bits of
     *  those that it touches, including itself. */
    template <int dim>
    std::array<std::uint32_t, BSpline<dim>::n>
    make_touching()
    {
      std::array<std::uint32_t, BSpline<dim>::n> table{};
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        for (unsigned int b = 0; b < BSpline<dim>::n; ++b)
          {
            bool touch = true;
            for (unsigned int d = 0; d < dim; ++d)
              touch = touch && std::abs(BSpline<dim>::offset(a, d) -
                                        BSpline<dim>::offset(b, d)) <= 1;
            if (touch)
              table[a] |= 1u << b;
          }
      return table;
    }

    /** The part of @p grid_cells that is connected to the lowest of them. */
    template <int dim>
    std::uint32_t
    first_part(const std::uint32_t grid_cells)
    {
      static const auto touching = make_touching<dim>();
      std::uint32_t     part = grid_cells & ~(grid_cells - 1), before = 0;
      while (part != before)
        {
          before = part;
          for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
            if (before & (1u << a))
              part |= touching[a] & grid_cells;
        }
      return part;
    }

    /** Calls visit(a, number) for the grid cells of a spline's support that lie
     *  in the box. */
    template <int dim, typename Visit>
    void
    for_support(const GridBox<dim> &box,
                const unsigned int  spline,
                const Visit        &visit)
    {
      const GridIndex<dim> center = box.index(spline);
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        {
          GridIndex<dim> grid_cell = center;
          for (unsigned int d = 0; d < dim; ++d)
            grid_cell[d] += BSpline<dim>::offset(a, d);
          if (box.contains(grid_cell))
            visit(a, box.number(grid_cell));
        }
    }
  } // namespace

  template <int dim>
  SplineCopies<dim>::SplineCopies(const GridWindow<dim>            &window,
                                  const std::vector<GridCellClass> &classes,
                                  const BackgroundGrid<dim>        &grid)
    : box(window.box())
    , first(box.size() + 1, 0)
    , pieces(box.size(), no_piece)
  {
    find_own(classes, grid);
    const GridRange<dim> known = window.inner(reach());
    for (unsigned int spline = 0; spline < box.size(); ++spline)
      {
        if (known.contains(box.index(spline)))
          add_copies(spline, classes);
        first[spline + 1] = copies.size();
      }
    const unsigned int n_parts = find_parts();
    join_parts(n_parts, window.whole(), grid);
    for (SplineCopy &copy : copies)
      if (is_used(copy))
        for_support(box,
                    copy.spline,
                    [&](const unsigned int a, const unsigned int number) {
                      if (copy.support & (1u << a))
                        copy.piece = pieces[number];
                    });
  }

  template <int dim>
  void
  SplineCopies<dim>::find_own(const std::vector<GridCellClass> &classes,
                              const BackgroundGrid<dim>        &grid)
  {
    const unsigned int rank =
      Utilities::MPI::this_mpi_process(grid.communicator());
    const bool alone =
      Utilities::MPI::n_mpi_processes(grid.communicator()) == 1;
    own.assign(box.size(), alone);
    // A spline with active grid cells stands on one of their neighbours.
    for (unsigned int number = 0; number < box.size(); ++number)
      if (is_active(classes[number]))
        {
          if (!alone)
            box.for_neighbors(box.index(number),
                              1,
                              [&](const unsigned int other, const auto &) {
                                own[other] = 2;
                              });
        }
    if (!alone)
      for (unsigned int number = 0; number < box.size(); ++number)
        if (own[number] == 2)
          own[number] = grid.owner(box.index(number)) == rank;
    for (unsigned int number = 0; number < box.size(); ++number)
      if (own[number] && is_active(classes[number]))
        own_active.push_back(number);
  }

  template <int dim>
  void
  SplineCopies<dim>::add_copies(const unsigned int                spline,
                                const std::vector<GridCellClass> &classes)
  {
    std::uint32_t tissue = 0, active = 0, inner = 0;
    for_support(box,
                spline,
                [&](const unsigned int a, const unsigned int number) {
                  const GridCellClass grid_cell = classes[number];
                  tissue |= (grid_cell >= GridCellClass::reached) << a;
                  active |= is_active(grid_cell) << a;
                  inner |= (grid_cell == GridCellClass::inner) << a;
                });
    while ((active & tissue) != 0)
      {
        const std::uint32_t part = first_part<dim>(tissue);
        if ((part & active) != 0)
          copies.push_back(
            {spline, part & active, (part & inner) != 0, no_piece});
        tissue &= ~part;
      }
  }

  template <int dim>
  bool
  SplineCopies<dim>::is_used(const SplineCopy &copy) const
  {
    bool used = is_own(copy);
    if (!used)
      for_support(box,
                  copy.spline,
                  [&](const unsigned int a, const unsigned int number) {
                    used = used || ((copy.support & (1u << a)) && own[number]);
                  });
    return used;
  }

  template <int dim>
  unsigned int
  SplineCopies<dim>::find_parts()
  {
    std::vector<unsigned int> rank(box.size(), 0), parent(box.size());
    std::iota(parent.begin(), parent.end(), 0u);
    boost::disjoint_sets<unsigned int *, unsigned int *> sets(rank.data(),
                                                              parent.data());
    std::vector<char>                                    used(box.size(), 0);
    for (const SplineCopy &copy : copies)
      {
        if (!is_used(copy))
          continue;
        unsigned int one = no_piece;
        for_support(box,
                    copy.spline,
                    [&](const unsigned int a, const unsigned int number) {
                      if (!(copy.support & (1u << a)))
                        return;
                      used[number] = 1;
                      if (one == no_piece)
                        one = number;
                      sets.union_set(one, number);
                    });
      }
    unsigned int              n_parts = 0;
    std::vector<unsigned int> part_of_root(box.size(), no_piece);
    for (unsigned int number = 0; number < box.size(); ++number)
      if (used[number])
        {
          unsigned int &part = part_of_root[sets.find_set(number)];
          if (part == no_piece)
            part = n_parts++;
          pieces[number] = part;
        }
    return n_parts;
  }

  template <int dim>
  void
  SplineCopies<dim>::join_parts(const unsigned int         n_parts,
                                const GridBox<dim>        &whole,
                                const BackgroundGrid<dim> &grid)
  {
    std::vector<unsigned int> lowest_of_parts(n_parts, no_piece);
    PartsOnRanks::Seen        seen;
    for (unsigned int number = 0; number < box.size(); ++number)
      if (pieces[number] != no_piece)
        {
          const GridIndex<dim> index = box.index(number);
          const unsigned int   there = whole.number(index);
          unsigned int        &low   = lowest_of_parts[pieces[number]];
          low                        = std::min(low, there);
          if (!own[number])
            seen[grid.owner(index)].push_back({there, pieces[number]});
        }
    const PartsOnRanks joined(
      lowest_of_parts,
      seen,
      [&](const unsigned int there) {
        return pieces[box.number(whole.index(there))];
      },
      grid.communicator());
    lowest = joined.lowest();
    for (unsigned int &piece : pieces)
      if (piece != no_piece)
        piece = joined.whole_of(piece);
  }

  template <int dim>
  const std::vector<SplineCopy> &
  SplineCopies<dim>::list() const
  {
    return copies;
  }

  template <int dim>
  unsigned int
  SplineCopies<dim>::at(const GridIndex<dim> &spline,
                        const GridIndex<dim> &grid_cell) const
  {
    const unsigned int number = box.number(spline);
    unsigned int       copy   = first[number];
    if (first[number + 1] - copy == 1)
      return copy;
    unsigned int a = 0;
    for (int d = dim - 1; d >= 0; --d)
      a = 3 * a + (grid_cell[d] - spline[d] + 1);
    while (copy < first[number + 1] && !(copies[copy].support & (1u << a)))
      ++copy;
    Assert(copy < first[number + 1], ExcInternalError());
    return copy;
  }

  template <int dim>
  unsigned int
  SplineCopies<dim>::place(const unsigned int copy) const
  {
    return copy - first[copies[copy].spline];
  }

  template <int dim>
  unsigned int
  SplineCopies<dim>::copy_at(const unsigned int spline,
                             const unsigned int place) const
  {
    AssertThrow(first[spline] + place < first[spline + 1], ExcInternalError());
    return first[spline] + place;
  }

  template <int dim>
  bool
  SplineCopies<dim>::is_own(const SplineCopy &copy) const
  {
    return own[copy.spline];
  }

  template <int dim>
  const std::vector<unsigned int> &
  SplineCopies<dim>::own_grid_cells() const
  {
    return own_active;
  }

  template <int dim>
  unsigned int
  SplineCopies<dim>::piece(const unsigned int number) const
  {
    return pieces[number];
  }

  template <int dim>
  unsigned int
  SplineCopies<dim>::n_pieces() const
  {
    return lowest.size();
  }

  template <int dim>
  unsigned int
  SplineCopies<dim>::lowest_grid_cell(const unsigned int piece) const
  {
    return lowest[piece];
  }

  template class SplineCopies<2>;
  template class SplineCopies<3>;
} // namespace Morula
