// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/expression.h>
#include <morula/base/method.h>
#include <morula/base/parameter_keys.h>
#include <morula/scene/checks.h>
#include <morula/scene/estimates.h>
#include <morula/scene/explain.h>
#include <morula/scene/limits.h>
#include <morula/scene/refusals.h>
#include <morula/scene/size.h>
#include <morula/scene/warnings.h>
#include <morula/seeding/seeding.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>
#include <set>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** One line: a name, 'on' or 'off', and what it is. */
    void
    print_effect(std::ostream      &out,
                 const std::string &name,
                 const bool         on,
                 const std::string &description)
    {
      out << "  " << std::left << std::setw(24) << name
          << (on ? "on   " + description : "off") << '\n';
    }

    std::string
    at_points(const types::particle_index n,
              const std::string          &where,
              const std::string          &what = "")
    {
      return "at " + std::to_string(n) + " boundary points, where " + where +
             what;
    }

    /** Which founders proliferate. */
    std::string
    of_founders(const types::particle_index n,
                const types::particle_index n_founders,
                const std::string          &where)
    {
      return n == n_founders ?
               "all " + std::to_string(n) + " founders" :
               std::to_string(n) + " of " + std::to_string(n_founders) +
                 " founders, where " + where;
    }

    /** ", Key = value" for all keys of the chosen effect, if it is one of the
     *  catalogue. */
    template <template <int> class Interface>
    std::string
    values_of(const std::vector<Choice<Interface>> &choices,
              const std::string                    &chosen)
    {
      std::string text;
      const auto *choice = find_choice(choices, chosen);
      if (choice != nullptr)
        for (const ParameterKey &key : choice->keys())
          text += ", " + key.path + " = " + key.default_value;
      return text;
    }

    /** What `Method` stands for in this scene, a key a line. */
    void
    print_method(std::ostream &out, Scene scene)
    {
      ParameterHandler prm;
      scene.declare(prm);
      const ParameterKeys keys(prm);
      out << "Method\n  " << scene.method << ", which stands for\n";
      for (const auto &[path, consistent] : Method::values("consistent"))
        for (const ParameterKey &key : keys.list())
          if (key.path == path)
            out << "    " << path << " = " << key.default_value
                << (scene.as_written.count(path) > 0 ? " (set by the scene)" :
                                                       "")
                << '\n';
    }

    bool
    has_checkpoint(const Scene &scene)
    {
      return scene.has_proliferation() &&
             !Refusals::same_value(scene.cell_cycle.size_checkpoint, "0");
    }

    void
    print_effects(std::ostream               &out,
                  const Scene                &scene,
                  const ConditionCounts      &counts,
                  const types::particle_index n_founders,
                  const types::particle_index n_proliferating)
    {
      const CellCycleParameters         &cycle = scene.cell_cycle;
      const BoundaryConditionParameters &given = scene.boundary_conditions;

      const bool divides = scene.has_proliferation();
      const bool pulls =
        !Refusals::same_value(scene.body_force.force_density, "0; 0; 0");

      std::ostringstream half_a_grid_cell;
      half_a_grid_cell << 0.5 * scene.grid.spacing;

      out << "Effects\n";
      print_effect(out,
                   "growth",
                   scene.has_growth(),
                   scene.growth_law +
                     (scene.growth_law == "isotropic" ?
                        ", theta = " + scene.isotropic_growth.stretch :
                        values_of(scene.catalogue.growth_laws,
                                  scene.growth_law)));
      print_effect(out,
                   "proliferation",
                   divides,
                   scene.proliferation_law + ", T = " + cycle.duration +
                     " day, Lambda = " + cycle.exit_rate + " /day, " +
                     of_founders(n_proliferating, n_founders, cycle.where));
      print_effect(out,
                   "size checkpoint",
                   has_checkpoint(scene),
                   "J_th = " + cycle.size_checkpoint);
      print_effect(out,
                   "division (Voronoi)",
                   divides,
                   "axis = " + cycle.division_axis +
                     values_of(scene.catalogue.division_rules,
                               cycle.division_axis) +
                     (cycle.axis_follows_rotation ? ", follows rotation" : ""));
      print_effect(out,
                   "fixed points (Nitsche)",
                   counts.fixed > 0,
                   at_points(counts.fixed,
                             given.fixed_where,
                             "; displacement " + given.displacement + " um"));
      print_effect(out,
                   "slip (Nitsche)",
                   counts.slip > 0,
                   at_points(counts.slip, given.slip_where));
      print_effect(out,
                   "traction",
                   counts.traction > 0,
                   at_points(counts.traction,
                             given.traction_where,
                             "; " + given.traction + " kPa"));
      print_effect(out,
                   "pressure",
                   counts.pressure > 0,
                   at_points(counts.pressure,
                             given.pressure_where,
                             "; " + given.pressure + " kPa"));
      print_effect(out,
                   "body force",
                   pulls,
                   scene.body_force.force_density + " kPa/um");
      print_effect(out,
                   "heterogeneous stiffness",
                   !Expression("Material/Young's modulus",
                               scene.material.youngs_modulus)
                      .is_constant(),
                   "E = " + scene.material.youngs_modulus + " kPa");
      print_effect(out,
                   "surface refinement",
                   scene.tissue.refine_surface,
                   "patches longer than " + half_a_grid_cell.str() +
                     " um are split");
      print_effect(out,
                   "projected volume",
                   scene.material.volumetric_form() ==
                     VolumetricStrain::projected,
                   "one mean of ln J_e a grid cell");
    }

    /** @param used  the scene's
     *  @param known those of all effects of the library */
    template <int dim>
    void
    print_columns(std::ostream           &out,
                  const CellColumns<dim> &used,
                  const CellColumns<dim> &known)
    {
      std::set<std::string> names;
      out << "Slots of a cell: " << used.n_numbers() << '\n';
      for (const auto *columns : {&used, &known})
        for (const Columns::Entry &column : columns->entries())
          {
            if (!names.insert(column.name).second)
              continue;
            std::string name = column.name;
            std::replace(name.begin(), name.end(), '_', ' ');
            if (columns == &known)
              print_effect(out, name, false, "");
            else
              out << "  " << std::left << std::setw(24) << name << std::setw(5)
                  << column.n << column.meaning
                  << (column.unit.empty() ? "" : ", " + column.unit) << '\n';
          }
    }

    std::string
    duration_text(const double seconds)
    {
      std::ostringstream text;
      text.precision(2);
      if (seconds < 120.)
        text << seconds << " seconds";
      else if (seconds < 7200.)
        text << seconds / 60. << " minutes";
      else
        text << seconds / 3600. << " hours";
      return text.str();
    }

    /** What the number of cells at the end is. */
    std::string
    bound_of_cells(const Scene &scene)
    {
      return !scene.has_proliferation() ? "" :
             has_checkpoint(scene)      ? "at least " :
                                          "about ";
    }

    void
    print_size(std::ostream       &out,
               const Scene        &scene,
               const SizeEstimate &size,
               const double        available)
    {
      out << "Size\n  cells at the end: " << bound_of_cells(scene)
          << std::round(size.cells)
          << "\n  unknowns: " << size.unknowns_at_start
          << " in the first step, about " << std::round(size.unknowns)
          << " in the last\n"
          << "  memory: about " << std::setprecision(3) << size.memory / 1e9
          << " GB of " << available / 1e9 << " GB\n  time: about "
          << duration_text(size.seconds) << " (" << size.seconds << " s) of "
          << "one core for " << size.steps << " steps, without output; a "
          << "rough estimate, from runs on the processor of "
          << "doc/performance.md\n";
    }

    template <int dim>
    void
    explain_scene(const Scene                         &scene,
                  std::ostream                        &out,
                  const MPI_Comm                       comm,
                  const std::function<unsigned int()> &n_unknowns)
    {
      check_memory(scene, initial_size(scene), comm);
      const Founders<dim> founders =
        seed_founders(scene.tissue, comm, seeding_limits<dim>(scene, comm));
      const types::particle_index n_proliferating =
        check_at_cells(scene, founders.positions, comm);
      const SurfacePatches<dim> surface = seed_surface<dim>(scene.tissue, comm);
      const ConditionCounts     counts = check_at_surface(scene, surface, comm);
      const std::vector<std::string> warnings =
        scene_warnings(scene, founders, surface, comm);
      const SizeEstimate size =
        estimated_size(scene, founders, comm, n_unknowns());
      const double available = physical_memory(comm);
      if (Utilities::MPI::this_mpi_process(comm) != 0)
        return;

      std::ostringstream text;
      text << "The scene is valid.\nTissue\n"
           << "  " << scene.tissue.shape << " in " << dim << "-D, "
           << founders.n_global << " cells, " << counts.points
           << " boundary points\n  grid spacing " << scene.grid.spacing
           << " um, cell spacing " << scene.tissue.cell_spacing << " um\n"
           << "  until " << scene.time.end_time << " day in steps of "
           << scene.time.step << " day\n";
      print_method(text, scene);
      print_effects(text, scene, counts, founders.n_global, n_proliferating);
      CellColumns<dim> known;
      CycleColumns<dim>{known}; // declares them
      print_columns(text, cell_columns_of<dim>(scene), known);
      print_size(text, scene, size, available);
      for (const std::string &warning : warnings)
        text << warning << '\n';
      out << text.str();
    }
  } // namespace


  void
  explain(const Scene                         &scene,
          std::ostream                        &out,
          const MPI_Comm                       comm,
          const std::function<unsigned int()> &n_unknowns)
  {
    if (scene.dimension == 2)
      explain_scene<2>(scene, out, comm, n_unknowns);
    else
      explain_scene<3>(scene, out, comm, n_unknowns);
  }
} // namespace Morula
