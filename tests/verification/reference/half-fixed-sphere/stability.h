// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef half_fixed_sphere_stability_h
#define half_fixed_sphere_stability_h

#include <half-fixed-sphere/equilibrium.h>

namespace HalfFixedSphere
{
  /**
   * Whether the axisymmetric body is stable against displacements that vary
   * around the axis, a cos(m phi) e_r + b sin(m phi) e_phi + c cos(m phi) e_z:
   * the smallest eigenvalue of the second variation of its energy relative to
   * that of the body before growth. 1 before growth, below 0 if the body
   * wrinkles or creases.
   */
  double
  smallest_eigenvalue(const Equilibrium &body, const unsigned int m);
} // namespace HalfFixedSphere

#endif
