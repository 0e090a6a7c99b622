// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_boundary_state_h
#define morula_particles_boundary_state_h

#include <morula/particles/columns.h>

#include <deal.II/base/array_view.h>
#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** Which cells a boundary point may look at where tissue touches tissue:
   *  those of its body and, if its body can touch itself, those behind it. */
  template <int dim>
  struct Side
  {
    unsigned int body;
    /** Outward normal of the surface; 0 if all cells of the body count. */
    Tensor<1, dim> n;

    /** Whether a cell at @p cell is on the side of the point at @p x. */
    bool
    has(const Point<dim> &x, const Point<dim> &cell) const
    {
      return n * (cell - x) <= 0.;
    }
  };


  /** What holds or loads a boundary point; numbers as in surface-NNNN.csv. */
  enum class SurfaceCondition
  {
    free   = 0,
    fixed  = 1,
    slip   = 2,
    loaded = 3
  };

  /** Whether a boundary point is fixed or slips, and so is held. */
  inline bool
  is_held(const SurfaceCondition condition)
  {
    return condition == SurfaceCondition::fixed ||
           condition == SurfaceCondition::slip;
  }

  /** A value of BoundaryColumns::cavity, the same for no two bodies' cavities;
   *  0: it is not known, 1: the outside. @param faced as in CellSurface */
  constexpr unsigned int
  faced_cavity(const unsigned int body, const unsigned int faced)
  {
    return faced == 0 ? 1 : 1 + faced + (body << 16);
  }

  /**
   * The columns of the boundary points. All scenes have the same ones, except
   * those of a point's patch, which exist only if the scene refines the
   * surface, and the force, which exists only with conditions.
   */
  template <int dim>
  class BoundaryColumns : public Columns
  {
  public:
    /** Declares the body and the pressure of contact, and its time where bodies
     *  fuse: for bodies that interact. */
    void
    need_bodies(const bool fuses = false, const bool with_parts = false);

    /** @param with_patch whether the scene refines the surface
     *  @param coarsens whether it also merges patches that shrink
     *  @param with_force whether conditions hold or load some points */
    explicit BoundaryColumns(const bool with_patch = false,
                             const bool coarsens   = false,
                             const bool with_force = false);

    /**
     * The row of a point at t = 0: at @p X (µm), with outward unit normal
     * @p N and @p area (µm^(dim-1)). Its patch, if it has one, is square:
     * doc/theory.md, section 4.5. If the normal is parallel to an axis, so are
     * the patch's edges.
     */
    std::vector<double>
    initial_point(const Point<dim>      &X,
                  const Tensor<1, dim>  &N,
                  const double           area,
                  const SurfaceCondition condition) const;

    /**
     * Gives a point the deformation gradient @p F and the present area vector
     * @p area (µm^(dim-1)): sets N, a⁰ and the edges so that the patch is
     * square now. Only with patch.
     */
    void
    set_square_patch(const ArrayView<double> &row,
                     const Tensor<2, dim>    &F,
                     const Tensor<1, dim>    &area) const;

    /** X, µm. */
    Column<Point<dim>> initial_position;
    /** N. */
    Column<Tensor<1, dim>> initial_normal;
    /** a⁰, µm^(dim-1). */
    Column<double> initial_area;
    /** What holds or loads it. */
    Column<SurfaceCondition> condition;
    /** F. */
    Column<Tensor<2, dim>> deformation;
    /** The initial position of the point at t = 0 of which this one is a part,
     *  µm; only with patch. */
    Column<Point<dim>> seed_position;
    /** The tangential edges of the patch in the initial configuration, µm; only
     *  with patch. They span a⁰. */
    std::array<Column<Tensor<1, dim>>, dim - 1> edges;
    /** If the surface is coarsened: the area that a patch shall have, that of
     *  the point at t = 0, µm^(dim-1). */
    Column<double> reference_area;
    /** With conditions: force of all of them on the tissue at the end of the
     *  last step, kPa µm^(dim-1). */
    Column<Tensor<1, dim>> force;
    /** Number of the body that the point belongs to; only with contact. */
    Column<unsigned int> body;
    /** Number of the part of its grid cell that it belongs to, see Parting;
     *  only where bodies can touch themselves. */
    Column<unsigned int> part;
    /** Pressure of other bodies at the end of the last step, kPa; likewise. */
    Column<double> contact_pressure;
    /** For how long another body has touched the point, day; if bodies fuse. */
    Column<double> contact_age;
    /** Which two-sided obstacles hold the point, as a sum of 2^k for number k
     *  of them; only where there are some. */
    Column<unsigned int> touched;
    /** Which cavity the point faces, see faced_cavity(); only where an effect
     *  has to know. */
    Column<unsigned int> cavity;
  };

  /**
   * One boundary point: see RowView.
   */
  template <int dim, typename Number = const double>
  class BoundaryView : public RowView<BoundaryColumns<dim>, Number>
  {
    using Base = RowView<BoundaryColumns<dim>, Number>;
    using Base::columns_;

  public:
    using Base::Base;
    using Base::get;
    using Base::set;

    /** A view for reading from one for writing. */
    BoundaryView(const BoundaryView<dim, double> &other)
      : Base(other.row(), other.columns())
    {}

    /** The two-sided obstacles that hold it. */
    unsigned int
    touched() const
    {
      return columns_.touched.exists() ? get(columns_.touched) : 0;
    }

    /** X, µm. */
    Point<dim>
    initial_position() const
    {
      return get(columns_.initial_position);
    }

    /** N. */
    Tensor<1, dim>
    initial_normal() const
    {
      return get(columns_.initial_normal);
    }

    /** a⁰, µm^(dim-1). */
    double
    initial_area() const
    {
      return get(columns_.initial_area);
    }

    /** What holds or loads it. */
    SurfaceCondition
    condition() const
    {
      return get(columns_.condition);
    }

    /** F. */
    Tensor<2, dim>
    F() const
    {
      return get(columns_.deformation);
    }

    /** F -> f F: doc/theory.md (1.1), equation (10) of the paper. */
    void
    deform(const Tensor<2, dim> &f) const
    {
      set(columns_.deformation, f * F());
    }

    /** The present area vector a n = det F F⁻ᵀ a⁰ N: doc/theory.md (1.2),
     *  equation (11) of the paper. */
    Tensor<1, dim>
    area_vector() const
    {
      const Tensor<2, dim> F = this->F();
      return determinant(F) * initial_area() * (initial_normal() * invert(F));
    }

    /** Whether the patch's edges are known: only if the scene refines the
     *  surface. */
    bool
    has_patch() const
    {
      return columns_.seed_position.exists();
    }

    /** Initial position of the point at t = 0 of which this one is a part, µm.
     *  It is the point's own unless the surface was refined. */
    Point<dim>
    seed_position() const
    {
      return has_patch() ? get(columns_.seed_position) : initial_position();
    }

    /** Edge @p k of the patch in the initial configuration, µm. Only with
     *  has_patch(). */
    Tensor<1, dim>
    initial_edge(const unsigned int k) const
    {
      return get(columns_.edges[k]);
    }

    /** The area that the patch shall have if edges longer than @p longest_edge
     *  (µm) are split: doc/theory.md (4.12b), µm^(dim-1). Only if the surface
     *  is coarsened. */
    double
    wanted_area(const double longest_edge) const
    {
      return std::min(get(columns_.reference_area),
                      std::pow(longest_edge, dim - 1));
    }

    /** Halves the patch across its edge @p k. Keeps the half at the edge's end
     *  (sign +1) or at its beginning (-1). Only with has_patch(). */
    void
    halve(const unsigned int k, const double sign) const
    {
      const Tensor<1, dim> E = initial_edge(k);
      set(columns_.initial_position, initial_position() + 0.25 * sign * E);
      set(columns_.edges[k], 0.5 * E);
      set(columns_.initial_area, 0.5 * initial_area());
      if (columns_.force.exists())
        set(columns_.force, 0.5 * get(columns_.force));
    }

    /**
     * The point's distance to its neighbours, µm. It is the side of a square of
     * the patch's area. If the patch's edges are known, it is the side of the
     * square inscribed in the circle around the patch.
     */
    double
    spacing() const
    {
      const Tensor<2, dim> F = this->F();
      if (!has_patch())
        return std::pow(area_vector().norm(), 1. / (dim - 1));
      const Tensor<1, dim> first = F * initial_edge(0);
      if (dim == 2)
        return first.norm();
      const Tensor<1, dim> second = F * initial_edge(dim - 2);
      return std::max((first + second).norm(), (first - second).norm()) /
             std::sqrt(2.);
    }
  };
} // namespace Morula

#endif
