// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_point_store_h
#define morula_particles_point_store_h

#include <morula/grid/background_grid.h>
#include <morula/particles/columns.h>
#include <morula/particles/point_list.h>

#include <deal.II/fe/mapping_q1.h>
#include <deal.II/particles/particle_handler.h>

#include <vector>

namespace Morula
{
  /**
   * Points (cells, or boundary points) on the background grid: a deal.II
   * ParticleHandler whose particles are on the rank that owns their grid cell,
   * and a canonical order over them: by grid cell, by part, then by id. The
   * order does not depend on the history, so that sums over points come out the
   * same in a resumed run.
   */
  template <int dim>
  class PointStore
  {
  public:
    /** The points of one part of the tissue in a grid cell: those from begin
     *  to end - 1. Without contact there is one for each grid cell, part 0;
     *  with contact of bodies it is the number of a body; where a body can
     *  touch itself it is that of Parting. */
    struct GridCell
    {
      unsigned int number; // of the grid cell in the box
      unsigned int begin, end;
      unsigned int part;
    };

    /** @param n_numbers in a point's row
     *  @param body the column with the number of a point's body, if the scene
     *         has contact
     *  @param part the column with its part of the grid cell, if bodies can
     *         touch themselves */
    explicit PointStore(const unsigned int          n_numbers,
                        const Column<unsigned int> &body = {},
                        const Column<unsigned int> &part = {})
      : n_numbers(n_numbers)
      , body_column(body)
      , part_column(part)
    {}

    /**
     * Binds the store to the grid's present triangulation. All points must
     * have been taken out before; the triangulation must outlive them.
     */
    void
    attach(const BackgroundGrid<dim> &grid)
    {
      Assert(order.empty(), ExcMessage("Take the points out first."));
      handler.initialize(grid.triangulation(), mapping, n_numbers);
      capacity = 0;
    }

    /**
     * Inserts points, which may be anywhere: each is sent to the rank that owns
     * its grid cell. Collective.
     */
    void
    insert(PointList<dim> points, const BackgroundGrid<dim> &grid);

    /**
     * Moves the points of this rank to these positions (µm), in order; those
     * that leave it are sent to their new owners. Collective.
     */
    void
    move(const std::vector<Point<dim>> &positions,
         const BackgroundGrid<dim>     &grid);

    /** Removes these points of this rank, given by their positions in the
     *  order, and inserts others as insert() does. Collective. */
    void
    replace(const std::vector<unsigned int> &removed,
            const PointList<dim>            &inserted,
            const BackgroundGrid<dim>       &grid)
    {
      take_out(removed);
      insert(inserted, grid);
    }

    /** Removes these points of this rank, given by their positions in the
     *  order. Collective: deal.II counts the points of all ranks. */
    void
    remove(const std::vector<unsigned int> &removed,
           const BackgroundGrid<dim>       &grid)
    {
      n_disordered += removed.size();
      take_out(removed);
      sort(grid);
    }

    /** Takes all points of this rank out of the store. */
    void
    clear()
    {
      order.clear();
      grid_cells_.clear();
      handler.clear_particles(); // gives back its memory
      capacity     = 0;
      n_disordered = 0;
    }

    /** Takes all points of this rank out of the store, and returns them in
     *  order. */
    PointList<dim>
    take()
    {
      PointList<dim> points = copy();
      clear();
      return points;
    }

    /**
     * Sorts the memory of this rank's points into the canonical order, if many
     * have been replaced or have changed their grid cell since the last time.
     * Loops in this order are then several times as fast.
     */
    void
    defragment(const BackgroundGrid<dim> &grid)
    {
      if (n_disordered > worst_disorder * order.size())
        insert_own(take(), grid);
    }

    /** A copy of all points of this rank, in order. */
    PointList<dim>
    copy() const
    {
      PointList<dim> points(n_numbers);
      points.reserve(size());
      for (unsigned int p = 0; p < size(); ++p)
        points.add(id(p), position(p), row(p));
      return points;
    }

    /** Grid cells of this rank that hold points, by number. */
    const std::vector<GridCell> &
    grid_cells() const
    {
      return grid_cells_;
    }

    /** How many points this rank has. */
    unsigned int
    size() const
    {
      return order.size();
    }

    /** Id of the point at position @p p of the canonical order. */
    types::particle_index
    id(const unsigned int p) const
    {
      return order[p]->get_id();
    }

    /** Where it is, µm. */
    const Point<dim> &
    position(const unsigned int p) const
    {
      return order[p]->get_location();
    }

