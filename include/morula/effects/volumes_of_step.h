// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_volumes_of_step_h
#define morula_effects_volumes_of_step_h

#include <morula/effects/development.h>
#include <morula/grid/spline_space.h>
#include <morula/mechanics/material.h>
#include <morula/mechanics/material_points.h>
#include <morula/mechanics/spline_field.h>
#include <morula/particles/tissue.h>

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

  /** Classes of this rank's cells by their stiffness and relaxation, in the
   *  order of Tissue::cells(); cells of one class are alike. Empty if all cells
   *  of all ranks are. Collective. */
  template <int dim>
  std::vector<unsigned int>
  phases_of_cells(const Tissue<dim>            &tissue,
                  const DevelopmentOfStep<dim> &growth,
                  const TissueMaterial         &material);

  /** What a step makes of the volume of a cell, where volumes are pooled. */
  struct VolumeOfStep
  {
    /** J_e of its pool. */
    double J_e = 0.;
    /** What it brings into its next pool, µm^dim: doc/theory.md (2.9) without
     *  what fades. */
    double carried = 0.;
    /** J_e as laws and files read it, over J_e: doc/theory.md (2.10). */
    double smoothing = 0.;
  };

  /**
   * Volumes of this rank's cells after a step, in the order of Tissue::cells().
   * A cell that lies in several pools takes the mean over its quadrature
   * points. The list is empty if volumes are pointwise. Collective.
   * @param growth       of the step, not yet committed
   * @param kernel       value of Solver/Kernel
   * @param displacement of the step, um
   * @param known        its material points, if they are there already
   */
  template <int dim>
  std::vector<VolumeOfStep>
  volumes_of_step(const Tissue<dim>            &tissue,
                  const SplineSpace<dim>       &space,
                  const DevelopmentOfStep<dim> &growth,
                  const TissueMaterial         &material,
                  const std::string            &kernel,
                  const DisplacementField<dim> &displacement,
                  const MaterialPoints<dim>    *known = nullptr);
} // namespace Morula

#endif
