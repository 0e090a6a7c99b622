// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

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
  SplineCopies<dim>::SplineCopies(const GridBox<dim>               &box,
                                  const std::vector<GridCellClass> &classes)
    : box(box)
    , first(box.size() + 1, 0)
    , pieces(box.size(), no_piece)
  {
    for (unsigned int spline = 0; spline < box.size(); ++spline)
      {
        add_copies(spline, classes);
        first[spline + 1] = copies.size();
      }
    find_pieces();
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
  void
  SplineCopies<dim>::find_pieces()
  {
    std::vector<unsigned int> rank(box.size(), 0), parent(box.size());
    std::iota(parent.begin(), parent.end(), 0u);
    boost::disjoint_sets<unsigned int *, unsigned int *> sets(rank.data(),
                                                              parent.data());
    std::vector<char>                                    active(box.size(), 0);
    for (const SplineCopy &copy : copies)
      {
        unsigned int one = no_piece;
        for_support(box,
                    copy.spline,
                    [&](const unsigned int a, const unsigned int number) {
                      if (!(copy.support & (1u << a)))
                        return;
                      active[number] = 1;
                      if (one == no_piece)
                        one = number;
                      sets.union_set(one, number);
                    });
      }
    std::vector<unsigned int> piece_of_root(box.size(), no_piece);
    for (unsigned int number = 0; number < box.size(); ++number)
      if (active[number])
        {
          unsigned int &piece = piece_of_root[sets.find_set(number)];
          if (piece == no_piece)
            {
              piece = lowest.size();
              lowest.push_back(number);
            }
          pieces[number] = piece;
        }
    for (SplineCopy &copy : copies)
      for_support(box,
                  copy.spline,
                  [&](const unsigned int a, const unsigned int number) {
                    if (copy.support & (1u << a))
                      copy.piece = pieces[number];
                  });
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
