// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_point_term_h
#define morula_mechanics_point_term_h

#include <morula/mechanics/material_points.h>
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
        const GrowthAt         growth,
        LocalSystem<dim>      &system) const override;

    std::vector<Tensor<1, dim>>
    forces(const unsigned int     grid_cell,
           const LocalField<dim> &field) const override;

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
               LocalSystem<dim>        &system);

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
               LocalSystem<dim>        &system);

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
        LocalSystem<dim>      &system) const override;

  private:
    /** Energy and residual. */
    void
    add_point(const unsigned int       p,
              const SplineValues<dim> &splines,
              const LocalField<dim>   &field,
              LocalSystem<dim>        &system) const override;

    const std::vector<double>   stiffnesses;
    std::vector<Tensor<1, dim>> centre; // of each cell; empty: 0
    double                      strength = 1.;
  };
} // namespace Morula

#endif
