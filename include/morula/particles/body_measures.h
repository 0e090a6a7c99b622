// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_body_measures_h
#define morula_particles_body_measures_h

namespace Morula
{
  /** How far two cells of one body stand apart at most, in units of their mean
   *  length V^(1/dim). Diagonal neighbours on a cubic lattice are at 1.73. */
  constexpr double widest_bond = 1.8;

  /** What a body is at t = 0. */
  struct BodyMeasures
  {
    double cells = 0.; // their number
    /** Of its cells, µm^dim. */
    double volume = 0.;
    /** Of its patches, µm^(dim-1). */
    double area = 0.;
    /** |Σ a n| of its patches: 0 if its surface is closed, µm^(dim-1). */
    double opening = 0.;

    /** The thickness of a sheet with this volume and area, µm. */
    double
    thickness() const
    {
      return area > 0. ? 2. * volume / area : 0.;
    }
  };
} // namespace Morula

#endif
