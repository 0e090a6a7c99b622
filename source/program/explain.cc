// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/json.h>
#include <morula/particles/cell_state.h>
#include <morula/program/explain.h>
#include <morula/program/explain_parts.h>
#include <morula/scene/seeded_tissue.h>
#include <morula/scene/size.h>
#include <morula/simulation/simulation.h>

#include <deal.II/base/mpi.h>

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

    /** The size at t = 0. */
    void
    print_size(std::ostream      &out,
               const unsigned int n_unknowns,
               const unsigned int n_numbers,
               const double       memory)
    {
      out << "Size\n  unknowns: " << n_unknowns
          << " in the first step\n  numbers stored per cell: " << n_numbers
          << " (" << 8 * n_numbers << " bytes)\n  memory: " << memory / 1e9
          << " GB here\n";
    }

    /** Everything that is known of a scene before it runs, on rank 0. */
    template <int dim>
    struct Explanation
    {
      SeededTissue<dim>                  tissue;
      unsigned int                       n_unknowns; // of the first step
      unsigned int                       n_numbers;  // of a cell
      double                             memory;     // bytes of the machine
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
      add_effect(rows, "bodies", text.str());
      add_effect(rows,
                 interaction.name,
                 interaction.effect->details_of_bodies(bodies, h));
    }

    /** How many bodies the tissue is, and which surfaces its mesh has. */
    template <int dim>
    void
    add_bodies(EffectRows              &rows,
               const TissueModel<dim>  &model,
               const SeededTissue<dim> &tissue,
               const MPI_Comm           comm)
    {
      const Scene &scene = model.scene;
      if (model.interaction)
        add_interaction(rows,
                        *model.interaction,
                        scene.grid.spacing,
                        tissue.measures);
      else
        add_effect(rows,
                   "bodies",
                   tissue.bodies.empty() ? bodies_text(scene, tissue, comm) :
                                           tissue.bodies);
      if (!tissue.mesh.empty())
        add_effect(rows, "surface mesh", tissue.mesh);
      if (!tissue.cuts.empty())
        add_effect(rows, "cuts", tissue.cuts);
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
      Explanation<dim>       result;
      const TissueModel<dim> model(scene);
      result.tissue                   = seed_tissue(model, comm);
      const SeededTissue<dim> &tissue = result.tissue;
      // Counted by the splines of the first step.
      result.n_unknowns = Simulation<dim>(scene, comm, tissue).n_unknowns();
      result.n_numbers  = model.development.columns().n_numbers();
      result.memory     = physical_memory(comm);
      result.n_of_types = founders_of_types(model,
                                            tissue.founders.positions,
                                            comm,
                                            tissue.founders.types);
      result.effects    = effect_rows(scene,
                                   tissue.counts,
                                   tissue.applied,
                                   tissue.founders.n_global,
                                   tissue.n_proliferating);
      add_bodies(result.effects, model, tissue, comm);
      std::string pieces;
      for (const std::string &text : texts_of(scene, tissue.pieces))
        pieces += "    " + text + '\n';
      add_effect(result.effects,
                 "pieces",
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
      print_size(text, found.n_unknowns, found.n_numbers, found.memory);
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
      // one object at the end. Effects have the texts of print_text(), so that
      // both forms say the same.
      std::vector<std::string> effects, types;
      for (const EffectRow &row : found.effects)
        effects.push_back(Json::object(
          {{"name", Json::text(row.name)},
           {"description",
            Json::text(row.description + (row.further.empty() ? "" : "\n") +
                       row.further)}}));
      for (std::size_t i = 0; i < found.n_of_types.size(); ++i)
        types.push_back(Json::object(
          {{"name", Json::text(scene.type_names()[i])},
           {"founders", Json::number(double(found.n_of_types[i]))}}));
      std::vector<std::pair<std::string, std::string>> keys;
      for (const AnyKey *key : scene.list())
        keys.emplace_back(key->path(), Json::text(key->text()));
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
                {"size",
                 Json::object(
                   {{"unknowns", Json::number(found.n_unknowns)},
                    {"numbers per cell", Json::number(found.n_numbers)},
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
