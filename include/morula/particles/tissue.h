// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_tissue_h
#define morula_particles_tissue_h

#include <morula/grid/background_grid.h>
#include <morula/grid/particle_domain.h>
#include <morula/grid/spline_space.h>
#include <morula/particles/cell_state.h>
#include <morula/particles/point_store.h>

#include <vector>

namespace Morula
{
  /**
   * The tissue on its background grid: cells and boundary points, distributed
   * over the ranks by the grid cell they are in.
   */
  template <int dim>
  class Tissue
  {
  public:
    /** @param n_boundary_slots properties of a boundary point */
    Tissue(const GridParameters &parameters,
           const CellSlots<dim> &slots,
           const MPI_Comm        comm,
           const unsigned int n_boundary_slots = BoundarySlots<dim>::n_slots);

    /**
     * Takes these points as the tissue, wherever they are; this rank gives any
     * part of them. The grid is kept as long as the tissue stays inside its
     * padding and the ranks' loads stay balanced. Collective.
     */
    void
    place(const PointList<dim> &cells, const PointList<dim> &boundary_points);

    /**
     * Moves this rank's cells and boundary points to these positions (µm), in
     * the order of their stores; what has been written to cell_properties() and
     * boundary_properties() goes with them. Collective.
     */
    void
    move(const std::vector<Point<dim>> &cells,
         const std::vector<Point<dim>> &boundary_points);

    /** Properties of this rank's points, by position in their stores. */
    ArrayView<double>
    cell_properties(const unsigned int p);

    /** The same of a boundary point. */
    ArrayView<double>
    boundary_properties(const unsigned int p);

    /**
     * The same as place() on a given box and partition, as they were when a
     * snapshot was written. Collective.
     */
    void
    restore(const PointList<dim>            &cells,
            const PointList<dim>            &boundary_points,
            const GridIndex<dim>            &first,
            const GridIndex<dim>            &n,
            const std::vector<unsigned int> &weights);

    /** Removes mothers and inserts daughters. Collective. */
    void
    replace(const std::vector<typename PointStore<dim>::Iterator> &mothers,
            const PointList<dim>                                  &daughters);

    /** Takes these boundary points in place of the present ones. Collective. */
    void
    replace_surface(const PointList<dim> &boundary_points);

    /** See PointStore. */
    void
    defragment();

    /**
     * The extended B-splines around the tissue as it is now. Collective.
     * @param share_points see Occupancy
     */
    SplineSpace<dim>
    splines(const bool share_points = false) const;

    const BackgroundGrid<dim> &
    grid() const;

    const PointStore<dim> &
    cells() const;

    const PointStore<dim> &
    boundary_points() const;

    const CellSlots<dim> &
    slots() const;

    /** State of a cell of this rank. */
    CellView<dim, const double>
    cell(const typename PointStore<dim>::Iterator &particle) const;

    /** The box that a cell of this rank occupies: its cube, deformed where
     *  cells have several points by the scene's wish, doc/theory.md (2.2b). */
    ParticleDomain<dim>
    domain(const typename PointStore<dim>::Iterator &particle) const;

    MPI_Comm
    communicator() const;

  private:
    /** Whether the ranks' loads are about equal. */
    bool
    balanced(const std::vector<unsigned int> &counts) const;

    const GridParameters parameters;
    const CellSlots<dim> slots_;
    BackgroundGrid<dim>  grid_;
    PointStore<dim>      cells_;
    PointStore<dim>      boundary_points_;
  };

  /**
   * A selection of a store's points by active grid cell: the selected points
   * of active grid cell c are points[offsets[c]...offsets[c+1]), as positions
   * in PointStore::order().
   */
  struct PointGroups
  {
    std::vector<unsigned int> offsets;
    std::vector<unsigned int> points;
  };

  /** Groups the points for which select(iterator) holds. */
  template <int dim, typename Select>
  PointGroups
  group_points(const PointStore<dim>  &store,
               const SplineSpace<dim> &space,
               const Select           &select)
  {
    PointGroups groups;
    groups.offsets.push_back(0);
    auto cell = store.grid_cells().begin();
    for (const auto &active : space.grid_cells())
      {
        if (cell != store.grid_cells().end() && cell->number == active.number)
          {
            for (unsigned int p = cell->begin; p < cell->end; ++p)
              if (select(store.order()[p]))
                groups.points.push_back(p);
            ++cell;
          }
        groups.offsets.push_back(groups.points.size());
      }
    return groups;
  }
} // namespace Morula

#endif
