// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/parameter_keys.h>
#include <morula/particles/cell_state.h>
#include <morula/program/program.h>
#include <morula/scene/checks.h>
#include <morula/scene/seeded_tissue.h>
#include <morula/simulation/simulation.h>

#include <deal.II/base/mpi.h>

#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <iomanip>
#include <map>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

namespace Morula
{
  namespace
  {
    /** An effect of a scene: its name, what it is, and further lines. */
    struct EffectRow
    {
      std::string name;
      std::string description;
      std::string further = {};
    };

    using EffectRows = std::vector<EffectRow>;

    /** Prints one line, a name and what it is, and the further lines. */
    void
    print(std::ostream &out, const EffectRow &row)
    {
      out << "  " << std::left << std::setw(24) << row.name << row.description
          << '\n'
          << row.further;
    }

    /** On which founders an effect acts, if it says so. */
    std::string
    of_founders(const types::particle_index n,
                const types::particle_index n_founders,
                const EffectKeys           &keys)
    {
      const ExpressionKey *const where = keys.facts().founders_key;
      if (where == nullptr)
        return "";
      return n == n_founders ?
               ", all " + std::to_string(n) + " founders" :
               ", " + std::to_string(n) + " of " + std::to_string(n_founders) +
                 " founders, where " + where->text();
    }

    /** ", Key = value unit" for each key of an effect. */
    std::string
    details_of(const EffectKeys &keys)
    {
      // The section that all keys have in common is left out. So are defaults
      // that switch something off or on, unless there is nothing else.
      const auto  list    = keys.list();
      std::string section = list.empty() ? "" : list.front()->path();
      bool        all     = true;
      for (const AnyKey *const key : list)
        {
          const std::string &path = key->path();
          section.erase(std::mismatch(section.begin(),
                                      section.end(),
                                      path.begin(),
                                      path.end())
                          .first,
                        section.end());
          all = all && key->is_default();
        }
      section.resize(section.rfind('/') + 1);
      std::string text;
      for (const AnyKey *const key : list)
        if (const std::string value = key->text();
            !value.empty() &&
            (all || !key->is_default() ||
             (value != "0" && value != "true" && value != "false")))
          text += ", " + key->path().substr(section.size()) + " = " + value +
                  (key->unit().empty() ? "" : " " + key->unit());
      return text;
    }

    /** What the chosen effect's keys say, if it is one of the catalogue. */
    template <template <int> class Interface>
    std::string
    details_of(const Choices<Interface> &choices, const std::string &chosen)
    {
      const auto *choice = find_choice(choices, chosen);
      return choice == nullptr ? "" : details_of(choice->keys());
    }

    /** What a condition or force is called. */
    template <template <int> class Interface>
    std::string
    topic_of(const Choice<Interface> &choice)
    {
      const std::string topic = choice.keys().facts().topic;
      return topic.empty() ? choice.name() : topic;
    }

    /** The row of an effect, if its keys switch it on.
     *  @param more behind its details */
    template <template <int> class Interface>
    void
    add_choice(EffectRows              &rows,
               const Choice<Interface> &choice,
               const std::string       &more = "")
    {
      // What has no keys is a part of others.
      const EffectKeys &keys = choice.keys();
      if (!keys.list().empty() && keys.is_on())
        rows.push_back(
          {topic_of(choice),
           boost::trim_left_copy_if(details_of(keys), boost::is_any_of(", ")) +
             more});
    }

    /** Rows for all effects of a kind. */
    template <template <int> class Interface>
    void
    add_effects(EffectRows &rows, const Choices<Interface> &choices)
    {
      for (const auto &choice : choices)
        add_choice(rows, choice);
    }

