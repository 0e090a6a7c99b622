// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/mechanics/material.h>

namespace Morula
{
  MaterialParameters::MaterialParameters(const Materials &materials)
    : materials(materials)
  {
    // All laws of the list, also those that a program has added, are allowed
    // words.
    for (const std::string &name : materials.names())
      law.add_word(name);
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
