// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_grid_boxes_h
#define morula_grid_grid_boxes_h

#include <morula/grid/grid_range.h>

#include <algorithm>
#include <vector>

namespace Morula
{
  /**
   * The grid cells of some boxes of the background grid. No two boxes touch: so
   * the neighbours of a grid cell are in its own box, or in none. Tables have
   * one entry for each of these grid cells, by its number: these run box by
   * box, and in a box as those of GridBox do.
   */
  template <int dim>
  class GridBoxes
  {
  public:
    GridBoxes() = default;

    /** One box. */
    explicit GridBoxes(const GridBox<dim> &box)
      : lines(box)
      , boxes_(1, box)
      , begins{0, box.size()}
    {}

    /** @param ranges in @p whole, which do not touch; none is empty */
    GridBoxes(const std::vector<GridRange<dim>> &ranges,
              const GridBox<dim>                &whole)
      : lines(whole)
      , begins(1, 0)
    {
      for (const GridRange<dim> &range : ranges)
        {
          GridIndex<dim> n;
          for (unsigned int d = 0; d < dim; ++d)
            n[d] = range.last[d] - range.first[d] + 1;
          boxes_.emplace_back(range.first,
                              n,
                              whole.spacing(),
                              whole.corner(GridIndex<dim>{}));
          begins.push_back(begins.back() + boxes_.back().size());
        }
    }

    /** Number of grid cells. */
    unsigned int
    size() const
    {
      return begins.back();
    }

    const std::vector<GridBox<dim>> &
    boxes() const
    {
      return boxes_;
    }

    /** Number of the first grid cell of a box. */
    unsigned int
    begin(const unsigned int box) const
    {
      return begins[box];
    }

    double
    spacing() const
    {
      return lines.spacing();
    }

    /** See GridBox. */
    GridIndex<dim>
    locate(const Point<dim> &x) const
    {
      return lines.locate(x);
    }

    /** See GridBox. */
    Point<dim>
    center(const GridIndex<dim> &index) const
    {
      return lines.center(index);
    }

    /** See GridBox. */
    Point<dim>
    corner(const GridIndex<dim> &index) const
    {
      return lines.corner(index);
    }

    /** Whether a grid cell is in one of the boxes. */
    bool
    contains(const GridIndex<dim> &index) const
    {
      return std::any_of(boxes_.begin(),
                         boxes_.end(),
                         [&](const GridBox<dim> &box) {
                           return box.contains(index);
                         });
    }

    /** Number of a grid cell that is in one of the boxes. */
    unsigned int
    number(const GridIndex<dim> &index) const
    {
      const unsigned int k = box_with(index);
      return begins[k] + boxes_[k].number(index);
    }

    /** The coordinates of a grid cell from its number; inverse of number(). */
    GridIndex<dim>
    index(const unsigned int number) const
    {
      unsigned int k = 0;
      while (number >= begins[k + 1])
        ++k;
      return boxes_[k].index(number - begins[k]);
    }

    /** Calls @p visit(number, index) for all grid cells whose coordinates
     *  differ by at most @p radius from those of @p center, in the order of
     *  their numbers. */
    template <typename Visitor>
    void
    for_neighbors(const GridIndex<dim> &center,
                  const int             radius,
                  const Visitor        &visit) const
    {
      for (unsigned int k = 0; k < boxes_.size(); ++k)
        boxes_[k].for_neighbors(center, radius, shifted(k, visit));
    }

    /** Calls @p visit(number, index) for all grid cells of the range, in the
     *  order of their numbers. */
    template <typename Visitor>
    void
    for_range(const GridRange<dim> &range, const Visitor &visit) const
    {
      for (unsigned int k = 0; k < boxes_.size(); ++k)
        boxes_[k].for_overlap(range.first, range.last, shifted(k, visit));
    }

  private:
    unsigned int
    box_with(const GridIndex<dim> &index) const
    {
      unsigned int k = 0;
      while (k + 1 < boxes_.size() && !boxes_[k].contains(index))
        ++k;
      return k;
    }

    template <typename Visitor>
    auto
    shifted(const unsigned int box, const Visitor &visit) const
    {
      return [&visit, begin = begins[box]](const unsigned int    number,
                                           const GridIndex<dim> &index) {
        visit(begin + number, index);
      };
    }

    GridBox<dim>              lines; // any box of the grid
    std::vector<GridBox<dim>> boxes_;
    std::vector<unsigned int> begins{0}; // of each box, and the end
  };
} // namespace Morula

#endif
