// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_tissue_material_h
#define morula_mechanics_tissue_material_h

#include <morula/base/expression.h>
#include <morula/mechanics/material.h>

namespace Morula
{
  /** The material of the tissue. It may depend on the initial position or on
   *  the state of cells. */
  class TissueMaterial
  {
  public:
    /** @throws InputError for an expression that cannot be parsed, or a law
     *          that does not exist */
    explicit TissueMaterial(const MaterialParameters &parameters)
      : E(parameters.youngs_modulus.expression(3))
      , nu(parameters.poissons_ratio.expression(3))
      , per_grown_volume_(parameters.per_grown_volume())
      , volumetric_form_(parameters.volumetric_form())
      , material_(parameters.chosen_material())
    {}

    /** Its law. */
    const Material &
    material() const
    {
      return *material_;
    }

    /** Whether it is the same everywhere, at any time. */
    bool
    is_uniform() const
    {
      return E.is_constant() && nu.is_constant();
    }

    /** Whether it depends on more than the initial position: then it is known
     *  only for a present cell. */
    bool
    depends_on_state() const
    {
      return E.depends_on_state() || E.depends_on_time() ||
             nu.depends_on_state() || nu.depends_on_time();
    }

    /** E, kPa. */
    const Expression &
    youngs_modulus() const
    {
      return E;
    }

    /** ν. */
    const Expression &
    poissons_ratio() const
    {
      return nu;
    }

    /** Young's modulus at the initial position @p X (µm), kPa. */
    template <int dim>
    double
    youngs_modulus(const Point<dim> &X) const
    {
      return E.value(X, 0.);
    }

    /** Lamé's constants at the initial position @p X (µm). */
    template <int dim>
    Lame
    lame_at(const Point<dim> &X) const
    {
      return lame(youngs_modulus(X), nu.value(X, 0.));
    }

    /** Whether the energy is counted per grown volume, W = V⁰ det F_g. */
    bool
    per_grown_volume() const
    {
      return per_grown_volume_;
    }

    VolumetricStrain
    volumetric_form() const
    {
      return volumetric_form_;
    }

  private:
    Expression                      E, nu;
    bool                            per_grown_volume_;
    VolumetricStrain                volumetric_form_;
    std::shared_ptr<const Material> material_;
  };
} // namespace Morula

#endif
