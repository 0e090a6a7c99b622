// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_grid_window_h
#define morula_grid_grid_window_h

#include <morula/base/send_records.h>
#include <morula/grid/background_grid.h>
#include <morula/grid/grid_box.h>

#include <algorithm>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace Morula
{
  /** Grid cells from one to another in each direction, both included; none if
   *  the last lies before the first. */
  template <int dim>
  struct GridRange
  {
    GridIndex<dim> first, last;

    /** Whether there is no grid cell in it. */
    bool
    empty() const
    {
      for (unsigned int d = 0; d < dim; ++d)
        if (first[d] > last[d])
          return true;
      return false;
    }

    /** Whether the grid cell is one of them. */
    bool
    contains(const GridIndex<dim> &index) const
    {
      for (unsigned int d = 0; d < dim; ++d)
        if (index[d] < first[d] || index[d] > last[d])
          return false;
      return true;
    }

    /** Makes it the smallest that holds the other one, too. */
    void
    unite(const GridRange &other)
    {
      for (unsigned int d = 0; d < dim; ++d)
        {
          first[d] = std::min(first[d], other.first[d]);
          last[d]  = std::max(last[d], other.last[d]);
        }
    }

    /** The range, with @p rings more grid cells on all sides but inside of @p
     *  box. */
    GridRange
    grown(const int rings, const GridBox<dim> &box) const
    {
      GridRange range;
      for (unsigned int d = 0; d < dim; ++d)
        {
          range.first[d] = std::max(first[d] - rings, box.first()[d]);
          range.last[d] =
            std::min(last[d] + rings, box.first()[d] + box.n()[d] - 1);
        }
      return range;
    }

    /** Layers of grid cells between the two; 0 if they touch, less if they
     *  have grid cells in common. */
    int
    gap(const GridRange &other) const
    {
      // The largest distance of any direction: two boxes touch only if they
      // touch in all of them.
      int largest = std::numeric_limits<int>::lowest();
      for (unsigned int d = 0; d < dim; ++d)
        largest = std::max({largest,
                            first[d] - other.last[d] - 1,
                            other.first[d] - last[d] - 1});
      return largest;
    }
  };

  /**
   * Ranges that hold all of these, where more than @p gap layers lie between
   * any two. There are at most 32, as whoever looks for a grid cell looks into
   * each of them: of more, those with less than 2, 4, 8, ... gaps between them
   * share one.
   */
  template <int dim>
  std::vector<GridRange<dim>>
  separated(const std::vector<GridRange<dim>> &ranges, int gap);

  /**
   * The part of the grid that a rank knows: the grid cells that its points
   * reach, those of others' points that it owns, and some rings around them.
   * Tables of grid cells are as long as the window of the rank, not as the
   * grid's box: where a rank has parts of the tissue that stand apart, its
   * window is several boxes. No two of them touch: so the neighbours of a grid
   * cell are in its own box, or in none. On one rank the window is what the
   * tissue reaches; there is nothing outside.
   *
   * Tables have one entry for each grid cell of the window, by its number:
   * these run box by box, and in a box as those of GridBox do. Records that
   * ranks tell each other have the number in the grid's box.
   */
  template <int dim>
  class GridWindow
  {
  public:
    GridWindow() = default;

    /** All of a box, on one rank. */
    explicit GridWindow(const GridBox<dim> &box);

    /** The window of this rank, whose points reach into the grid cells
     *  @p reached. The partition of @p grid is that of now. Collective. */
    GridWindow(const BackgroundGrid<dim>         &grid,
               const std::vector<GridRange<dim>> &reached);

    /** Takes half as many rings more, where a rank wants to look farther.
     *  @param here whether this one does. Collective. */
    void
    widen(const bool here)
    {
      if (alone)
        return; // knows all
      // Only ranks that asked get wider windows, but all make theirs anew,
      // since their neighbours' windows have changed.
      if (here)
        rings += rings / 2;
      make();
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

    /** The grid's box. */
    const GridBox<dim> &
    whole() const
    {
      return whole_;
    }

    /** Whether the window holds all grid cells of the grid whose coordinates
     *  differ by at most @p radius from those of @p center, but for those that
     *  are certainly empty. */
    bool
    holds(const GridIndex<dim> &center, const int radius) const;

    /** The grid cells of which the window holds(., rings). */
    std::vector<GridRange<dim>>
    inner(const int rings) const;

    /**
     * Sends records of grid cells to their owners. Collective.
     * @tparam Record with a `number` in the grid's box
     * @return the records of this rank's grid cells, from all ranks
     */
    template <typename Record>
    std::vector<Record>
    to_owners(const std::vector<Record> &records,
              const BackgroundGrid<dim> &grid) const
    {
      if (alone)
        return records;
      std::map<unsigned int, std::vector<Record>> by_owner;
      for (const Record &record : records)
        by_owner[grid.owner(record.number)].push_back(record);
      return in_one(send_records(by_owner, comm));
    }

    /**
     * Tells all ranks in whose windows they lie of grid cells. Collective.
     * @param own records of grid cells that this rank owns and some points
     *   reach; no other rank tells of them
     * @return those of other ranks in this rank's window
     */
    template <typename Record>
    std::vector<Record>
    to_windows(const std::vector<Record> &own) const
    {
      if (alone)
        return {};
      std::map<unsigned int, std::vector<Record>> others;
      for (const Record &record : own)
        {
          const GridIndex<dim> index = whole_.index(record.number);
          for (const auto &[other, ranges] : neighbors)
            if (is_in(ranges, index))
              others[other].push_back(record);
        }
      return in_one(send_records(others, comm));
    }

    MPI_Comm
    communicator() const
    {
      return comm;
    }

  private:
    using Ranges = std::vector<GridRange<dim>>;

    /** Makes the boxes of these ranges, which do not touch; none is empty. */
    void
    set_boxes(const Ranges &ranges);

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

    /** Whether one of the ranges contains the grid cell. */
    static bool
    is_in(const Ranges &ranges, const GridIndex<dim> &index)
    {
      return std::any_of(ranges.begin(),
                         ranges.end(),
                         [&](const GridRange<dim> &range) {
                           return range.contains(index);
                         });
    }

    /** Grid cells of other ranks that splines of this rank's points may stand
     *  on, by owner. */
    std::map<unsigned int, std::vector<GridIndex<dim>>>
    of_others(const Ranges &reached, const BackgroundGrid<dim> &grid) const;

    /** Makes the window around the cores, and finds whose windows hold some of
     *  these. Collective. */
    void
    make();

    GridBox<dim>                   whole_;
    std::vector<GridBox<dim>>      boxes_;
    std::vector<unsigned int>      begins{0}; // of each box, and the end
    Ranges                         cores;
    int                            rings = 0;
    std::map<unsigned int, Ranges> neighbors; // other ranks' windows
    bool                           alone = true;
    unsigned int                   rank  = 0;
    MPI_Comm                       comm  = MPI_COMM_SELF;
  };
} // namespace Morula

#endif
