// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_volumes_of_step_h
#define morula_effects_volumes_of_step_h


namespace Morula
{
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
   */
  template <int dim>
  std::vector<VolumeOfStep>
  volumes_of_step(const Tissue<dim>            &tissue,
                  const SplineSpace<dim>       &space,
                  const DevelopmentOfStep<dim> &growth,
                  const TissueMaterial         &material,
                  const std::string            &kernel,
                  const DisplacementField<dim> &displacement);
} // namespace Morula

#endif
