// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/mechanics/material.h>

namespace Morula
{
  MaterialParameters::MaterialParameters(const Materials &materials)
    : youngs_modulus("Material/Young's modulus",
                     "1.0",
                     "E; > 0. A number or an expression of X, Y, Z (the "
                     "cell's initial position, um), or of what the cell is. "
                     "Units: kPa.",
                     Evaluated::property)
    , poissons_ratio("Material/Poisson's ratio",
                     "0.4",
                     "nu; -1 < nu < 0.5. A number or an expression, like E.",
                     Evaluated::property)
    , energy_per("Material/Energy per",
                 "initial volume",
                 "The volume that the elastic energy is counted per: the "
                 "initial volume, halved at every division, or the volume "
                 "grown without stress.",
                 {"initial volume|grown volume"})
    , volumetric_strain(
        "Material/Volumetric strain",
        "pointwise",
        "The elastic volume change in the volumetric part of the energy (that "
        "with lambda, or kappa): each cell's own, its mean over the cells "
        "of a grid cell, or that of the sum of their volumes. Projected or "
        "pooled, tissue does not lock as Poisson's ratio approaches 0.5; "
        "choose one of them above about 0.47. Pooled, cells that grow or "
        "shrink do not press those beside them in their grid cell.",
        {"pointwise|projected|pooled"})
    , law("Material/Law",
          "neo-Hookean",
          "The elastic energy as a function of the elastic deformation: the "
          "paper's, or the one whose shear part does not depend on the volume. "
          "The same at small strains.",
          {materials.names().front()})
    , on_transition(
        "Material/On transition",
        "keep strain",
        "What a cell has of its elastic strain when it changes its "
        "type, and so perhaps its stiffness: all, so that its stress "
        "changes, or nothing, so that it is free of stress as it "
        "stands.",
        {"keep strain|forget stress"})
    , materials(materials)
  {
    // All further laws of the list, also those that a program has added, are
    // allowed words.
    const std::vector<std::string> names = materials.names();
    for (std::size_t i = 1; i < names.size(); ++i)
      law.add_word(names[i]);
    youngs_modulus.positive("kPa", "Choose a positive stiffness.");
    poissons_ratio.require([](const double nu) { return nu > -1. && nu < 0.5; },
                           "a number > -1 and < 0.5",
                           "Nearly incompressible tissue is 0.49 or 0.499.");
  }


  void
  MaterialParameters::review(Review &review) const
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
        "Set " + volumetric_strain.path() + " = projected.");
  }

  std::shared_ptr<const Material>
  MaterialParameters::chosen_material() const
  {
    const auto material = materials.find(law);
    AssertThrow(material != nullptr, ExcMessage("No material " + law));
    return material;
  }


  KeyList
  MaterialParameters::list()
  {
    return {&youngs_modulus,
            &poissons_ratio,
            &energy_per,
            &volumetric_strain,
            &law,
            &on_transition};
  }


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


  MORULA_INSTANTIATE(require_elastic);
} // namespace Morula
