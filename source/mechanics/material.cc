// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/material.h>

#include <deal.II/base/patterns.h>

namespace Morula
{
  void
  MaterialParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter("Young's modulus",
                      youngs_modulus,
                      "E; > 0. A number or an expression of X, Y, Z (the "
                      "cell's initial position, um). Units: kPa.");
    prm.add_parameter("Poisson's ratio",
                      poissons_ratio,
                      "nu; -1 < nu < 0.5.",
                      Patterns::Double());
    prm.add_parameter("Energy per",
                      energy_per,
                      "The volume that the elastic energy is counted per: the "
                      "initial volume, halved at every division, or the volume "
                      "grown without stress.",
                      Patterns::Selection("initial volume|grown volume"));
    prm.add_parameter(
      "Volumetric strain",
      volumetric_strain,
      "The elastic volume change in the volumetric part of the energy (that with "
      "lambda, or kappa): each cell's own, or "
      "its mean over the cells of a grid cell. Projected, tissue does not lock "
      "as Poisson's ratio approaches 0.5; choose it above about 0.47.",
      Patterns::Selection("pointwise|projected"));
    std::string names;
    for (const std::string &name : materials.names())
      names += (names.empty() ? "" : "|") + name;
    prm.add_parameter(
      "Law",
      law,
      "The elastic energy as a function of the elastic deformation: the "
      "paper's, or the one whose shear part does not depend on the volume. The "
      "same at small strains.",
      Patterns::Selection(names));
  }


  bool
  MaterialParameters::per_grown_volume() const
  {
    return energy_per == "grown volume";
  }


  VolumetricStrain
  MaterialParameters::volumetric_form() const
  {
    return volumetric_strain == "pointwise" ? VolumetricStrain::pointwise :
                                              VolumetricStrain::projected;
  }


  std::shared_ptr<const Material>
  MaterialParameters::chosen_material() const
  {
    const auto material = materials.find(law);
    AssertThrow(material != nullptr, ExcMessage("No material " + law));
    return material;
  }
} // namespace Morula
