// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/grid/tissue_rows.h>

#include <algorithm>
#include <cstdint>

namespace Morula
{
  namespace
  {
    /** A row of so many grid cells is as thick as the grid along itself. Then
     *  no rank needs to know a row that runs through the parts of many:
     *  doc/theory.md, section 3.2. */
    constexpr std::size_t long_row = 8;

    /** A row of tissue shorter than so many grid spacings is thin. It may lie
     *  on both sides of one grid plane, and inner grid cells on both sides
     *  would have splines that hardly touch it. */
    constexpr double thin_row = 1.5;

    /** A grid cell with at least this part of the fullest one's volume counts
     *  as equally full, so that noise does not change the side from row to row.
     */
    constexpr double about_equal = 0.8;

    /** Calls visit(row) for the connected rows of nodes with tissue along one
     *  direction. */
    template <int dim, typename Visit>
    void
    for_each_row(const GridCellContents<dim> &contents,
                 const unsigned int           direction,
                 const Visit                 &visit)
    {
      // Along a direction a row begins wherever the coordinate is the first of
      // its box. The window's boxes do not touch, so no row runs through two of
      // them. Where strands of tissue are parted, several rows are open at a
      // time: a node goes on with those that end in a node which it is linked
      // with. One step beyond the end closes the last rows.
      const GridNodes<dim>                  &nodes = contents.nodes();
      std::vector<std::vector<unsigned int>> open, next;
      const auto go_on = [&](const unsigned int node) {
        if (contents.volume(node) == 0)
          return;
        std::vector<unsigned int> row;
        for (std::vector<unsigned int> &before : open)
          if (!before.empty() && nodes.are_linked(before.back(), node))
            {
              if (row.empty())
                row = std::move(before);
              else
                row.insert(row.end(), before.begin(), before.end());
              before.clear();
            }
        row.push_back(node);
        next.push_back(std::move(row));
      };
      for (unsigned int k = 0; k < contents.boxes().boxes().size(); ++k)
        {
          const GridBox<dim> &box    = contents.boxes().boxes()[k];
          const unsigned int  begin  = contents.boxes().begin(k);
          unsigned int        stride = 1;
          for (unsigned int d = 0; d < direction; ++d)
            stride *= box.n()[d];
          const int n = box.n()[direction];
          for (unsigned int first = 0; first < box.size(); ++first)
            if (first / stride % n == 0)
              for (int i = 0; i <= n; ++i)
                {
                  // The next grid cell of a row is `stride` numbers away.
                  next.clear();
                  if (i < n)
                    nodes.for_parts(begin + first + i * stride, go_on);
                  for (const std::vector<unsigned int> &row : open)
                    if (!row.empty())
                      visit(row);
                  std::swap(open, next);
                }
        }
    }

    /** Distance from the first to the last tissue of a row, in units of h. */
    template <int dim>
    double
    length(const std::vector<unsigned int> &row,
           const unsigned int               direction,
           const GridCellContents<dim>     &contents)
    {
      // The first and the last grid cell count as far as the tissue reaches in
      // them, those in between as a whole.
      return contents.up(row.back(), direction) +
             contents.down(row.front(), direction) + row.size() - 2.;
    }

    template <int dim>
    double
    cross_section(const std::vector<unsigned int> &row,
                  const unsigned int               direction,
                  const GridCellContents<dim>     &contents)
    {
      // The smallest rectangle around the tissue of the row, from its farthest
      // reaches on either side in all grid cells.
      double area = 1.;
      for (unsigned int d = 0; d < dim; ++d)
        if (d != direction)
          {
            float up = 0.f, down = 0.f;
            for (const unsigned int number : row)
              {
                up   = std::max(up, contents.up(number, d));
                down = std::max(down, contents.down(number, d));
              }
            area *= up + down - 1.;
          }
      return area;
    }

    /** The largest value of a grid cell and its neighbours with tissue. */
    template <int dim>
    float
    largest_around(const std::vector<float>    &values,
                   const unsigned int           number,
                   const GridCellContents<dim> &contents)
    {
      float largest = values[number];
      contents.nodes().for_linked(
        number, [&](const unsigned int neighbor, const auto &) {
          if (contents.volume(neighbor) > 0)
            largest = std::max(largest, values[neighbor]);
        });
      return largest;
    }
  } // namespace

  template <int dim>
  TissueRows<dim>::TissueRows(const GridCellContents<dim> &contents)
    : thicknesses(contents.nodes().size(), 1.f)
    , lengths(contents.nodes().size(), 2.f)
    , n_thin_(contents.nodes().size(), 0)
    , candidates(contents.nodes().size(), 1)
  {
    // Rows in x choose their candidates first, rows in y among what is left,
    // then rows in z. So the order of the directions is part of the rule.
    for (unsigned int d = 0; d < dim; ++d)
      for_each_row(contents, d, [&](const std::vector<unsigned int> &row) {
        measure(row, d, contents);
      });
  }

  template <int dim>
  void
  TissueRows<dim>::measure(const std::vector<unsigned int> &row,
                           const unsigned int               direction,
                           const GridCellContents<dim>     &contents)
  {
    // One pass finds the volume and the largest candidate's volume. Then come
    // the two uses of a row: its thickness, volume over cross-section, for the
    // number of quadrature points; and its length, which says whether it is
    // thin. A thin row keeps one candidate, the first that is about as full as
    // the fullest, so that noise does not change sides from row to row
    // (doc/theory.md, section 3.2).
    std::int64_t sum = 0, largest = 0;
    for (const unsigned int number : row)
      {
        sum += contents.volume(number);
        if (candidates[number])
          largest = std::max(largest, contents.volume(number));
      }
    const float row_length = length(row, direction, contents);
    bool        found      = false;
    // A longer row is not thin along itself, and its ends may lie outside of
    // the window.
    if (row.size() < long_row)
      {
        const float thickness = sum / GridCellContents<dim>::resolution /
                                cross_section(row, direction, contents);
        for (const unsigned int number : row)
          thicknesses[number] = std::min(thicknesses[number], thickness);
      }
    if (row_length < thin_row)
      for (const unsigned int number : row)
        {
          lengths[number] = std::min(lengths[number], row_length);
          ++n_thin_[number];
          candidates[number] = candidates[number] && !found &&
                               contents.volume(number) >= about_equal * largest;
          found = found || candidates[number];
        }
  }

  template <int dim>
  float
  TissueRows<dim>::thickness(const unsigned int           number,
                             const GridCellContents<dim> &contents) const
  {
    return largest_around(thicknesses, number, contents);
  }

  template <int dim>
  bool
  TissueRows<dim>::is_thin(const unsigned int           number,
                           const GridCellContents<dim> &contents) const
  {
    return n_thin_[number] > 0 &&
           largest_around(lengths, number, contents) < thin_row;
  }

  template class TissueRows<2>;
  template class TissueRows<3>;
} // namespace Morula
