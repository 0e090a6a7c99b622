// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_held_motion_h
#define morula_mechanics_held_motion_h

#include <morula/mechanics/rigid_modes.h>

#include <optional>
#include <vector>

namespace Morula
{
  /** A fixed or slip point: where it is, and where it is held at the beginning
   *  of a step and at its end, µm. */
  template <int dim>
  struct HeldPoint
  {
    Point<dim>     x, from, to;
    Tensor<2, dim> projection; // onto the held directions
    double         area;       // µm^(dim-1)
    unsigned int   part = 0;   // see SplineSpace::GridCell
  };

  /**
   * Where Newton's method starts in a step that moves held points: each piece
   * of the tissue goes along with the rigid motion that its held points make on
   * average, doc/theory.md (4.14). A clamp that moves by many grid spacings, or
   * turns, then takes the tissue with it, and what is left to find is how it
   * deforms.
   *
   * A piece starts at rest if its held points rest, if their motion is mostly
   * no rigid one, or if they leave some rigid motion of the piece free.
   *
   * @return nothing if all pieces start at rest. Collective.
   */
  template <int dim>
  std::optional<Equilibrium::Vector>
  rigid_start(const SplineSpace<dim>            &space,
              const RigidModes<dim>             &modes,
              const std::vector<HeldPoint<dim>> &points,
              const MPI_Comm                     comm);
} // namespace Morula

#endif
