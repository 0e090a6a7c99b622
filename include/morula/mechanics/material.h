// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_material_h
#define morula_mechanics_material_h

#include <morula/mechanics/materials/materials.h>

#include <deal.II/base/parameter_handler.h>

#include <memory>
#include <string>

namespace Morula
{
  using namespace dealii;

  /** What stands for ln J_e in the volumetric part of the energy
   *  (doc/theory.md, section 2). */
  enum class VolumetricStrain
  {
    /** ln J_e of the point itself. */
    pointwise,
    /** Its mean over the points of the grid cell. */
    projected
  };

  /** Section "Material". */
  struct MaterialParameters
  {
    std::string youngs_modulus    = "1.0";
    double      poissons_ratio    = 0.4;
    std::string energy_per        = "initial volume";
    std::string volumetric_strain = "pointwise";
    std::string law               = "neo-Hookean";
    /** What the law can be. */
    Materials materials;

    void
    declare(ParameterHandler &prm);

    /** Whether the energy is counted per grown volume, W = V⁰ det F_g. */
    bool
    per_grown_volume() const;

    VolumetricStrain
    volumetric_form() const;

    /** The one that the law names. @throws InputError if there is none */
    std::shared_ptr<const Material>
    chosen_material() const;
  };

  /** Lamé's constants, kPa. */
  struct Lame
  {
    double lambda;
    double mu;
  };

  /** From Young's modulus (kPa) and Poisson's ratio. */
  inline Lame
  lame(const double E, const double nu)
  {
    return {E * nu / ((1. + nu) * (1. - 2. * nu)), E / (2. * (1. + nu))};
  }
} // namespace Morula

#endif
