// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/json.h>
#include <morula/particles/cell_state.h>
#include <morula/program/explain.h>
#include <morula/program/explain_parts.h>
#include <morula/scene/estimates.h>
#include <morula/scene/free_growth.h>
#include <morula/scene/seeded_tissue.h>
#include <morula/scene/size.h>
#include <morula/simulation/simulation.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iomanip>
#include <limits>
#include <ostream>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** So many bodies are described one by one. */
    constexpr std::size_t most_bodies_listed = 8;

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

    template <int dim>
    void
    print_columns(std::ostream &out, const CellColumns<dim> &columns)
    {
      out << "Slots of a cell: " << columns.n_numbers() << '\n';
      for (const Columns::Entry &column : columns.entries())
        {
          std::string name = column.name;
          std::replace(name.begin(), name.end(), '_', ' ');
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
      const RestOfScene rest = scene.rest_of_scene();
      for (const EffectKeys *const keys : scene.keys_in_use())
        if (const std::string bound = keys->counts_cells(rest); !bound.empty())
          return bound;
      return "";
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
               const double                 available,
               const double                 seeding)
    {
      out << "Size\n  cells at the end: " << bound_of_cells(scene)
          << std::round(size.cells)
          << "\n  unknowns: " << size.unknowns_at_start
          << " in the first step, about " << std::round(size.unknowns)
          << " in the last" << (growth ? growth_text(*growth) : "") << "\n"
          << "  memory: about " << std::setprecision(3) << size.memory / 1e9
          << " GB of " << available / 1e9 << " GB\n  time: about "
          << duration_text(seeding + size.seconds) << ": "
          << duration_text(seeding) << " (" << seeding << " s) to place cells "
          << "and surface, as it has taken here, and "
          << duration_text(size.seconds) << " (" << size.seconds << " s) of "
          << "one core for " << size.steps << " steps, without output; a "
          << "rough estimate, from runs on an AMD EPYC with AVX-512 "
          << "(doc/performance.md)\n";
      for (const auto &[name, seconds] : size.of_effects)
        out << "    of it " << name << ": " << duration_text(seconds) << ", "
            << std::round(100. * seconds / size.seconds) << " % of the steps\n";
    }

    /** Everything that is known of a scene before it runs, on rank 0. */
    template <int dim>
    struct Explanation
    {
      SeededTissue<dim>                  tissue;
      std::optional<FreeGrowth>          free;
      std::optional<double>              growth; // see estimated_size()
      SizeEstimate                       size;
      double                             memory;  // bytes of the machine
      double                             seeding; // seconds that it took here
      std::vector<types::particle_index> n_of_types;
      EffectRows                         effects;
    };

    /** The bodies that interact, and how. */
    template <int dim>
    void
    add_interaction(EffectRows                          &rows,
                    const NamedEffect<Interaction<dim>> &interaction,
                    const double                         h,
                    const std::vector<BodyMeasures>     &bodies)
    {
      std::ostringstream text;
      text << bodies.size() << (bodies.size() == 1 ? " body" : " bodies")
           << (interaction.effect->acts_within_bodies() ?
                 ", whose folds and arms have " + interaction.name + ", too" :
                 ", each with splines of its own");
      for (std::size_t b = 0; b < bodies.size() && b < most_bodies_listed; ++b)
        text << "; body " << b << ": " << bodies[b].cells << " cells, "
             << bodies[b].volume << (dim == 3 ? " um^3" : " um^2")
             << ", surface " << bodies[b].area << (dim == 3 ? " um^2" : " um");
      add_effect(rows, "bodies", true, text.str());
      add_effect(rows,
                 interaction.name,
                 true,
                 interaction.effect->details_of_bodies(bodies, h));
    }

    /** How many bodies the tissue is, and which surfaces its mesh has. */
    template <int dim>
    void
    add_bodies(EffectRows              &rows,
               const Scene             &scene,
               const SeededTissue<dim> &tissue,
               const MPI_Comm           comm)
    {
      if (const auto interaction = interaction_of<dim>(scene))
        add_interaction(rows,
                        *interaction,
                        scene.grid.spacing,
                        tissue.measures);
      else
        add_effect(rows,
                   "bodies",
                   true,
                   tissue.bodies.empty() ? bodies_text(scene, tissue, comm) :
                                           tissue.bodies);
      if (!tissue.mesh.empty())
        add_effect(rows, "surface mesh", true, tissue.mesh);
      if (!tissue.cuts.empty())
        add_effect(rows, "cuts", true, tissue.cuts);
    }

    template <int dim>
    Explanation<dim>
    explanation_of(const Scene &scene, const MPI_Comm comm)
    {
      // The order is that of the cost: memory is tested before anything is
      // seeded, and the first splines are made once the tissue is known. Every
      // call is collective, so all ranks make an explanation and only rank 0
      // prints it.
      check_memory(scene, initial_size(scene), comm);
      Explanation<dim> result;
      const auto       begin = std::chrono::steady_clock::now();
      result.tissue          = seed_tissue<dim>(scene, comm);
      result.seeding =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin)
          .count();
      const SeededTissue<dim> &tissue = result.tissue;
      // Counted by the splines of the first step.
      const unsigned int n_unknowns =
        Simulation<dim>(scene, comm, tissue).n_unknowns();
      result.free = free_growth(scene, tissue.founders, tissue.surface, comm);
      // Growth that place and time alone tell is in the estimate of the size
      // already. What depends on the cells' state is not, so the mean over
      // founders stands for it, and is printed with the size.
      if (result.free && !result.free->known_before)
        result.growth = result.free->mean;
      result.size       = estimated_size(scene,
                                   tissue.founders,
                                   comm,
                                   n_unknowns,
                                   result.growth,
                                   result.free ? result.free->cells : 0.);
      result.memory     = physical_memory(comm);
      result.n_of_types = founders_of_types(scene,
                                            tissue.founders.positions,
                                            comm,
                                            tissue.founders.types);
      result.effects    = effect_rows(scene,
                                   tissue.counts,
                                   tissue.applied,
                                   tissue.founders.n_global,
                                   tissue.n_proliferating);
      add_bodies(result.effects, scene, tissue, comm);
      std::string pieces;
      for (const std::string &text : texts_of(scene, tissue.pieces))
        pieces += "    " + text + '\n';
      add_effect(result.effects,
                 "pieces",
                 true,
                 std::to_string(tissue.pieces.size()),
                 pieces);
      return result;
    }

    template <int dim>
    void
    print_text(std::ostream           &text,
               const Scene            &scene,
               const Explanation<dim> &found)
    {
      text << "The scene is valid.\nTissue\n"
           << "  " << scene.tissue.shape << " in " << dim << "-D, "
           << found.tissue.founders.n_global << " cells, "
           << found.tissue.counts.points << " boundary points\n  grid spacing "
           << scene.grid.spacing << " um, cell spacing "
           << scene.tissue.cell_spacing << " um\n"
           << "  until " << scene.time.end_time << " day in steps of "
           << scene.time.step << " day\n";
      print_method(text, scene);
      text << "Effects\n";
      for (const EffectRow &row : found.effects)
        print(text, row);
      print_types(text, scene, found.n_of_types);
      print_cell_expressions(text, scene);
      print_folds(text, scene, found.free);
      print_columns(text, effects_of<dim>(scene).columns);
      print_size(
        text, scene, found.size, found.growth, found.memory, found.seeding);
      for (const std::string &warning : found.tissue.warnings)
        text << warning << '\n';
    }

    /** Prints what print_text() does as JSON, an object a line. */
    template <int dim>
    void
    print_json(std::ostream           &out,
               const Scene            &scene,
               const Explanation<dim> &found)
    {
      // The lists are made first, each entry an object of its own, and put into
      // one object at the end. Effects and folds have the texts of
      // print_text(), so that both forms say the same.
      std::vector<std::string> effects, columns, types;
      for (const EffectRow &row : found.effects)
        effects.push_back(Json::object(
          {{"name", Json::text(row.name)},
           {"on", Json::truth(row.on)},
           {"description",
            Json::text(row.description + (row.further.empty() ? "" : "\n") +
                       row.further)}}));
      const CellColumns<dim> used = effects_of<dim>(scene).columns;
      for (const Columns::Entry &column : used.entries())
        columns.push_back(Json::object({{"name", Json::text(column.name)},
                                        {"numbers", Json::number(column.n)},
                                        {"meaning", Json::text(column.meaning)},
                                        {"unit", Json::text(column.unit)}}));
      for (std::size_t i = 0; i < found.n_of_types.size(); ++i)
        types.push_back(Json::object(
          {{"name", Json::text(scene.type_names()[i])},
           {"founders", Json::number(double(found.n_of_types[i]))}}));
      std::vector<std::pair<std::string, std::string>> keys;
      for (const AnyKey *key : scene.list())
        keys.emplace_back(key->path(), Json::text(key->text()));
      std::ostringstream folds;
      print_folds(folds, scene, found.free);
      const SizeEstimate                              &size = found.size;
      std::vector<std::pair<std::string, std::string>> of_effects;
      for (const auto &[name, seconds] : size.of_effects)
        of_effects.emplace_back(name, Json::number(seconds));
      out << Json::object(
               {{"dimension", Json::number(dim)},
                {"shape", Json::text(scene.tissue.shape)},
                {"cells", Json::number(double(found.tissue.founders.n_global))},
                {"boundary points",
                 Json::number(double(found.tissue.counts.points))},
                {"proliferating",
                 Json::number(double(found.tissue.n_proliferating))},
                {"effects", Json::list(effects)},
                {"types", Json::list(types)},
                {"columns", Json::list(columns)},
                {"folds", Json::text(folds.str())},
                {"size",
                 Json::object(
                   {{"cells at the end", Json::number(std::round(size.cells))},
                    {"unknowns at start", Json::number(size.unknowns_at_start)},
                    {"unknowns at the end",
                     Json::number(std::round(size.unknowns))},
                    {"steps", Json::number(size.steps)},
                    {"seconds", Json::number(size.seconds)},
                    {"seconds of effects", Json::object(of_effects)},
                    {"seconds of seeding", Json::number(found.seeding)},
                    {"bytes", Json::number(size.memory)},
                    {"bytes of the machine", Json::number(found.memory)}})},
                {"warnings", Json::texts(found.tissue.warnings)},
                {"keys", Json::object(keys)}})
          << '\n';
    }

    template <int dim>
    void
    explain_scene(const Scene   &scene,
                  std::ostream  &out,
                  const MPI_Comm comm,
                  const bool     json)
    {
      const Explanation<dim> found = explanation_of<dim>(scene, comm);
      if (Utilities::MPI::this_mpi_process(comm) != 0)
        return;
      std::ostringstream text;
      if (json)
        print_json(text, scene, found);
      else
        print_text(text, scene, found);
      out << text.str();
    }
  } // namespace


  void
  explain(const Scene   &scene,
          std::ostream  &out,
          const MPI_Comm comm,
          const bool     json)
  {
    if (scene.dimension == 2)
      explain_scene<2>(scene, out, comm, json);
    else
      explain_scene<3>(scene, out, comm, json);
  }
} // namespace Morula
