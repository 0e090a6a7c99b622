// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_contact_contact_forces_h
#define morula_effects_contact_contact_forces_h

#include <morula/effects/contact/contact_pairs.h>

#include <vector>

namespace Morula
{
  /**
   * The forces of contact on this rank's boundary points at the displacement
   * with these values at the relevant unknowns, one for each point and body
   * that touches it, or all but does, in the order of the store; p is the
   * position there. Pairs of other ranks are among them. Collective.
   */
  template <int dim>
  std::vector<ContactForce<dim>>
  contact_forces(const ContactPoints<dim>  &points,
                 const ContactPairs<dim>   &pairs,
                 const std::vector<double> &u,
                 const MPI_Comm             comm);

  /**
   * The pressure of contact at this rank's boundary points (kPa): the normal
   * force on the points of their body within half a grid spacing over the area
   * of these. The pressure of single points is no measure of accuracy, as
   * facets of two surfaces do not match. Collective.
   */
  template <int dim>
  std::vector<double>
  contact_pressures(const Tissue<dim>                    &tissue,
                    const std::vector<ContactForce<dim>> &forces);
} // namespace Morula

#endif
