// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_point_term_h
#define morula_mechanics_point_term_h

#include <morula/mechanics/material_points.h>
#include <morula/mechanics/spline_moments.h>
#include <morula/mechanics/term.h>

#include <utility>
#include <vector>

namespace Morula
{
  /** A term that is a sum over points, which have nothing to do with each
   *  other. */
  template <int dim>
  class PointTerm : public Term<dim>
  {
  public:
    explicit PointTerm(GroupedPoints<dim> points)
      : points(std::move(points))
    {}

    void
    add(const unsigned int     grid_cell,
        const LocalField<dim> &field,
        const GrowthAt,
        LocalSystem<dim> &system) const override
    {
      // A term that has met an inverted point needs no further ones: the state
      // is refused anyway.
      for (unsigned int p = points.offsets[grid_cell];
           p < points.offsets[grid_cell + 1] && !system.inverted;
           ++p)
        add_point(p, SplineValues<dim>(points.xi[p], points.h), field, system);
    }

    std::vector<Tensor<1, dim>>
    forces(const unsigned int     grid_cell,
           const LocalField<dim> &field) const override
    {
      // A rigid translation moves all splines alike, so that a point's
      // residual, summed over them, is minus the force.
      std::vector<Tensor<1, dim>> list;
      LocalSystem<dim>            system(LocalSystem<dim>::energy_and_residual);
      for (unsigned int p = points.offsets[grid_cell];
           p < points.offsets[grid_cell + 1];
           ++p)
        {
          system.clear();
          add_point(p,
                    SplineValues<dim>(points.xi[p], points.h),
                    field,
                    system);
          Tensor<1, dim> force;
          for (unsigned int i = 0; i < dim; ++i)
            for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
              force[i] -= system.residual[i * BSpline<dim>::n + a];
          list.push_back(force);
        }
      return list;
    }

  protected:
    /**
     * Adds what @p system asks for at point number @p p.
     * @param splines at the point
     * @param field   displacement since the beginning of the step
     */
    virtual void
    add_point(const unsigned int       p,
              const SplineValues<dim> &splines,
              const LocalField<dim>   &field,
              LocalSystem<dim>        &system) const = 0;

    const GroupedPoints<dim> points;
  };

  /** Adds the residual of a force at a place, kPa µm^(dim-1). */
  template <int dim>
  void
  add_force_at(const SplineValues<dim> &splines,
               const Tensor<1, dim>    &force,
               LocalSystem<dim>        &system)
  {
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        system.add_force(i, a, force[i] * splines.value[a]);
  }

  /**
   * Adds what @p system asks for of a force at a place that depends on the
   * displacement there.
   * @param energy    kPa µm^dim
   * @param force     its derivative, kPa µm^(dim-1)
   * @param stiffness that of the force, kPa µm^(dim-2)
   */
  template <int dim>
  void
  add_force_at(const SplineValues<dim> &splines,
               const double             energy,
               const Tensor<1, dim>    &force,
               const Tensor<2, dim>    &stiffness,
               LocalSystem<dim>        &system)
  {
    constexpr unsigned int n      = BSpline<dim>::n;
    constexpr unsigned int n_dofs = LocalSystem<dim>::n_dofs;
    // Energy and residual come together, the tangent alone: this is how
    // Newton's method asks.
    if (system.wanted != LocalSystem<dim>::tangent)
      {
        system.add_energy(energy);
        add_force_at(splines, force, system);
        return;
      }
    // The stiffness at the point times N_a N_b: row by row, contiguous in b.
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int j = 0; j < dim; ++j)
          {
            const double factor = stiffness[i][j] * splines.value[a];
            double      *row    = &system.matrix[(i * n + a) * n_dofs + j * n];
            for (unsigned int b = 0; b < n; ++b)
              row[b] += factor * splines.value[b];
          }
  }

  /** A resistance to the displacement of cells in a step, with the energy
   *  Σ k |u|²/2: friction, doc/theory.md (4.7a), or the weak drag (4.8f). */
  template <int dim>
  class Drag : public PointTerm<dim>
  {
  public:
    /** k h²/(E V⁰) below which rounding decides where a free piece goes. */
    static constexpr double least = 1e-4;

    /** @param stiffnesses k of each cell, kPa µm^(dim-2) */
    Drag(GroupedPoints<dim> cells, std::vector<double> stiffnesses)
      : PointTerm<dim>(std::move(cells))
      , stiffnesses(std::move(stiffnesses))
    {}

    /** Lets the drag act from where these displacements of the cells (µm) have
     *  brought them, instead of from u = 0. */
    void
    set_centre(std::vector<Tensor<1, dim>> ways)
    {
      centre = std::move(ways);
    }

    /** Multiplies all k by @p strength, instead of by 1. */
    void
    set_strength(const double factor)
    {
      strength = factor;
    }

    void
    add(const unsigned int     grid_cell,
        const LocalField<dim> &field,
        const GrowthAt         growth,
        LocalSystem<dim>      &system) const override
    {
      // Energy and residual are sums over the cells, as for any point term.
      if (system.wanted != LocalSystem<dim>::tangent)
        {
          PointTerm<dim>::add(grid_cell, field, growth, system);
          return;
        }
      // The stiffness does not depend on u, so the moments of the cells in the
      // grid cell give the whole matrix: doc/theory.md (11.6). Entries cell by
      // cell would take far longer. All components have the same block.
      const GroupedPoints<dim> &cells = this->points;
      MassMoments<dim>          moments;
      for (unsigned int p = cells.offsets[grid_cell];
           p < cells.offsets[grid_cell + 1];
           ++p)
        moments.add(cells.xi[p], {{strength * stiffnesses[p]}});
      const std::vector<double> mass   = mass_matrix(moments);
      constexpr unsigned int    n      = BSpline<dim>::n;
      constexpr unsigned int    n_dofs = LocalSystem<dim>::n_dofs;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int a = 0; a < n; ++a)
          {
            double *const row = &system.matrix[(i * n + a) * n_dofs + i * n];
            for (unsigned int b = 0; b < n; ++b)
              row[b] += mass[a * n + b];
          }
    }

  private:
    /** Energy and residual. */
    void
    add_point(const unsigned int       p,
              const SplineValues<dim> &splines,
              const LocalField<dim>   &field,
              LocalSystem<dim>        &system) const override
    {
      Tensor<1, dim> u = field.value(splines);
      if (!centre.empty())
        u -= centre[p];
      const double k = strength * stiffnesses[p];
      system.add_energy(0.5 * k * u.norm_square());
      add_force_at(splines, k * u, system);
    }

    const std::vector<double>   stiffnesses;
    std::vector<Tensor<1, dim>> centre; // of each cell; empty: 0
    double                      strength = 1.;
  };
} // namespace Morula

#endif
