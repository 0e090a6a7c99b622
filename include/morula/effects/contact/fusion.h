// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_contact_fusion_h
#define morula_effects_contact_fusion_h

#include <morula/particles/tissue.h>

#include <map>

namespace Morula
{
  /** Into which body a body goes that fuses, by its number. */
  using Fusions = std::map<unsigned int, unsigned int>;

  /** Adds @p dt (day) to the time for which boundary points have been touched
   *  without a break; those that nothing touches begin anew. */
  template <int dim>
  void
  age_contact(Tissue<dim> &tissue, const double dt);

  /**
   * The bodies that are to fuse: some point of each has been touched for
   * @p time (day), and faces such a point of the other. Of bodies that fuse all
   * go into the one with the lowest number. Collective.
   */
  template <int dim>
  Fusions
  bodies_to_fuse(const Tissue<dim> &tissue, const double time);

  /** Gives cells and boundary points of bodies that fuse their new body. The
   *  surface between them is still there. Collective. */
  template <int dim>
  void
  fuse(const Fusions &fusions, Tissue<dim> &tissue);
} // namespace Morula

#endif
