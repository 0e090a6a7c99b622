// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/step_effect.h>

// An effect of whole steps that overrides one of these moments leaves the
// others empty.
namespace Morula
{
  template <int dim>
  void
  StepEffect<dim>::start(const Tissue<dim> &, const MomentOfRun<dim> &) const
  {}


  template class StepEffect<2>;
  template class StepEffect<3>;
} // namespace Morula
