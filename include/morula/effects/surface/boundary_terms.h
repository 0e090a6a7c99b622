// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_boundary_terms_h
#define morula_effects_surface_boundary_terms_h

#include <morula/effects/development.h>
#include <morula/effects/surface/boundary_conditions.h>
#include <morula/mechanics/material.h>
#include <morula/mechanics/rigid_modes.h>
#include <morula/mechanics/spline_field.h>
#include <morula/mechanics/term.h>
#include <morula/particles/tissue.h>

#include <memory>
#include <string>
#include <tuple>
#include <vector>

namespace Morula
{
  /** F_g at t and t + dt, and λ and μ. */
  template <int dim>
  using CellState = std::tuple<Tensor<2, dim>, Tensor<2, dim>, double, double>;

  /** The held points of this rank, as far as they are the same for all forms:
   *  without their penalty. */
  template <int dim>
  struct HeldPoints
  {
    PointGroups                                   groups;
    std::vector<typename Nitsche<dim>::HeldPoint> list;
    std::vector<double>                           youngs_moduli; // kPa
    /** Empty if cells neither grow nor have a stiffness by their state. */
    std::vector<CellState<dim>> carriers;
  };

  /** Collective; @p t is the end of the step, day. */
  template <int dim>
  HeldPoints<dim>
  points_of_term(const BoundaryConditions<dim> &conditions,
                 const TissueMaterial          &material,
                 const Tissue<dim>             &tissue,
                 const SplineSpace<dim>        &space,
                 const DevelopmentOfStep<dim>  &growth,
                 const double                   t);

  /**
   * Nitsche's term for the fixed and slip points, over the step up to time
   * @p t. Collective.
   * @param kernel value of Solver/Kernel
   */
  template <int dim>
  std::unique_ptr<Term<dim>>
  nitsche_term(const BoundaryConditions<dim> &conditions,
               const TissueMaterial          &material,
               const Tissue<dim>             &tissue,
               const SplineSpace<dim>        &space,
               const DevelopmentOfStep<dim>  &growth,
               const double                   t,
               const std::string             &kernel);

  /**
   * The bounded form in an attempt at a step: its term, and the traction of
   * this rank's held points, which is zero until it begins and renewed in
   * turns: doc/theory.md (4.6a). Keeps references to all that it is given.
   * Collective.
   */
  template <int dim>
  std::unique_ptr<PartOfStep<dim>>
  held_traction(const BoundaryConditions<dim> &conditions,
                const AttemptAtStep<dim>      &attempt);

  /** The boundary points of this rank that conditions load. */
  template <int dim>
  LoadedPoints<dim>
  loaded_points(const Tissue<dim> &tissue, const SplineSpace<dim> &space);

  /** The fixed and slip points of this rank. */
  template <int dim>
  std::vector<typename RigidModes<dim>::Support>
  supports(const BoundaryConditions<dim> &conditions,
           const Tissue<dim>             &tissue,
           const SplineSpace<dim>        &space);

  /** Where the fixed and slip points of this rank are held at @p t and at
   *  @p t_next; at the start of the run (@p t = 0) nothing has moved yet, even
   *  if the prescribed displacement is not 0. */
  template <int dim>
  std::vector<HeldPoint<dim>>
  held_points(const BoundaryConditions<dim> &conditions,
              const Tissue<dim>             &tissue,
              const double                   t,
              const double                   t_next);
} // namespace Morula

#endif
