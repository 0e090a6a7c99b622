// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_slow_steps_h
#define morula_simulation_slow_steps_h

#include <morula/mechanics/spline_field.h>
#include <morula/particles/tissue.h>

namespace Morula
{
  // Where folds have contact a snap has to be gone through in several steps, as
  // surfaces which were far apart at t meet on the way: doc/theory.md, section
  // 4.3a. In these steps a drag holds the tissue back. It is given in units of
  // the weak drag of contact, and is 1 in all other steps.

  /** Makes the drag stronger, after a step has failed. Returns whether that is
   *  possible. */
  bool
  hold_back(double &drag);

  /** Makes the drag weaker after a step in which no cell has moved by more than
   *  a small part of the grid spacing. Collective. */
  template <int dim>
  void
  let_go(const Tissue<dim>            &tissue,
         const DisplacementField<dim> &displacement,
         double                       &drag);

  /** Whether a strand of tissue turns so far in a step, by 36°, that its
   *  surface may have passed through one which it did not face at t.
   *  Collective. */
  template <int dim>
  bool
  turns_too_far(const Tissue<dim>            &tissue,
                const DisplacementField<dim> &displacement);
} // namespace Morula

#endif
