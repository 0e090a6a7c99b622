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
                      "E, kPa; > 0. A number or an expression of X, Y, Z (the "
                      "cell's initial position, um).");
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
  }


  bool
  MaterialParameters::per_grown_volume() const
  {
    return energy_per == "grown volume";
  }
} // namespace Morula
