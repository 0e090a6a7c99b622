// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_step_points_h
#define morula_effects_step_points_h

#include <morula/effects/development.h>
#include <morula/mechanics/material.h>
#include <morula/mechanics/material_points.h>
#include <morula/particles/tissue.h>

namespace Morula
{
  /**
   * The tissue's quadrature points for one step. A cell is one point, or
   * several points in its domain if the domain is large on the grid (see
   * ParticleDomain). All points of a cell have its F and F_g. Collective.
   */
  template <int dim>
  MaterialPoints<dim>
  material_points(const Tissue<dim>            &tissue,
                  const SplineSpace<dim>       &space,
                  const DevelopmentOfStep<dim> &growth,
                  const TissueMaterial         &material);

  /** The positions of the cells by active grid cell, in the order of
   *  Tissue::cells(). */
  template <int dim>
  GroupedPoints<dim>
  cell_positions(const Tissue<dim> &tissue, const SplineSpace<dim> &space);
} // namespace Morula

#endif
