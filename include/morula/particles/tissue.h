// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_tissue_h
#define morula_particles_tissue_h

#include <morula/grid/background_grid.h>
#include <morula/grid/particle_domain.h>
#include <morula/grid/spline_space.h>
#include <morula/particles/boundary_points.h>
#include <morula/particles/cells.h>

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
    /** A tissue without cells. Its points will have these columns. */
    Tissue(
      const GridParameters       &parameters,
      const CellColumns<dim>     &cell_columns,
      const MPI_Comm              comm,
      const BoundaryColumns<dim> &boundary_columns = BoundaryColumns<dim>());

    /**
     * Takes these points, which may be anywhere, as the tissue; this rank gives
     * any part of them. The grid is kept as long as the tissue stays inside its
     * padding and the ranks' loads stay balanced. Collective.
     */
    void
    place(PointList<dim> cells, PointList<dim> boundary_points);

    /**
     * Moves this rank's cells and boundary points to these positions (µm), in
     * the order of their stores; values written by cell() and boundary_point()
     * move with them. Collective.
     */
    void
    move(const std::vector<Point<dim>> &cells,
         const std::vector<Point<dim>> &boundary_points);

    /** Cell @p p of this rank, to be written. */
    CellView<dim, double>
    cell(const unsigned int p);

    /** Boundary point @p p of this rank, to be written. */
    BoundaryView<dim, double>
    boundary_point(const unsigned int p);

    /**
     * Like place(), but with the box and partition that a snapshot stored; this
     * rank gives any part of the weights. Collective.
     */
    void
    restore(PointList<dim>        cells,
            PointList<dim>        boundary_points,
            const GridIndex<dim> &first,
            const GridIndex<dim> &n,
            const GridCellCounts &weights);

    /** Removes mothers, given by their positions in cells(), and inserts
     *  daughters. Collective. */
    void
    replace(const std::vector<unsigned int> &mothers,
            const PointList<dim>            &daughters);

    /** Removes cells and boundary points of this rank, given by their positions
     *  in cells() and boundary_points(), in order. Collective. */
    void
    remove(const std::vector<unsigned int> &cells,
           const std::vector<unsigned int> &boundary_points);

    /** Takes these boundary points in place of the present ones. Collective. */
    void
    replace_surface(const PointList<dim> &boundary_points);

    /** See PointStore. */
    void
    defragment();

    /** Finds the parts of grid cells where tissue faces tissue across a gap,
     * and orders points by them; only if bodies can touch themselves.
     * Collective.
     */
    void
    part();

    /** The parts as part() has found them. */
    const Parting<dim> &
    parting() const
    {
      return *parting_;
    }

    /**
     * The extended B-splines around the tissue as it is now. Where points know
     * their bodies, each body has splines of its own; where bodies can touch
     * themselves, the parts that part() has found have. Collective.
     * @param share_points see Occupancy
     */
    SplineSpace<dim>
    splines(const bool share_points = false) const;

    /** The same, as if all points belonged to one body that is not parted.
     *  Collective. */
    SplineSpace<dim>
    unparted_splines(const bool share_points = false) const;

    const BackgroundGrid<dim> &
    grid() const
    {
      return grid_;
    }

    const Cells<dim> &
    cells() const;

    const BoundaryPoints<dim> &
    boundary_points() const;

    /** The box that cell @p p of this rank occupies: its cube, deformed if the
     *  scene gives cells several points, doc/theory.md (2.2b). */
    ParticleDomain<dim>
    domain(const unsigned int p) const;

    MPI_Comm
    communicator() const
    {
      return grid_.communicator();
    }

  private:
    /** Whether the ranks' loads are about equal with cells at @p positions
     * (µm), of which each rank gives any part. Collective. */
    bool
    balanced(const std::vector<Point<dim>> &positions) const;

    /** The splines around the points for which belongs(body) holds.
     *  Collective. */
    template <typename Belongs>
    SplineSpace<dim>
    splines_around(const Belongs            &belongs,
                   const bool                share_points,
                   const SharedParting<dim> &parting = {}) const;

    template <typename Belongs>
    std::vector<GridRange<dim>>
    reached(const std::vector<ParticleDomain<dim>> &domains,
            const Belongs                          &belongs) const;

    const GridParameters parameters;
    BackgroundGrid<dim>  grid_;
    Cells<dim>           cells_;
    BoundaryPoints<dim>  boundary_points_;
    SharedParting<dim>   parting_ = std::make_shared<const Parting<dim>>();
  };

  /** One more than the largest number of a body. Collective. */
  template <int dim>
  unsigned int
  n_bodies(const Tissue<dim> &tissue);

  /**
   * A selection of a store's points by active grid cell: the selected points
   * of active grid cell c are points[offsets[c]...offsets[c+1]), as positions
   * in the store.
   */
  struct PointGroups
  {
    std::vector<unsigned int> offsets;
    std::vector<unsigned int> points;
  };

  /** Groups the points for which select(p) holds. */
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
        // Where the space does not part bodies, a grid cell has the points of
        // all of them.
        for (; cell != store.grid_cells().end() &&
               space.is_at(active, cell->number, cell->part);
             ++cell)
          for (unsigned int p = cell->begin; p < cell->end; ++p)
            if (select(p))
              groups.points.push_back(p);
        groups.offsets.push_back(groups.points.size());
      }
    return groups;
  }
} // namespace Morula

#endif
