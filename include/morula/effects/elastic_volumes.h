// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_elastic_volumes_h
#define morula_effects_elastic_volumes_h

#include <morula/effects/development.h>
#include <morula/grid/spline_space.h>
#include <morula/mechanics/material.h>
#include <morula/mechanics/spline_field.h>
#include <morula/particles/tissue.h>

#include <string>
#include <vector>

namespace Morula
{
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
