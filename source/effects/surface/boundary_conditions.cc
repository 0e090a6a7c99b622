// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/unit_vector.h>
#include <morula/effects/surface/boundary_conditions.h>

#include <algorithm>

namespace Morula
{
  namespace
  {
    /** Least penalty that keeps Nitsche's symmetric form definite, in units of
     *  (λ + 2μ)/h, and what is added for squeezed tissue, in units of the
     *  stiffness beyond that at rest by h: doc/theory.md (4.6). */
    constexpr double least_penalty = 20., squeezed_penalty = 100.;

    std::optional<Expression>
    where(const std::string &key, const std::string &text)
    {
      return text.empty() ? std::optional<Expression>() :
                            Expression("Boundary conditions/" + key, text);
    }
  } // namespace

  template <int dim>
  BoundaryConditions<dim>::BoundaryConditions(
    const BoundaryConditionParameters &parameters)
    : fixed_where(where("Fixed where", parameters.fixed_where))
    , slip_where(where("Slip where", parameters.slip_where))
    , traction_where(where("Traction where", parameters.traction_where))
    , pressure_where(where("Pressure where", parameters.pressure_where))
    , displacement_("Boundary conditions/Displacement",
                    parameters.displacement,
                    3,
                    dim)
    , traction_("Boundary conditions/Traction", parameters.traction, 3, dim)
    , pressure_("Boundary conditions/Pressure", parameters.pressure)
    , has_slip_normal(!parameters.slip_normal.empty())
    , relative_penalty(parameters.nitsche_penalty)
    , form(parameters.nitsche_form == "symmetric" ? NitscheForm::symmetric :
                                                    NitscheForm::unsymmetric)
  {
    if (has_slip_normal)
      slip_normal = unit_vector<dim>("Boundary conditions/Slip normal",
                                     parameters.slip_normal);
  }

  template <int dim>
  bool
  BoundaryConditions<dim>::holds(const std::optional<Expression> &where,
                                 const Point<dim>                &X) const
  {
    return where && where->value(X, 0.) > 0.;
  }

  template <int dim>
  SurfaceCondition
  BoundaryConditions<dim>::condition(const Point<dim>     &X,
                                     const Tensor<1, dim> &N) const
  {
    if (holds(fixed_where, X))
      return SurfaceCondition::fixed;
    if (holds(slip_where, X) &&
        (!has_slip_normal || std::abs(N * slip_normal) > 0.9))
      return SurfaceCondition::slip;
    if (holds(traction_where, X) || holds(pressure_where, X))
      return SurfaceCondition::loaded;
    return SurfaceCondition::free;
  }

  template <int dim>
  Tensor<1, dim>
  BoundaryConditions<dim>::displacement(const Point<dim> &X,
                                        const double      t) const
  {
    return displacement_.vector(X, t);
  }

  template <int dim>
  Tensor<1, dim>
  BoundaryConditions<dim>::traction(const Point<dim> &X_seed,
                                    const Point<dim> &X,
                                    const double      t) const
  {
    return holds(traction_where, X_seed) ? traction_.vector(X, t) :
                                           Tensor<1, dim>();
  }

  template <int dim>
  double
  BoundaryConditions<dim>::pressure(const Point<dim> &X_seed,
                                    const Point<dim> &X,
                                    const double      t) const
  {
    return holds(pressure_where, X_seed) ? pressure_.value(X, t) : 0.;
  }

  template <int dim>
  bool
  BoundaryConditions<dim>::has_dirichlet() const
  {
    return fixed_where || slip_where;
  }

  template <int dim>
  bool
  BoundaryConditions<dim>::has_traction() const
  {
    return traction_where.has_value();
  }

  template <int dim>
  bool
  BoundaryConditions<dim>::has_pressure() const
  {
    return pressure_where.has_value();
  }

  template <int dim>
  double
  BoundaryConditions<dim>::penalty(const double           E,
                                   const Lame            &lame,
                                   const double           stiffness,
                                   const VolumetricStrain volumetric_form,
                                   const double           h) const
  {
    if (volumetric_form == VolumetricStrain::projected)
      return relative_penalty * (lame.lambda + 2. * lame.mu) / h;
    const double at_rest = lame.lambda + 2. * lame.mu;
    const double least =
      form == NitscheForm::symmetric ?
        least_penalty * at_rest +
          squeezed_penalty * std::max(0., stiffness - at_rest) :
        0.;
    return std::max(relative_penalty * E, least) / h;
  }

  template <int dim>
  NitscheForm
  BoundaryConditions<dim>::nitsche_form() const
  {
    return form;
  }

  template class BoundaryConditions<2>;
  template class BoundaryConditions<3>;
} // namespace Morula