    /** The effects of a scene, and what they act on. */
    template <int dim>
    EffectRows
    effect_rows(const TissueModel<dim> &model, const SeededTissue<dim> &tissue)
    {
      const Scene              &scene     = model.scene;
      const Catalogue          &catalogue = scene.catalogue;
      const DivisionParameters &division  = scene.division;

      // The rows come in a fixed order: first what the library does to cells,
      // then the effects of the catalogue in its order, then properties of the
      // material and of the surface. An effect that is off has no row.
      EffectRows out;
      if (scene.has_growth())
        out.push_back(
          {"growth",
           scene.law_of_growth() +
             details_of(catalogue.growth_laws, scene.law_of_growth())});
      const auto add_fates = [&](const bool that_grow) {
        for (const auto &choice : catalogue.fates)
          if (choice.keys().facts().grows_cells == that_grow)
            add_choice(out,
                       choice,
                       of_founders(tissue.n_proliferating,
                                   tissue.founders.n_global,
                                   choice.keys()));
      };
      add_fates(true);
      if (scene.cells_divide())
        out.push_back(
          {"division (Voronoi)",
           "axis = " + scene.division_axis() +
             details_of(catalogue.division_rules, scene.division_axis()) +
             (division.axis_follows_rotation ? ", follows rotation" : "") +
             (division.stay_inside ? ", inside the surface" : "")});
      add_effects(out, catalogue.growth_factors);
      add_fates(false);
      add_effects(out, catalogue.equations);
      add_effects(out, catalogue.traits);
      add_effects(out, catalogue.step_effects);
      for (const auto &choice : catalogue.boundary_conditions)
        // A condition is on if it acts somewhere: its expression may be true at
        // no boundary point.
        if (const types::particle_index n =
              tissue.counts.acting.at(choice.name()))
          {
            std::string further;
            for (const auto &[name, text] : tissue.applied)
              if (name == choice.name())
                further = "    " + text + '\n';
            out.push_back({topic_of(choice),
                           "at " + std::to_string(n) + " boundary points" +
                             details_of(choice.keys()),
                           further});
          }
      add_effects(out, catalogue.forces);
      out.push_back({"material", material_text(scene)});
      add_effects(out, catalogue.flows);
      if (has_surface(model) && model.any_surface(true))
        out.push_back({"surface",
                       "made from the cells in each step; Fixed where and "
                       "Slip where apply to the cells that are then at these "
                       "places"});
      else if (scene.tissue.refine_surface)
        out.push_back({"surface refinement",
                       "patches longer than " +
                         as_text(0.5 * scene.grid.spacing) + " um are split"});
      return out;
    }

    /** Prints the types of cells, and for each type the keys that it sets
     *  differently. Prints nothing without types. @param n_founders by type, on
     *  all ranks */
    void
    print_types(std::ostream                             &out,
                const Scene                              &scene,
                const std::vector<types::particle_index> &n_founders)
    {
      const std::vector<std::string> names = scene.type_names();
      if (!names.empty())
        out << "Cell types\n";
      for (unsigned int i = 0; i < names.size(); ++i)
        out << "  " << std::left << std::setw(24) << names[i] << n_founders[i]
            << (n_founders[i] == 1 ? " founder" : " founders") << '\n'
            << scene.cell_types.details_of(i);
    }

    /** So many bodies are described one by one. */
    constexpr std::size_t most_bodies_listed = 8;

