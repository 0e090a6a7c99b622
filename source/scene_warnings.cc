// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/scene_refusals.h>
#include <morula/scene_size.h>
#include <morula/scene_warnings.h>

#include <deal.II/base/mpi.h>

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
      warnings.push_back("Warning: " + key + " = '" + value + "': " + why +
                         ' ' + remedy);
    }

    /** Mean length of a cell, µm. */
    template <int dim>
    double
    cell_length(const Founders<dim> &founders, const MPI_Comm comm)
    {
      double volume = 0.;
      for (const double V : founders.volumes)
        volume += V;
      return std::pow(Utilities::MPI::sum(volume, comm) / founders.n_global,
                      1. / dim);
    }

    /** Mean length of a surface patch, µm; 0 without a surface. */
    template <int dim>
    double
    patch_length(const SurfacePatches<dim> &surface, const MPI_Comm comm)
    {
      double area = 0.;
      for (const double A : surface.areas)
        area += A;
      area = Utilities::MPI::sum(area, comm);
      return surface.n_global == 0 ?
               0. :
               std::pow(area / surface.n_global, 1. / (dim - 1));
    }

    /** Smallest extent of the tissue along an axis, µm. */
    template <int dim>
    double
    smallest_extent(const Scene               &scene,
                    const Founders<dim>       &founders,
                    const SurfacePatches<dim> &surface,
                    const MPI_Comm             comm)
    {
      const TissueParameters &tissue = scene.tissue;
      double smallest                = std::numeric_limits<double>::infinity();
      if (tissue.shape == "sphere" || tissue.shape == "cylinder")
        smallest = 2. * tissue.radius;
      if (tissue.shape == "cylinder")
        return std::min(smallest, tissue.size[2]);
      if (tissue.shape == "sphere")
        return smallest;
      if (tissue.shape == "box" || tissue.shape == "ellipsoid")
        return *std::min_element(tissue.size.begin(),
                                 tissue.size.begin() + dim);

      // from a file: as far as its points reach
      const bool  has_surface = surface.n_global > 0;
      const auto &points = has_surface ? surface.positions : founders.positions;
      for (unsigned int d = 0; d < dim; ++d)
        {
          double lower = std::numeric_limits<double>::max(), upper = -lower;
          for (const Point<dim> &X : points)
            {
              lower = std::min(lower, X[d]);
              upper = std::max(upper, X[d]);
            }
          smallest = std::min(smallest,
                              Utilities::MPI::max(upper, comm) -
                                Utilities::MPI::min(lower, comm));
        }
      return smallest + (has_surface ? 0. : cell_length(founders, comm));
    }

    template <int dim>
    void
    warn_of_grid(const Scene               &scene,
                 const Founders<dim>       &founders,
                 const SurfacePatches<dim> &surface,
                 const MPI_Comm             comm,
                 Warnings                  &warnings)
    {
      const double      h     = scene.grid.spacing;
      const double      L     = cell_length(founders, comm);
      const std::string value = as_text(h) + " um";
      if (h < (3. - slack) * L)
        add(warnings,
            "Grid/Spacing",
            value,
            "that is " + as_text(h / L) + " cells of " + as_text(L) + " um; " +
              (h < (2. - slack) * L ?
                 "below 2 energies are wrong by up to 10 %, and compressed "
                 "tissue goes unstable (doc/hard-cases.md, classification)." :
                 "fewer than 3 roughen the surface and spoil the energy, and "
                 "one run in eight of proliferating tissue has failed "
                 "(doc/accuracy-and-cost.md, advice)."),
            "Choose 4 to 7 cells per grid spacing: raise Grid/Spacing, or "
            "lower Tissue/Cell spacing.");

      const double thickness = smallest_extent(scene, founders, surface, comm);
      if (thickness < (1. - slack) * h)
        add(warnings,
            "Grid/Spacing",
            value,
            "the tissue is only " + as_text(thickness) +
              " um wide, less than a grid cell: one quadratic field goes "
              "through its thickness, and details within it are lost "
              "(doc/hard-cases.md, small_and_thin).",
            "Lower Grid/Spacing to half the thickness if they matter, with "
            "Tissue/Cell spacing at most a third of that.");

      // fixed points keep their distances
      const bool   slips = !scene.boundary_conditions.slip_where.empty();
      const double patch = patch_length(surface, comm);
      if (slips && (scene.has_growth() || scene.has_proliferation()) &&
          !scene.tissue.refine_surface && patch > (0.5 - slack) * h)
        add(warnings,
            "Tissue/Boundary points",
            std::to_string(surface.n_global),
            "they are " + as_text(patch) +
              " um apart at the start, half of Grid/Spacing = " + value +
              " or more; where growth takes those of a slip wall farther "
              "apart than a grid cell, tissue leaks through "
              "(doc/hard-cases.md, instability).",
            "Raise their number, or set Tissue/Refine surface = true.");

      if (!scene.grid.extension)
        add(warnings,
            "Grid/Extension",
            "false",
            "plain splines fail for a third to a half of the places that the "
            "grid can have (doc/hard-cases.md, cuts).",
            "Set it to true, unless that is what you want to show.");
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
      const IsotropicGrowth growth(scene.isotropic_growth);
      const std::size_t     every = std::max<std::size_t>(
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
              "(doc/theory.md, section 4).",
            "Raise it, or set Boundary conditions/Nitsche form = "
            "unsymmetric.");
    }

    void
    warn_of_output(const Scene &scene, Warnings &warnings)
    {
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
    warn_of_grid(scene, founders, surface, comm, warnings);
    warn_of_steps(scene, founders.positions, comm, warnings);
    warn_of_material(scene, warnings);
    warn_of_output(scene, warnings);
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