    /** The number of its body; 0 in a scene without contact. */
    unsigned int
    body(const unsigned int p) const
    {
      return body_column.exists() ? get(body_column, p) : 0;
    }

    /** The part of the tissue in its grid cell that it belongs to: see
     *  GridCell. */
    unsigned int
    part(const unsigned int p) const
    {
      return part_column.exists() ? get(part_column, p) : body(p);
    }

    /** Whether parts are found in each step: a body can touch itself. */
    bool
    has_parts() const
    {
      return part_column.exists();
    }

    /** Sets the parts of all points of this rank, and orders them anew. */
    void
    set_parts(const std::vector<unsigned int> &parts,
              const BackgroundGrid<dim>       &grid)
    {
      for (unsigned int p = 0; p < size(); ++p)
        set(part_column, p, parts[p]);
      sort(grid);
    }

    /** Whether the points know their bodies. */
    bool
    has_bodies() const
    {
      return body_column.exists();
    }

    /** The bodies of all points of this rank; empty in a scene without contact.
     */
    std::vector<unsigned int>
    bodies() const
    {
      std::vector<unsigned int> list;
      if (has_bodies())
        for (unsigned int p = 0; p < size(); ++p)
          list.push_back(body(p));
      return list;
    }

    /** Positions of all points of this rank, µm. */
    std::vector<Point<dim>>
    positions() const
    {
      std::vector<Point<dim>> list;
      list.reserve(size());
      for (unsigned int p = 0; p < size(); ++p)
        list.push_back(position(p));
      return list;
    }

    /** Positions (µm) of some of this rank's points. */
    std::vector<Point<dim>>
    positions_of(const std::vector<unsigned int> &points) const
    {
      std::vector<Point<dim>> list;
      for (const unsigned int p : points)
        list.push_back(position(p));
      return list;
    }

    /** The value in a column. */
    template <typename T>
    T
    get(const Column<T> &column, const unsigned int p) const
    {
      return column.get(row(p));
    }

    /** Writes the value in a column. */
    template <typename T>
    void
    set(const Column<T>                &column,
        const unsigned int              p,
        const typename Column<T>::Type &value)
    {
      column.set(row(p), value);
    }

  protected:
    /** The point's row of numbers. */
    ArrayView<const double>
    row(const unsigned int p) const
    {
      const Particles::ParticleAccessor<dim> &point = *order[p];
      return point.get_properties();
    }

    /** The point's row of numbers, to be written. */
    ArrayView<double>
    row(const unsigned int p)
    {
      return order[p]->get_properties();
    }

  private:
    /** Share of points out of order in memory from which putting them in order
     *  costs less than it saves (doc/performance.md, Where cells lie in
     *  memory). */
    static constexpr double worst_disorder = 0.1;

    using Iterator =
      typename Particles::ParticleHandler<dim>::particle_iterator;

    /** Inserts points of this rank's grid cells, in their canonical order. */
    void
    insert_own(const PointList<dim> &points, const BackgroundGrid<dim> &grid);

    void
    sort(const BackgroundGrid<dim> &grid);

    /** Removes points, after which order is not valid. Collective. */
    void
    take_out(const std::vector<unsigned int> &removed);

    /** Makes room for @p n points. */
    void
    reserve(const std::size_t n);

    const unsigned int         n_numbers;
    const Column<unsigned int> body_column, part_column;
    std::size_t                capacity = 0; // number of points that fit
    /** Points inserted or removed since all of them were in order, without
     *  gaps, in memory. */
    std::size_t                     n_disordered = 0;
    MappingQ1<dim>                  mapping;
    Particles::ParticleHandler<dim> handler;
    std::vector<GridCell>           grid_cells_;
    std::vector<Iterator>           order;
  };

  /**
   * Coordinates of the first and the last grid cell that hold any of these
   * points, over all ranks. Collective.
   */
  template <int dim>
  std::pair<GridIndex<dim>, GridIndex<dim>>
  extent(const std::vector<const std::vector<Point<dim>> *> &positions,
         const BackgroundGrid<dim>                          &grid);

  /**
   * Number of points in each of this rank's grid cells; for balancing.
   * Collective.
   * @param positions of points of any rank's grid cells, µm
   */
  template <int dim>
  GridCellCounts
  count_points(const std::vector<Point<dim>> &positions,
               const BackgroundGrid<dim>     &grid);
} // namespace Morula

#endif
