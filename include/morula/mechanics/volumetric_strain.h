// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_volumetric_strain_h
#define morula_mechanics_volumetric_strain_h

// Included by files that are compiled for one instruction set: no functions
// that the linker could merge with those of other files.

namespace Morula
{
  /** The form of ln J_e in the volumetric part of the energy (doc/theory.md,
   *  section 2). */
  enum class VolumetricStrain
  {
    /** ln J_e of the point itself. */
    pointwise,
    /** Its mean over the points of the grid cell. */
    projected,
    /** The logarithm of the sum of the volumes of the grid cell's points over
     *  the sum of their grown volumes. */
    pooled
  };

  /** What the tangent at points needs of the volume of their grid cell:
   *  doc/theory.md (2.7), (2.9). */
  struct StrainOfGridCell
  {
    /** The form, which is any but pointwise: that needs no mean. */
    VolumetricStrain form;
    /** Pooled: whether the grid cell is under pressure, VolumeMean. */
    bool pressed;
    /** ϑ. */
    double theta;
    /** Pooled: Λ U'(ϑ) over the sum of the weights w, kPa. */
    double mean_stress;
  };
} // namespace Morula

#endif
