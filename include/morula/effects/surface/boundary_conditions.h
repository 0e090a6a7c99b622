// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_boundary_conditions_h
#define morula_effects_surface_boundary_conditions_h

#include <morula/base/expression.h>
#include <morula/effects/surface/nitsche.h>
#include <morula/particles/boundary_state.h>

#include <deal.II/base/parameter_handler.h>

#include <optional>
#include <string>

namespace Morula
{
  using namespace dealii;

  /** Section "Boundary conditions". */
  struct BoundaryConditionParameters
  {
    std::string fixed_where     = "";
    std::string displacement    = "0; 0; 0";
    std::string slip_where      = "";
    std::string slip_normal     = "";
    std::string traction_where  = "";
    std::string traction        = "0; 0; 0";
    std::string pressure_where  = "";
    std::string pressure        = "0";
    double      nitsche_penalty = 1e3;
    std::string nitsche_form    = "symmetric";

    void
    declare(ParameterHandler &prm);
  };

  /**
   * The conditions on the surface. Where several hold at a point, fixed wins
   * over slip, and slip over loads.
   */
  template <int dim>
  class BoundaryConditions
  {
  public:
    /** @throws InputError for expressions that cannot be parsed */
    explicit BoundaryConditions(const BoundaryConditionParameters &parameters);

    /** The condition at initial position @p X with initial normal @p N. Slip
     *  points are held along their own initial normal. */
    SurfaceCondition
    condition(const Point<dim> &X, const Tensor<1, dim> &N) const;

    /** Prescribed displacement of a fixed point, µm. */
    Tensor<1, dim>
    displacement(const Point<dim> &X, const double t) const;

    /** Dead traction on a loaded point, kPa per initial area. Whether there is
     *  one was decided at @p X_seed, the initial position of the point of t = 0
     *  that this one is a part of. */
    Tensor<1, dim>
    traction(const Point<dim> &X_seed,
             const Point<dim> &X,
             const double      t) const;

    /** Following pressure on a loaded point, kPa; positive pushes inward. */
    double
    pressure(const Point<dim> &X_seed,
             const Point<dim> &X,
             const double      t) const;

    /** Whether the scene has such conditions at all. */
    bool
    has_dirichlet() const; // fixed or slip
    bool
    has_traction() const;
    bool
    has_pressure() const;

    /** Nitsche's penalty β, kPa/µm, for a point with Young's modulus @p E,
     *  Lamé constants @p lame and the @p stiffness that it has now (kPa) on a
     *  grid of spacing @p h (µm): doc/theory.md (4.6). */
    double
    penalty(const double           E,
            const Lame            &lame,
            const double           stiffness,
            const VolumetricStrain volumetric_form,
            const double           h) const;

    NitscheForm
    nitsche_form() const;

  private:
    bool
    holds(const std::optional<Expression> &where, const Point<dim> &X) const;

    std::optional<Expression> fixed_where, slip_where, traction_where,
      pressure_where;
    Expression     displacement_, traction_, pressure_;
    bool           has_slip_normal;
    Tensor<1, dim> slip_normal;
    double         relative_penalty; // β h / E
    NitscheForm    form;
  };
} // namespace Morula

#endif
