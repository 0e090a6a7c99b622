// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_contact_contact_forces_h
#define morula_effects_contact_contact_forces_h

#include <morula/effects/contact/contact_points.h>
#include <morula/effects/interaction.h>

#include <vector>

namespace Morula
{
  /**
   * The forces of pairs on this rank's boundary points, also of pairs of other
   * ranks: one for each point and body that touches it, or all but does, in the
   * order of the store; p is the position there. Collective.
   * @param of_pairs on points with these numbers in @p points
   */
  template <int dim>
  std::vector<ForceBetween<dim>>
  contact_forces(const ContactPoints<dim>             &points,
                 const std::vector<ForceBetween<dim>> &of_pairs,
                 const MPI_Comm                        comm);
} // namespace Morula

#endif
