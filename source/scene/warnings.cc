// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/scene/checks.h>
#include <morula/scene/estimates.h>
#include <morula/scene/grid_warnings.h>
#include <morula/scene/warnings.h>
#include <morula/seeding/unit_warnings.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Morula
{
  namespace
  {
    /** Numbers that differ by less are equal. */
    constexpr double slack = 1e-9;

    template <int dim>
    void
    review_cell_cycle(const Scene        &scene,
                      const Preview<dim> &at,
                      Review             &review)
    {
      if (!scene.has_proliferation())
        return;
      const Expression &duration = scene.cell_cycle.duration.expression(dim);
      const Expression &where    = scene.cell_cycle.where.expression(dim);
      double            shortest = std::numeric_limits<double>::max();
      for (const Point<dim> &X : at.founders)
        if (where.value(X, 0.) > 0.)
          shortest = std::min(shortest, duration.value(X, 0.));
      shortest = Utilities::MPI::min(shortest, at.comm);
      if (at.step > (0.25 + slack) * shortest)
        review.warn(scene.time.step.path(),
                    as_text(at.step) + " day",
                    "that is " + as_text(at.step / shortest) +
                      " of the shortest cell cycle, " + as_text(shortest) +
                      " day; measured are steps of up to a quarter "
                      "(doc/accuracy-and-cost.md, advice; doc/hard-cases.md, "
                      "showcase).",
                    "Shorten the step to 0.1 or 0.2 of the cycle.");
    }

    void
    review_material(const MaterialParameters &material, Review &review)
    {
      const double nu = material.poissons_ratio;
      if (material.volumetric_form() == VolumetricStrain::pointwise &&
          nu > 0.49 - slack)
        review.warn(
          material.poissons_ratio.path(),
          as_text(nu),
          "with Volumetric strain = pointwise such tissue locks: in Cook's "
          "membrane the energy is 1 % low at 0.49, 2 % at 0.499, and the run "
          "fails at 0.4999 (doc/hard-cases.md, stiffness).",
          "Set " + material.volumetric_strain.path() + " = projected.");
    }

    template <int dim>
    void
    review_nitsche(const Scene           &scene,
                   const ConditionCounts &counts,
                   Review                &review)
    {
      const NitscheParameters      &given = scene.nitsche;
      const BoundaryConditions<dim> conditions =
        boundary_conditions_of<dim>(scene);
      const double least = NitschePenalty::least(scene.material.poissons_ratio);
      if (conditions.has_dirichlet() &&
          scene.material.volumetric_form() == VolumetricStrain::pointwise &&
          given.form == "symmetric" && review.has_set(given.penalty) &&
          given.penalty < least)
        review.warn(given.penalty.path(),
                    as_text(given.penalty) + " E/h",
                    "the symmetric form never uses less than 20 (lambda + 2 "
                    "mu)/h, here " +
                      as_text(least) +
                      " E/h, so that this value has no effect "
                      "(doc/theory.md, section 4.2).",
                    "Raise it, or set " + given.form.path() +
                      " = unsymmetric.");
      // A small penalty under pressure: tissue that grows between its clamps.
      if (counts.points > 0 && counts.fixed == counts.points &&
          given.form == "unsymmetric" && given.penalty < 100.)
        review.warn(
          given.penalty.path(),
          as_text(given.penalty) + " E/h",
          "all of the surface is fixed, and gives way where tissue is pressed "
          "against it: in a ball that grows to 1.1 in all directions the "
          "energy is 9 % low at a penalty of 20 (doc/accuracy-and-cost.md, "
          "which method).",
          "Set Method = paper and remove the keys that it stands for, or "
          "raise the penalty to 1000.");
    }

    /** Method = consistent in a file that sets, to other values, all that it
     *  stands for, as one made of the output of --parameters does. */
    void
    review_method(const Scene &scene, Review &review)
    {
      const std::string method = scene.method;
      std::string       paths;
      for (const AnyKey *key : scene.list())
        {
          const auto text = key->texts_with_methods().find(method);
          if (text == key->texts_with_methods().end())
            continue;
          if (!review.has_set(*key) ||
              same_value(scene.as_written.at(key->path()), text->second))
            return;
          paths += (paths.empty() ? "" : ", ") + key->path();
        }
      if (!paths.empty())
        review.warn(scene.method.path(),
                    method,
                    "it changes nothing, as the scene itself sets all that it "
                    "stands for: " +
                      paths + ".",
                    "Remove these keys, or this one.");
    }

    template <int dim>
    void
    review_output(const Scene         &scene,
                  const Founders<dim> &founders,
                  const MPI_Comm       comm,
                  Review              &review)
    {
      const OutputParameters &output = scene.output;
      constexpr double        hour   = 3600.;
      const double seconds = estimated_size(scene, founders, comm).seconds;
      if (output.snapshot_interval == 0. && seconds > hour)
        review.warn(output.snapshot_interval.path(),
                    "0 day",
                    "the run may take some " +
                      as_text(std::round(10. * seconds / hour) / 10.) +
                      " hours of one core (doc/performance.md, what --explain "
                      "expects), and without snapshots all is lost if it is "
                      "interrupted.",
                    "Choose an interval of some steps.");
      for (const Key<double> *interval :
           {&output.interval, &output.snapshot_interval})
        if (*interval > 0. && *interval < (1. - slack) * scene.time.step)
          review.warn(interval->path(),
                      as_text(*interval) + " day",
                      "it is shorter than " + scene.time.step.path() + " = " +
                        as_text(scene.time.step) +
                        " day, and nothing is written between the ends of "
                        "steps.",
                      "Raise it to the step, or shorten the step.");
    }
  } // namespace


  template <int dim>
  std::vector<std::string>
  scene_warnings(const Scene               &scene,
                 const Founders<dim>       &founders,
                 const SurfacePatches<dim> &surface,
                 const MPI_Comm             comm)
  {
    Review review{[&scene](const AnyKey &key) { return scene.has_set(key); }};
    for (const std::string &text : scene.renamed)
      review.warnings.push_back("Warning: " + text + '.');
    review_units(scene.tissue, founders, comm, review);
    review_grid(scene, founders, surface, comm, review);

    const Preview<dim> at = preview<dim>(
      scene, founders.positions, surface.positions, surface.normals, comm);
    const SceneEffects<dim> effects = effects_of<dim>(scene);
    if (effects.growth_law)
      effects.growth_law->review(at, review);
    review_cell_cycle(scene, at, review);
    if (effects.division_rule)
      effects.division_rule->review(at, review);
    for (const auto &fate : effects.fates)
      fate->review(at, review);
    for (const auto &[name, force] : effects.forces)
      force->review(at, review);
    review_unused(scene.tissue, review);
    review_material(scene.material, review);
    for (const auto &[name, condition] : effects.conditions)
      condition->review(at, review);
    review_nitsche<dim>(scene, check_at_surface(scene, surface, comm), review);
    review_method(scene, review);
    review_output(scene, founders, comm, review);
    return review.warnings;
  }


  template std::vector<std::string>
  scene_warnings(const Scene &,
                 const Founders<2> &,
                 const SurfacePatches<2> &,
                 const MPI_Comm);
  template std::vector<std::string>
  scene_warnings(const Scene &,
                 const Founders<3> &,
                 const SurfacePatches<3> &,
                 const MPI_Comm);
} // namespace Morula
