// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/mechanics/materials/material.h>
#include <morula/scene/effects_check.h>
#include <morula/scene/limits.h>
#include <morula/scene/refusals.h>
#include <morula/scene/scene.h>

#include <deal.II/base/patterns.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace Morula
{
  using namespace Refusals;

  namespace
  {
    /** Steps are counted by integers. */
    constexpr double max_steps = 1e9;

    void
    refuse_far_away(const std::string         &key,
                    const std::vector<double> &place,
                    const double               h)
    {
      for (const double x : place)
        if (!(std::abs(x) <= farthest_place * h))
          throw InputError(key,
                           Patterns::Tools::to_string(place),
                           "at most " + as_text(farthest_place) +
                             " grid spacings from the origin, " +
                             as_text(farthest_place * h) + " um",
                           "Move the scene nearer to the origin.");
    }

    void
    check_time(const TimeParameters &time)
    {
      refuse_unless(time.end_time > 0.,
                    "Time/End time",
                    time.end_time,
                    "a number of days > 0",
                    "Choose a later end.");
      refuse_unless(time.step > 0.,
                    "Time/Step",
                    time.step,
                    "a number of days > 0",
                    "Choose a positive step.");
      refuse_unless(time.end_time <= max_steps * time.step,
                    "Time/Step",
                    time.step,
                    "at least Time/End time = " + as_text(time.end_time) +
                      " day / " + as_text(max_steps),
                    "Raise it, or choose an earlier end.");
      refuse_unless(time.smallest_step > 0. && time.smallest_step <= time.step,
                    "Time/Smallest step",
                    time.smallest_step,
                    "a number of days > 0 and <= Time/Step = " +
                      as_text(time.step) + " day",
                    "Lower it, or raise Time/Step.");
    }

    void
    check_grid(const GridParameters &grid, const unsigned int dim)
    {
      refuse_unless(grid.spacing > 0.,
                    "Grid/Spacing",
                    grid.spacing,
                    "a length in um > 0",
                    "Choose some cell spacings, e.g. 3 to 5.");
      refuse_unless(grid.occupation_parameter > 0. &&
                      grid.occupation_parameter <= 1.,
                    "Grid/Occupation parameter",
                    grid.occupation_parameter,
                    "a share > 0 and <= 1",
                    "0.85 is a good choice.");
      refuse_far_away("Grid/Offset", grid.offset, grid.spacing);
      if (grid.offset.size() < dim)
        throw InputError("Grid/Offset",
                         Patterns::Tools::to_string(grid.offset),
                         std::to_string(dim) + " numbers in um",
                         "Write one for each direction.");
    }

    void
    check_material(const MaterialParameters &material, const unsigned int dim)
    {
      refuse_constant_unless(Sign::positive,
                             "kPa",
                             in_space_only("Material/Young's modulus",
                                           material.youngs_modulus,
                                           dim),
                             "Choose a positive stiffness.");
      refuse_unless(material.poissons_ratio > -1. &&
                      material.poissons_ratio < 0.5,
                    "Material/Poisson's ratio",
                    material.poissons_ratio,
                    "a number > -1 and < 0.5",
                    "Nearly incompressible tissue is 0.49 or 0.499.");
    }

    void
    check_output(const Scene &scene)
    {
      const auto       &formats = scene.output.formats;
      const std::string value   = Patterns::Tools::to_string(formats);
      const bool none = std::count(formats.begin(), formats.end(), "none") > 0;
      if (formats.empty() || (none && formats.size() > 1))
        throw InputError("Output/Formats",
                         value,
                         "any of vtu, csv, or none alone",
                         "Remove 'none' or the others.");
      if (std::set<std::string>(formats.begin(), formats.end()).size() <
          formats.size())
        throw InputError("Output/Formats",
                         value,
                         "each format once",
                         "Remove what is written twice.");
    }

    void
    check_solver(const SolverParameters   &solver,
                 const MaterialParameters &material)
    {
      refuse_unless(solver.newton_tolerance > 0. &&
                      solver.newton_tolerance < 1.,
                    "Solver/Newton tolerance",
                    solver.newton_tolerance,
                    "a number > 0 and < 1",
                    "1e-6 is a good choice.");
      refuse_unless(solver.linear_tolerance < 1.,
                    "Solver/Linear tolerance",
                    solver.linear_tolerance,
                    "0, or a number between 0 and 1",
                    "0 lets Newton's method choose.");
      std::string runnable = "automatic, plain";
      bool known = solver.kernel == "automatic" || solver.kernel == "plain";
      for (const auto &kernels :
           material.chosen_material()->vector_kernels<3>())
        {
          runnable += std::string(", ") + kernels.name;
          known = known || solver.kernel == kernels.name;
        }
      if (!known)
        throw InputError("Solver/Kernel",
                         solver.kernel,
                         "on this processor one of " + runnable,
                         "'automatic' takes the fastest.");
    }

    template <int dim>
    void
    check_scene(const Scene &scene)
    {
      check_time(scene.time);
      check_grid(scene.grid, dim);
      check_lengths(scene); // first: the next looks through all places of cells
      scene.tissue.check(dim);
      refuse_far_away("Tissue/Center", scene.tissue.center, scene.grid.spacing);
      check_material(scene.material, dim);
      check_effects<dim>(scene);
      check_solver(scene.solver, scene.material);
      check_output(scene);
    }
  } // namespace


  void
  Scene::check() const
  {
    if (dimension == 2)
      check_scene<2>(*this);
    else if (dimension == 3)
      check_scene<3>(*this);
    else
      throw InputError("Dimension",
                       std::to_string(dimension),
                       "2 or 3",
                       "Choose one of them.");
  }
} // namespace Morula
