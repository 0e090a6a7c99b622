// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_boundary_terms_h
#define morula_effects_surface_boundary_terms_h

#include <morula/effects/development.h>
#include <morula/effects/surface/boundary_conditions.h>
#include <morula/mechanics/material.h>
#include <morula/mechanics/material_points.h>
#include <morula/mechanics/rigid_modes.h>
#include <morula/mechanics/spline_field.h>
#include <morula/mechanics/term.h>
#include <morula/particles/tissue.h>

#include <memory>
#include <string>
#include <vector>

namespace Morula
{
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
   * Nitsche's term with a traction that is renewed in turns: doc/theory.md
   * (4.6a). Collective.
   * @param stiffnesses of the tissue around the held points, along their
   *        normals, by held_groups(), kPa: k in (4.6)
   * @param tractions M T, kPa; a reference is kept
   */
  template <int dim>
  std::unique_ptr<Term<dim>>
  bounded_nitsche_term(const BoundaryConditions<dim>     &conditions,
                       const TissueMaterial              &material,
                       const Tissue<dim>                 &tissue,
                       const SplineSpace<dim>            &space,
                       const DevelopmentOfStep<dim>      &growth,
                       const double                       t,
                       const std::vector<double>         &stiffnesses,
                       const std::vector<Tensor<1, dim>> &tractions);

  /**
   * The part of bounded_nitsche_term() in an attempt at a step: the traction
   * of this rank's held points, which is zero until it begins. Keeps references
   * to all that it is given. Collective.
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
