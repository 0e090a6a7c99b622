// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_tissue_h
#define morula_particles_tissue_h

#include <morula/grid/background_grid.h>
#include <morula/grid/particle_domain.h>
#include <morula/grid/parting.h>
#include <morula/grid/spline_space.h>
#include <morula/particles/boundary_state.h>
#include <morula/particles/cell_state.h>
#include <morula/particles/point_store.h>

#include <numeric>
#include <vector>

namespace Morula
{
  /** This rank's points of a kind by their position p in the canonical order.
   *  A whole point is `points[p]`. The ParticleHandler stores them. */
  template <int dim, typename OfColumns, template <int, typename> class View>
  class PointsWithColumns : public PointStore<dim>
  {
  public:
    /** No points yet, with these columns. */
    explicit PointsWithColumns(const OfColumns &columns)
      : PointStore<dim>(columns.n_numbers(), columns.body, columns.part)
      , columns_(columns)
    {}

    /** The columns of a point. */
    const OfColumns &
    columns() const
    {
      return columns_;
    }

    /** One point. */
    View<dim, const double>
    operator[](const unsigned int p) const
    {
      return {this->row(p), columns_};
    }

    /** One point, for writing. */
    View<dim, double>
    operator[](const unsigned int p)
    {
      return {this->row(p), columns_};
    }

  private:
    const OfColumns columns_;
  };


  /** This rank's boundary points: `points[p].F()`, `points.area_vector(p)`. */
  template <int dim>
  class BoundaryPoints
    : public PointsWithColumns<dim, BoundaryColumns<dim>, BoundaryView>
  {
  public:
    using PointsWithColumns<dim, BoundaryColumns<dim>, BoundaryView>::
      PointsWithColumns;

    /** What holds or loads the point. */
    SurfaceCondition
    condition(const unsigned int p) const
    {
      return (*this)[p].condition();
    }

    /** The present area vector a n, µm^(dim-1). */
    Tensor<1, dim>
    area_vector(const unsigned int p) const
    {
      return (*this)[p].area_vector();
    }

    /** Which cells each point may look at; empty without contact. */
    std::vector<Side<dim>>
    sides() const
    {
      std::vector<unsigned int> all(this->size());
      std::iota(all.begin(), all.end(), 0u);
      return sides_of(all);
    }

    /** The same of some points of this rank. */
    std::vector<Side<dim>>
    sides_of(const std::vector<unsigned int> &points) const
    {
      std::vector<Side<dim>> list;
      if (this->has_bodies())
        for (const unsigned int p : points)
          list.push_back({this->body(p),
                          this->has_parts() ?
                            area_vector(p) / area_vector(p).norm() :
                            Tensor<1, dim>()});
      return list;
    }
  };


  /** This rank's cells: `cells[p].F()`, `cells.get(column, p)`. */
  template <int dim>
  class Cells : public PointsWithColumns<dim, CellColumns<dim>, CellView>
  {
  public:
    using PointsWithColumns<dim, CellColumns<dim>, CellView>::PointsWithColumns;

    /** V⁰, µm^dim. */
    double
    initial_volume(const unsigned int p) const
    {
      return (*this)[p].initial_volume();
    }

    /** V = V⁰ det F, µm^dim. */
    double
    volume(const unsigned int p) const
    {
      return (*this)[p].volume();
    }
  };


  /**
   * The box of volume V around a cell, deformed as the cell is: doc/theory.md
   * (2.2b). Where cells proliferate, only their elastic deformation counts: a
   * cell that grows to double length and divides leaves two of the shape that
   * it had, though F stays doubled.
   */
  template <int dim>
  DeformedCube<dim>
  cell_shape(const CellView<dim, const double> &cell)
  {
    if (!cell.columns().parent.exists())
      return {cell.initial_volume(), cell.F()};
    return {cell.initial_volume() * determinant(cell.growth()),
            cell.elastic_deformation()};
  }

  /** As cell_shape(), around @p x, µm. */
  template <int dim>
  ParticleDomain<dim>
  cell_domain(const Point<dim> &x, const CellView<dim, const double> &cell)
  {
    return cell_shape<dim>(cell).at(x);
  }


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
      const BoundaryColumns<dim> &boundary_columns = BoundaryColumns<dim>())
      : parameters(parameters)
      , grid_(parameters, comm)
      , cells_(cell_columns)
      , boundary_points_(boundary_columns)
    {}

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
    cell(const unsigned int p)
    {
      return cells_[p];
    }

    /** Boundary point @p p of this rank, to be written. */
    BoundaryView<dim, double>
    boundary_point(const unsigned int p)
    {
      return boundary_points_[p];
    }

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
           const std::vector<unsigned int> &boundary_points)
    {
      cells_.remove(cells, grid_);
      boundary_points_.remove(boundary_points, grid_);
    }

    /** Takes these boundary points in place of the present ones. Collective. */
    void
    replace_surface(const PointList<dim> &boundary_points)
    {
      const auto [first, last] =
        extent<dim>({&boundary_points.positions}, grid_);
      if (!grid_.covers(first, last))
        {
          place(cells_.copy(), boundary_points);
          return;
        }
      boundary_points_.clear();
      boundary_points_.insert(boundary_points, grid_);
    }

    /** See PointStore. */
    void
    defragment()
    {
      cells_.defragment(grid_);
      boundary_points_.defragment(grid_);
    }

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
    cells() const
    {
      return cells_;
    }

    const BoundaryPoints<dim> &
    boundary_points() const
    {
      return boundary_points_;
    }

    /** The box that cell @p p of this rank occupies: its cube, deformed if the
     *  scene gives cells several points, doc/theory.md (2.2b). */
    ParticleDomain<dim>
    domain(const unsigned int p) const
    {
      return parameters.points_per_cell > 1 ?
               cell_domain<dim>(cells_.position(p), cells_[p]) :
               ParticleDomain<dim>(cells_.position(p), cells_.volume(p));
    }

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

  /** The parting of the tissue as it is now, on all ranks. Collective. */
  template <int dim>
  Parting<dim>
  find_parting(const Tissue<dim> &tissue);

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
