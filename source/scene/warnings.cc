// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/method.h>
#include <morula/scene/checks.h>
#include <morula/scene/estimates.h>
#include <morula/scene/grid_warnings.h>
#include <morula/scene/refusals.h>
#include <morula/scene/unit_warnings.h>
#include <morula/scene/warnings.h>

#include <deal.II/base/mpi.h>

#include <boost/algorithm/string/join.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Morula
{
  using Refusals::as_text;

  namespace
  {
    /** Numbers that differ by less are equal. */
    constexpr double slack = 1e-9;

    using Warnings = std::vector<std::string>;

    /** @p why is a sentence that says where it was measured. */
    void
    add(Warnings          &warnings,
        const std::string &key,
        const std::string &value,
        const std::string &why,
        const std::string &remedy)
    {
      warnings.push_back(warning(key, value, why, remedy));
    }

    /**
     * Largest growth of theta in one step of any cell, as a ratio. Where there
     * are many cells and steps, only some cells are asked.
     */
    template <int dim>
    double
    largest_growth(const Scene &scene, const std::vector<Point<dim>> &founders)
    {
      constexpr double most_evaluations = 2e5;
      const double     n_steps =
        std::ceil(scene.time.end_time / scene.time.step * (1. - slack));
      const std::string key = "Growth/Isotropic/Stretch";
      if (!Expression(key, scene.isotropic_growth.stretch).depends_on_time() ||
          n_steps > most_evaluations)
        return 1.;
      const IsotropicGrowth<dim> growth(scene.isotropic_growth);
      const std::size_t          every = std::max<std::size_t>(
        1, std::ceil(n_steps * founders.size() / most_evaluations));
      double largest = 1.;
      for (std::size_t i = 0; i < founders.size(); i += every)
        {
          double before = growth.stretch(founders[i], 0.);
          for (double n = 1.; n <= n_steps; ++n)
            {
              const double t =
                std::min(n * scene.time.step, scene.time.end_time);
              const double now = growth.stretch(founders[i], t);
              largest = std::max({largest, now / before, before / now});
              before  = now;
            }
        }
      return largest;
    }

    template <int dim>
    void
    warn_of_steps(const Scene                   &scene,
                  const std::vector<Point<dim>> &founders,
                  const MPI_Comm                 comm,
                  Warnings                      &warnings)
    {
      const std::string step = as_text(scene.time.step) + " day";
      if (scene.has_growth())
        {
          // An expression may have no value at some time in mid-run; then the
          // run says so when it gets there.
          double ratio = 1.;
          try
            {
              ratio = largest_growth(scene, founders);
            }
          catch (const std::exception &)
            {}
          ratio = Utilities::MPI::max(ratio, comm);
          const bool is_clamped =
            !scene.boundary_conditions.fixed_where.empty();
          if (ratio > (is_clamped ? 1.2 : 1.4) + slack)
            add(warnings,
                "Time/Step",
                step,
                "in one step cells grow (or wither) by a factor of up to " +
                  as_text(ratio) +
                  "; measured are steps of up to 1.2 beside a clamp, where one "
                  "of 1.1 is enough, and of 1.4 elsewhere "
                  "(doc/accuracy-and-cost.md, advice).",
                "Shorten the step, unless you have compared with shorter "
                "ones.");
        }
      if (scene.has_proliferation())
        {
          const Expression duration("Proliferation/Cell cycle/Duration",
                                    scene.cell_cycle.duration);
          const Expression where("Proliferation/Cell cycle/Where",
                                 scene.cell_cycle.where);
          double           shortest = std::numeric_limits<double>::max();
          for (const Point<dim> &X : founders)
            if (where.value(X, 0.) > 0.)
              shortest = std::min(shortest, duration.value(X, 0.));
          shortest = Utilities::MPI::min(shortest, comm);
          if (scene.time.step > (0.25 + slack) * shortest)
            add(warnings,
                "Time/Step",
                step,
                "that is " + as_text(scene.time.step / shortest) +
                  " of the shortest cell cycle, " + as_text(shortest) +
                  " day; measured are steps of up to a quarter "
                  "(doc/accuracy-and-cost.md, advice; doc/hard-cases.md, "
                  "showcase).",
                "Shorten the step to 0.1 or 0.2 of the cycle.");
        }
    }

    void
    warn_of_material(const Scene &scene, Warnings &warnings)
    {
      const double nu = scene.material.poissons_ratio;
      const bool   pointwise =
        scene.material.volumetric_form() == VolumetricStrain::pointwise;
      if (pointwise && nu > 0.49 - slack)
        add(warnings,
            "Material/Poisson's ratio",
            as_text(nu),
            "with Volumetric strain = pointwise such tissue locks: in Cook's "
            "membrane the energy is 1 % low at 0.49, 2 % at 0.499, and the run "
            "fails at 0.4999 (doc/hard-cases.md, stiffness).",
            "Set Material/Volumetric strain = projected.");

      const BoundaryConditionParameters &given = scene.boundary_conditions;
      const bool                         is_held =
        !given.fixed_where.empty() || !given.slip_where.empty();
      const double floor = 20. * (1. - nu) / ((1. + nu) * (1. - 2. * nu));
      if (is_held && pointwise && given.nitsche_form == "symmetric" &&
          scene.as_written.count("Boundary conditions/Nitsche penalty") > 0 &&
          given.nitsche_penalty < floor)
        add(warnings,
            "Boundary conditions/Nitsche penalty",
            as_text(given.nitsche_penalty) + " E/h",
            "the symmetric form never uses less than 20 (lambda + 2 mu)/h, "
            "here " +
              as_text(floor) +
              " E/h, so that this value has no effect "
              "(doc/theory.md, section 4.2).",
            "Raise it, or set Boundary conditions/Nitsche form = "
            "unsymmetric.");
    }

    /** A small penalty under pressure: tissue that grows between its clamps. */
    template <int dim>
    void
    warn_of_yielding(const Scene               &scene,
                     const SurfacePatches<dim> &surface,
                     const MPI_Comm             comm,
                     Warnings                  &warnings)
    {
      const BoundaryConditionParameters &given = scene.boundary_conditions;
      if (given.fixed_where.empty() || given.nitsche_form != "unsymmetric" ||
          given.nitsche_penalty >= 100.)
        return;
      const ConditionCounts counts = check_at_surface(scene, surface, comm);
      if (counts.fixed == counts.points)
        add(
          warnings,
          "Boundary conditions/Nitsche penalty",
          as_text(given.nitsche_penalty) + " E/h",
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
    warn_of_method(const Scene &scene, Warnings &warnings)
    {
      const auto  values = Method::values(scene.method);
      std::string paths;
      for (const auto &[path, value] : values)
        {
          const auto written = scene.as_written.find(path);
          if (written == scene.as_written.end() ||
              Refusals::same_value(written->second, value))
            return;
          paths += (paths.empty() ? "" : ", ") + path;
        }
      if (!values.empty())
        add(warnings,
            "Method",
            scene.method,
            "it changes nothing, as the scene itself sets all that it stands "
            "for: " +
              paths + ".",
            "Remove these keys, or this one.");
    }

    /** Keys of Tissue that the chosen shape does not use. Those that name files
     *  are refused; these are not, so that one scene serves several shapes. */
    void
    warn_of_unused(const Scene &scene, Warnings &warnings)
    {
      const TissueParameters &given = scene.tissue;
      const TissueParameters  defaults;
      const auto              warn = [&](const std::string              &key,
                            const auto                     &value,
                            const auto                     &default_value,
                            const std::vector<std::string> &shapes) {
        const std::string path = "Tissue/" + key;
        if (value != default_value && scene.as_written.count(path) > 0 &&
            std::count(shapes.begin(), shapes.end(), given.shape) == 0)
          add(warnings,
              path,
              scene.as_written.at(path),
              "it has no effect on Tissue/Shape = " + given.shape + ".",
              "Remove it, or choose one of the shapes " +
                boost::join(shapes, ", ") + ".");
      };
      warn("Radius", given.radius, defaults.radius, {"sphere", "cylinder"});
      warn("Size", given.size, defaults.size, {"box", "ellipsoid", "cylinder"});
      const std::vector<std::string> solid = {
        "sphere", "box", "ellipsoid", "cylinder", "mesh"};
      warn("Center", given.center, defaults.center, solid);
      warn("Lattice offset",
           given.lattice_offset,
           defaults.lattice_offset,
           solid);
      warn("Surface cells", given.surface_cells, defaults.surface_cells, solid);
    }

    template <int dim>
    void
    warn_of_output(const Scene         &scene,
                   const Founders<dim> &founders,
                   const MPI_Comm       comm,
                   Warnings            &warnings)
    {
      constexpr double hour    = 3600.;
      const double     seconds = estimated_size(scene, founders, comm).seconds;
      if (scene.output.snapshot_interval == 0. && seconds > hour)
        add(warnings,
            "Output/Snapshot interval",
            "0 day",
            "the run may take some " +
              as_text(std::round(10. * seconds / hour) / 10.) +
              " hours of one core (doc/performance.md, what --explain "
              "expects), and without snapshots all is lost if it is "
              "interrupted.",
            "Choose an interval of some steps.");
      for (const auto &[key, interval] :
           {std::pair("Output/Interval", scene.output.interval),
            std::pair("Output/Snapshot interval",
                      scene.output.snapshot_interval)})
        if (interval > 0. && interval < (1. - slack) * scene.time.step)
          add(warnings,
              key,
              as_text(interval) + " day",
              "it is shorter than Time/Step = " + as_text(scene.time.step) +
                " day, and nothing is written between the ends of steps.",
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
    Warnings warnings;
    for (const std::string &text : scene.renamed)
      warnings.push_back("Warning: " + text + '.');
    for (const Warnings &more : {unit_warnings(scene, founders, comm),
                                 grid_warnings(scene, founders, surface, comm)})
      warnings.insert(warnings.end(), more.begin(), more.end());
    warn_of_steps(scene, founders.positions, comm, warnings);
    warn_of_unused(scene, warnings);
    warn_of_material(scene, warnings);
    warn_of_yielding(scene, surface, comm, warnings);
    warn_of_method(scene, warnings);
    warn_of_output(scene, founders, comm, warnings);
    return warnings;
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
