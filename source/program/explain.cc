// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/particles/cell_state.h>
#include <morula/program/explain.h>
#include <morula/program/explain_cells.h>
#include <morula/program/explain_folds.h>
#include <morula/scene/estimates.h>
#include <morula/scene/free_growth.h>
#include <morula/scene/seeded_tissue.h>
#include <morula/scene/size.h>
#include <morula/simulation/simulation.h>

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

    /** What the chosen effect's keys say, if it is one of the catalogue. */
    template <template <int> class Interface>
    std::string
    details_of(const Choices<Interface> &choices, const std::string &chosen)
    {
      const auto *choice = find_choice(choices, chosen);
      return choice == nullptr ? "" : choice->keys().details();
    }

    /** What a condition or force is called. */
    template <template <int> class Interface>
    std::string
    topic_of(const Choice<Interface> &choice)
    {
      const std::string topic = choice.keys().topic();
      return topic.empty() ? choice.name() : topic;
    }

    /** What `Method` stands for in this scene, a key a line. */
    void
    print_method(std::ostream &out, const Scene &scene)
    {
      out << "Method\n  " << scene.method << ", which stands for\n";
      for (const AnyKey *key : scene.list())
        if (!key->texts_by_method().empty())
          out << "    " << key->path() << " = " << key->shown()
              << (scene.has_set(*key) ? " (set by the scene)" : "") << '\n';
    }

    void
    print_fields(std::ostream &out, const Scene &scene)
    {
      print_effect(out, "fields", scene.fields.present(), scene.fields.names);
      for (const FieldKeys &field : scene.fields.fields)
        {
          out << "    " << std::left << std::setw(22) << field.name
              << field.time.value() << ", D = " << field.diffusion.text()
              << " um^2/day, s = " << field.production.text()
              << ", k = " << field.consumption.text() << " /day";
          if (!field.fixed_where.empty())
            out << ", " << field.value.text() << " at boundary points where "
                << field.fixed_where.text();
          if (!field.transfer.empty())
            out << ", transfer " << field.transfer.text() << " um/day to "
                << field.value.text();
          if (!field.flux_where.empty())
            out << ", flux " << field.flux.text()
                << " um/day in at boundary points where "
                << field.flux_where.text();
          out << '\n';
        }
    }

    bool
    has_checkpoint(const Scene &scene)
    {
      return scene.has_proliferation() &&
             !scene.cell_cycle.size_checkpoint.is_default();
    }

    void
    print_effects(std::ostream               &out,
                  const Scene                &scene,
                  const ConditionCounts      &counts,
                  const types::particle_index n_founders,
                  const types::particle_index n_proliferating)
    {
      const CellCycleParameters &cycle     = scene.cell_cycle;
      const Catalogue           &catalogue = scene.catalogue;
      const bool                 divides   = scene.has_proliferation();

      std::ostringstream half_a_grid_cell;
      half_a_grid_cell << 0.5 * scene.grid.spacing;

      out << "Effects\n";
      print_effect(out,
                   "growth",
                   scene.has_growth(),
                   scene.law_of_growth() +
                     details_of(catalogue.growth_laws, scene.law_of_growth()));
      print_effect(out,
                   "proliferation",
                   divides,
                   "cell cycle, T = " + cycle.duration.text() +
                     " day, Lambda = " + cycle.exit_rate.text() + " /day, " +
                     of_founders(n_proliferating,
                                 n_founders,
                                 cycle.where.text()));
      print_effect(out,
                   "size checkpoint",
                   has_checkpoint(scene),
                   "J_th = " + cycle.size_checkpoint.text());
      print_effect(out,
                   "division (Voronoi)",
                   divides,
                   "axis = " + cycle.division_axis +
                     details_of(catalogue.division_rules, cycle.division_axis) +
                     (cycle.axis_follows_rotation ? ", follows rotation" : "") +
                     (cycle.stay_inside ? ", inside the surface" : ""));
      print_effect(out,
                   "contraction",
                   scene.has_contraction(),
                   "gamma = " + scene.contraction.stretch.text() + ", along " +
                     scene.contraction.direction.text() +
                     (scene.contraction.keep_volume ? ", keeps volume" : ""));
      print_effect(out,
                   "death",
                   scene.has_death(),
                   "rate = " + scene.death.rate.text() +
                     " /day, when = " + scene.death.when.text() +
                     ", shrinking time = " + scene.death.shrinking_time.text() +
                     " day");
      print_fields(out, scene);
      for (const auto &choice : catalogue.fates)
        print_effect(out,
                     topic_of(choice),
                     choice.keys().is_on(),
                     choice.keys().details());
      for (const auto &choice : catalogue.boundary_conditions)
        {
          const types::particle_index n     = counts.acting.at(choice.name());
          const AnyKey *const         where = choice.keys().switch_key();
          print_effect(out,
                       topic_of(choice),
                       n > 0,
                       "at " + std::to_string(n) + " boundary points" +
                         (where == nullptr ? "" : ", where " + where->text()) +
                         choice.keys().details());
        }
      for (const auto &choice : catalogue.forces)
        print_effect(out,
                     topic_of(choice),
                     choice.keys().is_on(),
                     choice.keys().details());
      print_effect(out,
                   "heterogeneous stiffness",
                   !scene.material.youngs_modulus.expression(scene.dimension)
                      .is_constant(),
                   "E = " + scene.material.youngs_modulus.text() + " kPa");
      print_effect(out,
                   "relaxation",
                   scene.material.relaxes(),
                   "tau = " + scene.material.relaxation_time.text() +
                     " day, yield stress = " +
                     scene.material.yield_stress.text() + " kPa");
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
      print_effect(out,
                   "pooled volume",
                   scene.material.volumetric_form() == VolumetricStrain::pooled,
                   "one sum of volumes a grid cell");
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
      if (!scene.has_proliferation())
        return "";
      const CellCycleParameters &cycle = scene.cell_cycle;
      const unsigned int         dim   = scene.dimension;
      return has_checkpoint(scene) || scene.has_death() ||
                 depends_on_more_than_place(cycle.duration.expression(dim)) ||
                 depends_on_more_than_place(cycle.exit_rate.expression(dim)) ?
               "at least " :
               "about ";
    }

    /** What the size takes for growth that depends on the cells' state. */
    std::string
    growth_text(const double free_growth)
    {
      std::ostringstream text;
      text.precision(3);
      text << "; growth taken for " << free_growth
           << ", that of cells which nothing presses and which keep their type";
      return text.str();
    }

    void
    print_size(std::ostream                &out,
               const Scene                 &scene,
               const SizeEstimate          &size,
               const std::optional<double> &growth,
               const double                 available)
    {
      out << "Size\n  cells at the end: " << bound_of_cells(scene)
          << std::round(size.cells)
          << "\n  unknowns: " << size.unknowns_at_start
          << " in the first step, about " << std::round(size.unknowns)
          << " in the last" << (growth ? growth_text(*growth) : "") << "\n"
          << "  memory: about " << std::setprecision(3) << size.memory / 1e9
          << " GB of " << available / 1e9 << " GB\n  time: about "
          << duration_text(size.seconds) << " (" << size.seconds << " s) of "
          << "one core for " << size.steps << " steps, without output; a "
          << "rough estimate, from runs on an AMD EPYC with AVX-512 "
          << "(doc/performance.md)\n";
    }

    template <int dim>
    void
    explain_scene(const Scene &scene, std::ostream &out, const MPI_Comm comm)
    {
      check_memory(scene, initial_size(scene), comm);
      const SeededTissue<dim> tissue = seed_tissue<dim>(scene, comm);
      // Counted by the splines of the first step.
      const unsigned int n_unknowns =
        Simulation<dim>(scene, comm, tissue).n_unknowns();
      const std::optional<FreeGrowth> free =
        free_growth(scene, tissue.founders, tissue.surface, comm);
      std::optional<double> growth; // where the estimate does not know it
      if (free && !free->known_before)
        growth = free->mean;
      const SizeEstimate size =
        estimated_size(scene, tissue.founders, comm, n_unknowns, growth);
      const double available = physical_memory(comm);
      const std::vector<types::particle_index> n_of_types = founders_of_types(
        scene, tissue.founders.positions, comm, tissue.founders.types);
      if (Utilities::MPI::this_mpi_process(comm) != 0)
        return;

      std::ostringstream text;
      text << "The scene is valid.\nTissue\n"
           << "  " << scene.tissue.shape << " in " << dim << "-D, "
           << tissue.founders.n_global << " cells, " << tissue.counts.points
           << " boundary points\n  grid spacing " << scene.grid.spacing
           << " um, cell spacing " << scene.tissue.cell_spacing << " um\n"
           << "  until " << scene.time.end_time << " day in steps of "
           << scene.time.step << " day\n";
      print_method(text, scene);
      print_effects(text,
                    scene,
                    tissue.counts,
                    tissue.founders.n_global,
                    tissue.n_proliferating);
      print_types(text, scene, n_of_types);
      print_cell_expressions(text, scene);
      print_folds(text, scene, free);
      CellColumns<dim> known;
      CycleColumns<dim>{known}; // declares them
      print_columns(text, effects_of<dim>(scene).columns, known);
      print_size(text, scene, size, growth, available);
      for (const std::string &warning : tissue.warnings)
        text << warning << '\n';
      out << text.str();
    }
  } // namespace


  void
  explain(const Scene &scene, std::ostream &out, const MPI_Comm comm)
  {
    if (scene.dimension == 2)
      explain_scene<2>(scene, out, comm);
    else
      explain_scene<3>(scene, out, comm);
  }
} // namespace Morula
