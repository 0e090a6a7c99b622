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
   * and a canonical order over them: by grid cell, by body, then by id. The
   * order does not depend on the history, so that sums over points come out the
   * same in a resumed run.
   */
  template <int dim>
  class PointStore
  {
  public:
    /** The points of one body in one grid cell: those from begin to end - 1.
     *  Without bodies there is one for each grid cell, with body 0. */
    struct GridCell
    {
      unsigned int number; // of the grid cell in the box
      unsigned int begin, end;
      unsigned int body;
    };

    /** @param n_numbers in a point's row
     *  @param body the column with the number of a point's body, if the scene
     *         has contact between bodies */
    explicit PointStore(const unsigned int          n_numbers,
                        const Column<unsigned int> &body = {});

    /**
     * Binds the store to the grid's present triangulation. All points must
     * have been taken out before; the triangulation must outlive them.
     */
    void
    attach(const BackgroundGrid<dim> &grid);

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
            const BackgroundGrid<dim>       &grid);

    /** Removes these points of this rank, given by their positions in the
     *  order. Collective: deal.II counts the points of all ranks. */
    void
    remove(const std::vector<unsigned int> &removed,
           const BackgroundGrid<dim>       &grid);

    /** Takes all points of this rank out of the store. */
    void
    clear();

    /** Takes all points of this rank out of the store, and returns them in
     *  order. */
    PointList<dim>
    take();

    /**
     * Sorts the memory of this rank's points into the canonical order, if many
     * have been replaced or have changed their grid cell since the last time.
     * Loops in this order are then several times as fast.
     */
    void
    defragment(const BackgroundGrid<dim> &grid);

    /** A copy of all points of this rank, in order. */
    PointList<dim>
    copy() const;

    /** Grid cells of this rank that hold points, by number. */
    const std::vector<GridCell> &
    grid_cells() const;

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

    /** Whether the points know their bodies. */
    bool
    has_bodies() const
    {
      return body_column.exists();
    }

    /** The bodies of all points of this rank; empty in a scene without contact.
     */
    std::vector<unsigned int>
    bodies() const;

    /** Positions of all points of this rank, µm. */
    std::vector<Point<dim>>
    positions() const;

    /** Positions (µm) of some of this rank's points. */
    std::vector<Point<dim>>
    positions_of(const std::vector<unsigned int> &points) const;

    /** Their bodies; empty in a scene without contact. */
    std::vector<unsigned int>
    bodies_of(const std::vector<unsigned int> &points) const;

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
    const Column<unsigned int> body_column;
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
