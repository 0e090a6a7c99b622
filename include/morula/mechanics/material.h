// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_material_h
#define morula_mechanics_material_h

#include <morula/base/expression_key.h>
#include <morula/base/review.h>
#include <morula/mechanics/materials/materials.h>
#include <morula/mechanics/volumetric_strain.h>

#include <deal.II/base/point.h>

#include <memory>

namespace Morula
{
  /** Section "Material". */
  struct MaterialParameters : public Keys
  {
    /** @param materials what the law can be */
    explicit MaterialParameters(const Materials &materials = Materials());

    ExpressionKey    youngs_modulus; // kPa
    ExpressionKey    poissons_ratio;
    Key<std::string> energy_per;
    Key<std::string> volumetric_strain;
    Key<std::string> law;
    Key<std::string> on_transition;
    /** What the law can be. */
    Materials materials;

    /** Whether the energy is counted per grown volume, W = V⁰ det F_g. */
    bool
    per_grown_volume() const
    {
      return energy_per == "grown volume";
    }

    VolumetricStrain
    volumetric_form() const
    {
      return volumetric_strain == "pointwise" ? VolumetricStrain::pointwise :
             volumetric_strain == "projected" ? VolumetricStrain::projected :
                                                VolumetricStrain::pooled;
    }

    /** Whether cells forget their stress when they change their type. */
    bool
    forgets_stress() const
    {
      return on_transition == "forget stress";
    }

    /** Warns of tissue that locks. */
    void
    review(Review &review) const;

    /** The material that `Law` names. @throws InputError if there is none */
    std::shared_ptr<const Material>
    chosen_material() const;

    using Keys::list;
    KeyList
    list() override;
  };

  /** Lamé's constants, kPa. */
  struct Lame
  {
    double lambda;
    double mu;
  };

  /** Lamé's constants from Young's modulus (kPa) and Poisson's ratio. */
  inline Lame
  lame(const double E, const double nu)
  {
    return {E * nu / ((1. + nu) * (1. - 2. * nu)), E / (2. * (1. + nu))};
  }

  /** Young's modulus, kPa. */
  inline double
  youngs_modulus(const Lame &lame)
  {
    return lame.mu * (3. * lame.lambda + 2. * lame.mu) /
           (lame.lambda + lame.mu);
  }

  /** Refuses a Young's modulus that is not positive at @p X, initial position
   *  in µm, at t = 0, or a Poisson's ratio out of range, if they depend on the
   *  place alone. @throws InputError */
  template <int dim>
  void
  require_elastic(const MaterialParameters &material, const Point<dim> &X);
} // namespace Morula

#endif
