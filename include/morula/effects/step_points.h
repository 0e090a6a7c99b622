// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_step_points_h
#define morula_effects_step_points_h

#include <morula/effects/development.h>
#include <morula/grid/spline_space.h>
#include <morula/mechanics/material.h>
#include <morula/mechanics/material_points.h>
#include <morula/mechanics/spline_field.h>
#include <morula/particles/tissue.h>

#include <string>
#include <vector>

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

  /**
   * J_e of this rank's cells after a step, in the order of Tissue::cells(), if
   * the volumetric strain is averaged over grid cells: e^ϑ, doc/theory.md
   * (2.6), (2.10). A cell that lies in several grid cells takes a mean: if the
   * strain is pooled, that of e^ϑ over its parts, so that the tissue's volume
   * is that of the step; else e to the mean of ϑ. The list is empty if the
   * volumetric strain is pointwise. Collective.
   * @param growth       of the step, not yet committed
   * @param kernel       value of Solver/Kernel
   * @param displacement of the step, um
   */
  template <int dim>
  std::vector<double>
  elastic_volumes(const Tissue<dim>            &tissue,
                  const SplineSpace<dim>       &space,
                  const DevelopmentOfStep<dim> &growth,
                  const TissueMaterial         &material,
                  const std::string            &kernel,
                  const DisplacementField<dim> &displacement);
} // namespace Morula

#endif
