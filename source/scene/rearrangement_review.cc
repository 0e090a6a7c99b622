// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/growth/relaxation.h>
#include <morula/effects/rearrangement/rearrangement.h>
#include <morula/effects/state/neighbour_columns.h>
#include <morula/scene/rearrangement_review.h>
#include <morula/scene/tensions.h>

#include <algorithm>
#include <cmath>
#include <optional>
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

    /** How often a cell takes part in an exchange per day, k = 2 d D/a², among
     *  equal cells with the largest D that is a plain number. */
    std::optional<double>
    rate_of_exchange(const Scene &scene)
    {
      const auto D =
        scene.keys<RearrangementParameters>().diffusion.largest_number(
          scene.dimension);
      if (!D || *D <= 0.)
        return {};
      const double a = scene.tissue.cell_spacing;
      return 2. * scene.dimension * *D / (a * a);
    }

    /** Whether cells may have grown, or been born, to different volumes. */
    bool
    volumes_differ(const Scene &scene)
    {
      return scene.has_active_tissue() ||
             Scene::has_any(scene.catalogue.fates) ||
             scene.tissue.is_points() ||
             scene.tissue.surface_cells == "trimmed";
    }

    bool
    relaxes(const Scene &scene)
    {
      return scene.keys<RelaxationParameters>().is_on();
    }
  } // namespace


  void
  check_rearrangement(const Scene &scene)
  {
    const auto &keys = scene.keys<RearrangementParameters>();
    if (!keys.is_on())
      return;
    if (volumes_differ(scene) &&
        scene.material.volumetric_form() != VolumetricStrain::pooled)
      scene.material.volumetric_strain.refuse(
        "pooled, as " + keys.diffusion.path() +
          " is set and the cells' volumes may differ",
        "A place keeps its space when another cell comes to it, so that a "
        "larger cell is squeezed there until its grid cell shares the pressure "
        "out: set it to pooled, and " +
          scene.material.energy_per.path() + " = grown volume.");
    if (scene.grid.points_per_cell > 1)
      scene.grid.points_per_cell.refuse(
        "1, as " + keys.diffusion.path() + " is set",
        "Exchanges of places are not made for cells of several points.");
    if (const auto &found_by = scene.keys<NeighbourParameters>().found_by;
        found_by != "facets")
      found_by.refuse("facets, as " + keys.diffusion.path() + " is set",
                      "The rates of exchange follow from the facets.");
  }


  void
  review_rearrangement(const Scene &scene, Review &review)
  {
    const auto &keys = scene.keys<RearrangementParameters>();
    if (!keys.is_on())
      return;
    if (const auto k = rate_of_exchange(scene))
      if (const double attempts = *k * scene.time.step; attempts > 1.)
        {
          std::ostringstream why, remedy;
          why << "each cell tries to change its place " << attempts
              << " times in a step of " << scene.time.step
              << " day. The places themselves move between steps only.";
          remedy << "Let Time/Step be at most " << 1. / *k << " day.";
          review.warn(keys.diffusion.path(),
                      keys.diffusion.text() + " um^2/day",
                      why.str(),
                      remedy.str());
        }
    if (keys.shear_released == 0. && !relaxes(scene))
      review.warn(keys.shear_released.path(),
                  "0",
                  "cells pass through a solid that holds its shear for ever.",
                  "Set it to 1, or set Material/Relaxation time.");
    if (keys.shear_released > 0. && relaxes(scene))
      review.warn(keys.shear_released.path(),
                  keys.shear_released.text(),
                  "the shear relaxes twice, by exchanges and by "
                  "Material/Relaxation time.",
                  "Use one of the two.");
  }


  std::string
  rearrangement_lines(const Scene &scene)
  {
    const auto &keys = scene.keys<RearrangementParameters>();
    const auto  k    = rate_of_exchange(scene);
    if (!keys.is_on() || !k)
      return "";
    std::ostringstream out;
    out << "    about " << *k * scene.time.step
        << " attempts a cell and step, by the cell spacing\n";
    double largest = 0.;
    for (const auto &row : tensions_of(scene).between)
      for (const double gamma : row)
        largest = std::max(largest, gamma);
    if (largest > 0.)
      out << "    fluctuation energy "
          << keys.energy /
               (critical_ratio(scene.dimension) * largest *
                std::pow(scene.tissue.cell_spacing, scene.dimension - 1.))
          << " of the one at which types mix; 0.4 to 0.7 sorts fastest\n";
    if (keys.shear_released > 0.)
      out << "    shear relaxes by exchanges in "
          << 1. / (keys.shear_released * *k) << " day\n";
    if (relaxes(scene))
      out << "    shear relaxes by Material/Relaxation time in "
          << scene.keys<RelaxationParameters>().time.text() << " day\n";
    return out.str();
  }
} // namespace Morula
