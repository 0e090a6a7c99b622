// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_boundary_terms_h
#define morula_effects_boundary_terms_h

#include <morula/effects/boundary_conditions.h>
#include <morula/effects/growth/cell_growth.h>
#include <morula/mechanics/material_points.h>
#include <morula/mechanics/rigid_modes.h>
#include <morula/mechanics/term.h>
#include <morula/particles/tissue.h>

#include <memory>
#include <vector>

namespace Morula
{
  /** What the boundary terms need to know of the material. */
  struct BoundaryMaterial
  {
    Expression youngs_modulus; // kPa, of the initial position
    double     poissons_ratio;
    bool       per_grown_volume;
  };

  /**
   * The boundary terms of one step up to time @p t: Nitsche's for fixed and
   * slip points, dead traction, following pressure; only those that the scene
   * calls for. Collective.
   */
  template <int dim>
  void
  add_boundary_terms(const BoundaryConditions<dim>           &conditions,
                     const BoundaryMaterial                  &material,
                     const Tissue<dim>                       &tissue,
                     const SplineSpace<dim>                  &space,
                     const GrowthOfStep<dim>                 &growth,
                     const double                             t,
                     std::vector<std::unique_ptr<Term<dim>>> &terms);

  /** The fixed and slip points of this rank. */
  template <int dim>
  std::vector<typename RigidModes<dim>::Support>
  supports(const BoundaryConditions<dim> &conditions,
           const Tissue<dim>             &tissue,
           const SplineSpace<dim>        &space);
} // namespace Morula

#endif
