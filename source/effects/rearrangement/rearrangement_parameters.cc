// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/growth/relaxation.h>
#include <morula/effects/rearrangement/rearrangement.h>
#include <morula/effects/scene_keys.h>
#include <morula/effects/state/neighbour_columns.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Morula
{
  namespace
  {
    bool
    relaxes(const SceneKeys &scene)
    {
      return scene.keys<RelaxationParameters>().is_on();
    }
  } // namespace


  void
  RearrangementParameters::check(const SceneKeys &scene, Review &review) const
  {
    if (!is_on())
      return;
    if (energy == 0. && !drive.is_default())
      energy.refuse("a value > 0, as " + drive.path() + " is set",
                    "A drive is followed at the rate D f/T.");
    if (scene.volumes_differ() &&
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
    if (const auto &found_by = scene.keys<NeighbourParameters>().found_by;
        found_by != "facets")
      found_by.refuse("facets, as " + diffusion.path() + " is set",
                      "The rates of exchange follow from the facets.");
    // A cell takes part in k = 2 d D/a² exchanges per day, among equal cells
    // with the largest D that is a plain number.
    if (const auto D = diffusion.largest_number(scene.dimension); D && *D > 0.)
      if (const double a = scene.tissue.cell_spacing,
          k              = 2. * scene.dimension * *D / (a * a),
          attempts       = k * scene.time.step;
          attempts > 1.)
        {
          std::ostringstream why, remedy;
          why << "each cell tries to change its place " << attempts
              << " times in a step of " << scene.time.step
              << " day. The places themselves move between steps only.";
          remedy << "Let Time/Step be at most " << 1. / k << " day.";
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
} // namespace Morula
