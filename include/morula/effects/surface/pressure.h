// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_pressure_h
#define morula_effects_surface_pressure_h

#include <morula/effects/surface/boundary_condition.h>
#include <morula/effects/surface/condition_keys.h>

namespace Morula
{
  /** The keys of the pressure, in section "Boundary conditions". */
  struct PressureParameters : public ConditionKeys
  {
    PressureParameters();

    ExpressionKey pressure; // kPa

    using Keys::list;
    KeyList
    list() override;
    std::string
    details() const override;
  };

  /** Pressure that follows the surface: doc/theory.md (4.8). */
  template <int dim>
  class Pressure : public BoundaryCondition<dim>
  {
  public:
    using Parameters = PressureParameters;

    /** @throws InputError for expressions that cannot be parsed */
    explicit Pressure(const Parameters &parameters);

    SurfaceCondition
    kind() const override;
    bool
    acts_on(const Point<dim> &X, const Tensor<1, dim> &N) const override;
    std::unique_ptr<Term<dim>>
    term(const LoadedPoints<dim> &points, const double t) const override;
    void
    check(const Preview<dim> &scene) const override;

  private:
    const Expression where, pressure;
  };
} // namespace Morula

#endif
