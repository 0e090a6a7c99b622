// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_grid_window_h
#define morula_grid_grid_window_h

#include <morula/base/send_records.h>
#include <morula/grid/background_grid.h>

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
    empty() const;

    /** Whether the grid cell is one of them. */
    bool
    contains(const GridIndex<dim> &index) const;

    /** Makes it the smallest that holds the other one, too. */
    void
    unite(const GridRange &other);

    /** With @p rings more grid cells on all sides, but inside of @p box. */
    GridRange
    grown(const int rings, const GridBox<dim> &box) const;
  };

  /**
   * The part of the grid that a rank knows: the grid cells that its points
   * reach, those that it owns there, and some rings around them. Tables of
   * grid cells are as long as the window of the rank, not as the box. On one
   * rank the window is the box.
   *
   * Grid cells have their number in the window where they stand in tables, and
   * their number in the grid's box in records that ranks tell each other.
   */
  template <int dim>
  class GridWindow
  {
  public:
    /** Corners of an axis-parallel box that points reach over, µm. */
    using Extent = std::pair<Point<dim>, Point<dim>>;

    GridWindow() = default;

    /** All of a box, on one rank. */
    explicit GridWindow(const GridBox<dim> &box);

    /** The window of this rank, whose points reach over @p extents. The
     *  partition of @p grid is that of now. Collective. */
    GridWindow(const BackgroundGrid<dim> &grid,
               const std::vector<Extent> &extents);

    /** Takes twice as many rings. Collective. */
    void
    widen();

    /** The window's grid cells and their numbers. */
    const GridBox<dim> &
    box() const;

    /** That of the grid. */
    const GridBox<dim> &
    whole() const;

    /** Whether the window holds all grid cells of the grid whose coordinates
     *  differ by at most @p radius from those of @p center. */
    bool
    holds(const GridIndex<dim> &center, const int radius) const;

    /** The grid cells of which the window holds(., rings). */
    GridRange<dim>
    inner(const int rings) const;

    /**
     * Tells the owners of grid cells what ranks know of them. Collective.
     * @tparam Record with a `number` in the grid's box
     * @return the records of this rank's grid cells, from all ranks
     */
    template <typename Record>
    std::vector<Record>
    to_owners(const std::vector<Record> &records,
              const BackgroundGrid<dim> &grid) const
    {
      if (windows.empty())
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
     * @param own records of grid cells that no other rank tells of
     * @return those of other ranks in this rank's window
     */
    template <typename Record>
    std::vector<Record>
    to_windows(const std::vector<Record> &own) const
    {
      std::vector<Record> received;
      if (windows.empty())
        return received;
      std::map<unsigned int, std::vector<Record>> others;
      for (const Record &record : own)
        {
          const GridIndex<dim> index = whole_.index(record.number);
          for (unsigned int r = 0; r < windows.size(); ++r)
            if (r != rank && windows[r].contains(index))
              others[r].push_back(record);
        }
      for (const auto &[sender, list] : send_records(others, comm))
        received.insert(received.end(), list.begin(), list.end());
      return received;
    }

    MPI_Comm
    communicator() const;

  private:
    /** Makes the window around the core. Collective. */
    void
    make();

    GridBox<dim>                whole_, box_;
    GridRange<dim>              core{};
    int                         rings = 0;
    std::vector<GridRange<dim>> windows; // by rank; empty on one rank
    unsigned int                rank = 0;
    MPI_Comm                    comm = MPI_COMM_SELF;
  };
} // namespace Morula

#endif
