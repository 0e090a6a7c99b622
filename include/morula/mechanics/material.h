// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_material_h
#define morula_mechanics_material_h

#include <morula/base/expression.h>
#include <morula/base/expression_key.h>
#include <morula/base/review.h>
#include <morula/mechanics/materials/material.h>
#include <morula/mechanics/vector_kernels.h>

#include <deal.II/base/point.h>

#include <memory>

namespace Morula
{
  /** Section "Material". */
  struct MaterialParameters : public Keys
  {
    /** @param materials what the law can be */
    explicit MaterialParameters(const Materials &materials = Materials())
      : materials(materials)
    {
      // All laws of the list, also those that a program has added, are allowed
      // words.
      for (const std::string &name : materials.names())
        law.add_word(name);
      energy_per.with("paper", "initial volume");
      volumetric_strain.with("paper", "pointwise");
    }

    ExpressionKey youngs_modulus{
      {this, "Material/Young's modulus"},
      "1.0",
      "E; > 0. A number or an expression of X, Y, Z (the "
      "cell's initial position, um), or of what the cell is. "
      "Units: kPa.",
      Evaluated::property,
      positive("kPa", "Choose a positive stiffness.")};

    ExpressionKey poissons_ratio{
      {this, "Material/Poisson's ratio"},
      "0.4",
      "nu; -1 < nu < 0.5. A number or an expression, like E.",
      Evaluated::property,
      {[](const double nu) { return nu > -1. && nu < 0.5; },
       "a number > -1 and < 0.5",
       "Nearly incompressible tissue is 0.49 or 0.499."}};

    Key<std::string> energy_per{
      {this, "Material/Energy per"},
      "grown volume",
      "Reference volume of the elastic energy. grown volume: that of the "
      "cell without stress, so that growth does not change the stiffness. "
      "initial volume: it is halved at every division.",
      {"initial volume|grown volume"}};

    Key<std::string> volumetric_strain{
      {this, "Material/Volumetric strain"},
      "pooled",
      "Volume change in the volumetric part of the elastic energy (with "
      "lambda, or kappa). pointwise: each cell's own. pooled: that of the "
      "like cells of a grid cell together, so that tissue does not lock as "
      "Poisson's ratio approaches 0.5, and cells that grow or shrink do not "
      "press others in their grid cell. projected: another word for pooled.",
      {"pointwise|projected|pooled"}};

    Key<std::string> law{
      {this, "Material/Law"},
      "neo-Hookean",
      "The elastic energy as a function of the elastic deformation: the "
      "paper's, or the one whose shear part does not depend on the volume. "
      "The same at small strains."};

    Key<std::string> on_transition{
      {this, "Material/On transition"},
      "keep strain",
      "What happens when a cell's stiffness changes. keep strain: its "
      "elastic strain stays, and its stress changes. keep stress: where it "
      "stiffens, its stress stays, as new material in loaded tissue carries "
      "no load yet. forget stress: a cell that changes its type is free of "
      "stress in its present shape.",
      {"keep strain|keep stress|forget stress"}};
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
                                                VolumetricStrain::pooled;
    }

    /** Warns of tissue that locks. */
    void
    review(Review &review) const
    {
      // 1e-9 admits the number 0.49 as users write it.
      const double largest = poissons_ratio.largest_number(3).value_or(0.);
      if (volumetric_form() == VolumetricStrain::pointwise &&
          largest > 0.49 - 1e-9)
        review.warn(
          poissons_ratio.path(),
          as_text(largest),
          "with Volumetric strain = pointwise such tissue locks: in Cook's "
          "membrane the energy is 1 % low at 0.49, 2 % at 0.499, and the run "
          "fails at 0.4999 (doc/hard-cases.md, stiffness).",
          "Set " + volumetric_strain.path() + " = pooled.");
    }

    /** The material that `Law` names. @throws InputError if there is none */
    std::shared_ptr<const Material>
    chosen_material() const
    {
      const auto material = materials.find(law);
      AssertThrow(material != nullptr, ExcMessage("No material " + law));
      return material;
    }
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
  require_elastic(const MaterialParameters &material, const Point<dim> &X)
  {
    // What depends on a cell's state or on time cannot be judged from a place:
    // those values are checked where cells are evaluated.
    for (const ExpressionKey *key :
         {&material.youngs_modulus, &material.poissons_ratio})
      if (const Expression &expression = key->expression(dim);
          !expression.depends_on_state() && !expression.depends_on_time())
        expression.value(X, 0.);
  }

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
