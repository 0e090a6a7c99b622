// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_grid_window_h
#define morula_grid_grid_window_h

#include <morula/base/send_records.h>
#include <morula/grid/background_grid.h>
#include <morula/grid/grid_boxes.h>

#include <map>
#include <utility>
#include <vector>

namespace Morula
{
  /**
   * The part of the grid that a rank knows: the grid cells that its points
   * reach, those of others' points that it owns, and some rings around them.
   * Tables of grid cells are as long as the window of the rank, not as the
   * grid's box: where a rank has parts of the tissue that stand apart, its
   * window is several boxes. On one rank it is what the tissue reaches;
   * there is nothing outside.
   *
   * Grid cells have their number in the window where they stand in tables, and
   * their number in the grid's box in records that ranks tell each other.
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
    widen(const bool here);

    /** The window's grid cells and their numbers. */
    const GridBoxes<dim> &
    boxes() const
    {
      return boxes_;
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
      std::vector<Record>                         own;
      std::map<unsigned int, std::vector<Record>> others;
      for (const Record &record : records)
        if (const unsigned int owner = grid.owner(record.number); owner == rank)
          own.push_back(record);
        else
          others[owner].push_back(record);
      for (const auto &[sender, list] : send_records(others, comm))
        own.insert(own.end(), list.begin(), list.end());
      return own;
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
      std::vector<Record> received;
      if (alone)
        return received;
      std::map<unsigned int, std::vector<Record>> others;
      for (const Record &record : own)
        {
          const GridIndex<dim> index = whole_.index(record.number);
          for (const auto &[other, ranges] : neighbors)
            if (is_in(ranges, index))
              others[other].push_back(record);
        }
      for (const auto &[sender, list] : send_records(others, comm))
        received.insert(received.end(), list.begin(), list.end());
      return received;
    }

    MPI_Comm
    communicator() const
    {
      return comm;
    }

  private:
    using Ranges = std::vector<GridRange<dim>>;

    /** Whether one of the ranges contains the grid cell. */
    static bool
    is_in(const Ranges &ranges, const GridIndex<dim> &index);

    /** Grid cells of other ranks that splines of this rank's points may stand
     *  on, by owner. */
    std::map<unsigned int, std::vector<GridIndex<dim>>>
    of_others(const Ranges &reached, const BackgroundGrid<dim> &grid) const;

    /** Makes the window around the cores, and finds whose windows hold some of
     *  these. Collective. */
    void
    make();

    GridBox<dim>                   whole_;
    GridBoxes<dim>                 boxes_;
    Ranges                         cores;
    int                            rings = 0;
    std::map<unsigned int, Ranges> neighbors; // other ranks' windows
    bool                           alone = true;
    unsigned int                   rank  = 0;
    MPI_Comm                       comm  = MPI_COMM_SELF;
  };
} // namespace Morula

#endif