    /** What `Method` stands for in this scene, a key a line. */
    void
    print_method(std::ostream &out, const Scene &scene)
    {
      out << "Method\n  " << scene.method << " sets\n";
      for (const AnyKey *key : scene.list())
        if (!key->texts_by_method().empty())
          out << "    " << key->path() << " = " << key->shown()
              << (scene.has_set(*key) ? " (set by the scene)" : "") << '\n';
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

    /** Which bodies interact, and which surfaces a mesh has. */
    template <int dim>
    void
    add_bodies(EffectRows              &rows,
               const TissueModel<dim>  &model,
               const SeededTissue<dim> &tissue)
    {
      if (model.interaction)
        {
          const auto &[name, effect]              = *model.interaction;
          const std::vector<BodyMeasures> &bodies = tissue.measures;
          std::ostringstream               text;
          text << bodies.size() << (bodies.size() == 1 ? " body" : " bodies")
               << (effect->acts_within_bodies() ?
                     "; folds have " + name + ", too" :
                     "");
          for (std::size_t b = 0; b < bodies.size() && b < most_bodies_listed;
               ++b)
            text << "; body " << b << ": " << bodies[b].cells << " cells, "
                 << bodies[b].volume << (dim == 3 ? " um^3" : " um^2")
                 << ", surface " << bodies[b].area
                 << (dim == 3 ? " um^2" : " um");
          rows.push_back({"bodies", text.str()});
          rows.push_back(
            {name,
             effect->details_of_bodies(bodies, model.scene.grid.spacing)});
        }
      if (!tissue.mesh.empty())
        rows.push_back({"surface mesh", tissue.mesh});
      if (!tissue.cuts.empty())
        rows.push_back({"cuts", tissue.cuts});
    }

    /** Whose volumes are one sum. @param mixed the part of the tissue in pools
     * of unlike cells */
    void
    add_pools(EffectRows &rows, const double mixed)
    {
      constexpr double much = 0.01;
      rows.push_back(
        {"volumetric strain",
         "cells of one kind within a grid cell share one pressure",
         mixed < much ?
           "" :
           "    " + as_text(std::round(100. * mixed)) +
             " % of the tissue is layers or mixtures of cells of different "
             "kinds, too fine for the grid: these share one pressure. Choose a "
             "finer grid, or make them bodies with a section Contact.\n"});
    }

    /** In what time a layer folds against friction: doc/theory.md (4.7c).
     *  @param zeta over the stiffness, day/µm^2 @param h grid spacing, µm */
    void
    add_fold_time(EffectRows &rows, const double zeta, const double h)
    {
      if (zeta == 0.)
        return;
      const double H = 2. * h, wavelength = 10. * H,
                   time = 12. * zeta *
                          std::pow(wavelength / (2. * numbers::PI), 4) /
                          (H * H);
      rows.push_back(
        {"folds",
         "friction lets a layer of " + as_text(H) +
           " um (two grid spacings) "
           "fold in " +
           as_text(time) + " day at a wavelength of " + as_text(wavelength) +
           " um, in 16 times that at twice the wavelength; faster growth folds "
           "it at shorter wavelengths"});
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
      Simulation<dim> simulation(scene, comm, tissue);
      result.n_unknowns = simulation.n_unknowns();
      result.n_numbers  = model.development.columns().n_numbers();
      result.memory     = physical_memory(comm);
      result.n_of_types = founders_of_types(model,
                                            tissue.founders.positions,
                                            comm,
                                            tissue.founders.types);
      result.effects    = effect_rows(model, tissue);
      add_bodies(result.effects, model, tissue);
      if (scene.material.volumetric_form() == VolumetricStrain::pooled)
        add_pools(result.effects, simulation.mixed_share());
      add_fold_time(result.effects,
                    simulation.friction_over_stiffness(),
                    scene.grid.spacing);
      std::string pieces;
      for (const std::string &text : tissue.pieces)
        pieces += "    " + text + '\n';
      result.effects.push_back(
        {"connected tissues", std::to_string(tissue.n_pieces), pieces});
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
           << "  until day " << scene.time.end_time << ", in steps of "
           << scene.time.step << " day\n";
      print_method(text, scene);
      text << "Effects\n";
      for (const EffectRow &row : found.effects)
        print(text, row);
      print_types(text, scene, found.n_of_types);
      text << "Size\n  unknowns: " << found.n_unknowns
           << " in the first step\n  numbers stored per cell: "
           << found.n_numbers << " (" << 8 * found.n_numbers
           << " bytes)\n  memory of this machine: " << found.memory / 1e9
           << " GB\n";
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
      if (json)
        print_json(out, scene, found);
      else
        print_text(out, scene, found);
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
