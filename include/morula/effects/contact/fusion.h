// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_contact_fusion_h
#define morula_effects_contact_fusion_h

#include <morula/particles/fusion.h>

namespace Morula
{
  /** Adds @p dt (day) to the time for which boundary points have been touched
   *  without a break; those that nothing touches begin anew. */
  template <int dim>
  void
  age_contact(Tissue<dim> &tissue, const double dt);

  /**
   * What is to fuse: boundary points that have been touched for @p time (day),
   * and face such points. Of bodies that fuse all go into the one with the
   * lowest number. Collective.
   */
  template <int dim>
  Fusion
  find_fusion(const Tissue<dim> &tissue, const double time);
} // namespace Morula

#endif
