// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/catalogue.h>
#include <morula/effects/growth/relaxation.h>
#include <morula/effects/rearrangement/rearrangement.h>
#include <morula/effects/rest_of_scene.h>
#include <morula/effects/state/neighbour_columns.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** The critical T of two types that avoid each other, over γ a^(d-1):
     *  squares in 2-D, cubes in 3-D (doc/theory.md, section 12.3). */
    double
    critical_ratio(const unsigned int dim)
    {
      return dim == 2 ? 1.1346 : 2.256;
    }

    bool
    relaxes(const RestOfScene &scene)
    {
      return scene.catalogue.keys<RelaxationParameters>().is_on();
    }
  } // namespace


  void
  RearrangementParameters::check_with(const RestOfScene &scene) const
  {
    if (!is_on())
      return;
    if (energy == 0. && !drive.is_default())
      energy.refuse("a value > 0, as " + drive.path() + " is set",
                    "A drive is followed at the rate D f/T.");
    if (scene.volumes_differ &&
        scene.material.volumetric_form() != VolumetricStrain::pooled)
      scene.material.volumetric_strain.refuse(
        "pooled, as " + diffusion.path() +
          " is set and the cells' volumes may differ",
        "A place keeps its space when another cell comes to it, so that a "
        "larger cell is squeezed there until its grid cell shares the pressure "
        "out: set it to pooled, and " +
          scene.material.energy_per.path() + " = grown volume.");
    if (scene.grid.points_per_cell > 1)
      scene.grid.points_per_cell.refuse(
        "1, as " + diffusion.path() + " is set",
        "Exchanges of places are not made for cells of several points.");
    if (const auto &found_by =
          scene.catalogue.keys<NeighbourParameters>().found_by;
        found_by != "facets")
      found_by.refuse("facets, as " + diffusion.path() + " is set",
                      "The rates of exchange follow from the facets.");
  }


  std::optional<double>
  RearrangementParameters::rate_of_exchange(const RestOfScene &scene) const
  {
    const auto D = diffusion.largest_number(scene.dim);
    if (!D || *D <= 0.)
      return {};
    const double a = scene.cell_spacing;
    return 2. * scene.dim * *D / (a * a);
  }


  void
  RearrangementParameters::review(const RestOfScene &scene,
                                  Review            &review) const
  {
    if (const auto k = rate_of_exchange(scene))
      if (const double attempts = *k * scene.step; attempts > 1.)
        {
          std::ostringstream why, remedy;
          why << "each cell tries to change its place " << attempts
              << " times in a step of " << scene.step
              << " day. The places themselves move between steps only.";
          remedy << "Let Time/Step be at most " << 1. / *k << " day.";
          review.warn(diffusion.path(),
                      diffusion.text() + " um^2/day",
                      why.str(),
                      remedy.str());
        }
    if (shear_released == 0. && !relaxes(scene))
      review.warn(shear_released.path(),
                  "0",
                  "cells pass through a solid that holds its shear for ever.",
                  "Set it to 1, or set Material/Relaxation time.");
    if (shear_released > 0. && relaxes(scene))
      review.warn(shear_released.path(),
                  shear_released.text(),
                  "the shear relaxes twice, by exchanges and by "
                  "Material/Relaxation time.",
                  "Use one of the two.");
  }


  std::string
  RearrangementParameters::further_lines(const RestOfScene &scene) const
  {
    const auto k = rate_of_exchange(scene);
    if (!k)
      return "";
    std::ostringstream out;
    out << "    about " << *k * scene.step
        << " attempts a cell and step, by the cell spacing\n";
    double largest = 0.;
    for (const auto &row : scene.catalogue.tensions().between)
      for (const double gamma : row)
        largest = std::max(largest, gamma);
    if (largest > 0.)
      out << "    fluctuation energy "
          << energy / (critical_ratio(scene.dim) * largest *
                       std::pow(scene.cell_spacing, scene.dim - 1.))
          << " of the one at which types mix; 0.4 to 0.7 sorts fastest\n";
    if (shear_released > 0.)
      out << "    shear relaxes by exchanges in " << 1. / (shear_released * *k)
          << " day\n";
    if (relaxes(scene))
      out << "    shear relaxes by Material/Relaxation time in "
          << scene.catalogue.keys<RelaxationParameters>().time.text()
          << " day\n";
    return out.str();
  }
} // namespace Morula
