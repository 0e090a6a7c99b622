// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_step_supports_h
#define morula_simulation_step_supports_h

#include <morula/mechanics/rigid_modes.h>
#include <morula/scene/tissue_model.h>

#include <vector>

namespace Morula
{
  /**
   * What holds the pieces of this rank in a step from @p t to @p t_next (day):
   * fixed and slip points, and cells with friction that is not too weak to
   * decide where a free piece goes. Not collective.
   * @throws InputError if an expression has no value
   */
  template <int dim>
  std::vector<typename RigidModes<dim>::Support>
  step_supports(const TissueModel<dim> &model,
                const Tissue<dim>      &tissue,
                const SplineSpace<dim> &space,
                const double            t,
                const double            t_next);
} // namespace Morula

#endif
