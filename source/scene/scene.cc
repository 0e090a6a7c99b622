// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/parameter_file.h>
#include <morula/base/parameter_keys.h>
#include <morula/effects/division/axis_rules.h>
#include <morula/scene/scene.h>
#include <morula/seeding/shape.h>

#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <utility>

namespace Morula
{
  namespace
  {
    void
    append(KeyList &list, const KeyList &more)
    {
      list.insert(list.end(), more.begin(), more.end());
    }

    /** Those keys whose expressions speak of cells. */
    std::vector<ExpressionKey *>
    keys_of_cells(const KeyList &list)
    {
      std::vector<ExpressionKey *> keys;
      for (AnyKey *key : list)
        if (auto *expression = dynamic_cast<ExpressionKey *>(key))
          if (expression->is_of_cells())
            keys.push_back(expression);
      return keys;
    }

    /** Admits the names of all effects of a kind. */
    template <template <int> class Interface>
    void
    add_words(Key<std::string> &key, const Choices<Interface> &choices)
    {
      for (const auto &choice : choices)
        key.add_word(choice.name());
    }
  } // namespace


  Scene::Scene(const Catalogue &catalogue)
    : method("Method",
             "paper",
             "Defaults of the keys that say 'With Method'; those that "
             "the scene sets keep their values. paper: the paper's. "
             "consistent: much more exact beside the edge of a fixed "
             "surface (doc/accuracy-and-cost.md says when not).",
             {"paper|consistent"})
    , dimension("Dimension",
                3,
                "3, or 2 for plane strain per um of thickness.",
                {2, 3})
    , output_directory(
        "Output directory",
        "",
        "Where all files go; empty: output/NAME for a scene "
        "NAME.prm. A new run replaces a finished one of the same "
        "scene file, and others with --replace only.")
    , random_seed("Random seed", 1, "Equal seeds give equal runs.")
    , material(catalogue.materials)
    , growth_law("Growth/Law",
                 "none",
                 "How cells grow without dividing.",
                 {"none"})
    , proliferation_law("Proliferation/Law",
                        "none",
                        "How cells grow and divide.",
                        {"none|cell cycle"})
    , catalogue(catalogue)
  {
    add_words(growth_law, catalogue.growth_laws);
    add_words(cell_cycle.division_axis, catalogue.division_rules);
    if (std::any_of(catalogue.division_rules.begin(),
                    catalogue.division_rules.end(),
                    [](const auto &rule) { return rule.has_section(); }))
      cell_cycle.division_axis.add_documentation(
        " Others: by a rule of this program.");
  }


  std::string
  Scene::law_of_growth() const
  {
    if (growth_law != "none")
      return growth_law;
    for (const CellTypeKeys &type : cell_types.types)
      if (!type.growth_law.empty() && type.growth_law != "none")
        return type.growth_law;
    return "none";
  }


  bool
  Scene::has_growth() const
  {
    return law_of_growth() != "none";
  }


  bool
  Scene::grows(const unsigned int type) const
  {
    if (!cell_types.present() || cell_types.types[type].growth_law.empty())
      return growth_law != "none";
    return cell_types.types[type].growth_law != "none";
  }


  bool
  Scene::has_contraction() const
  {
    return contraction.is_on();
  }


  bool
  Scene::has_death() const
  {
    return death.is_on();
  }


  bool
  Scene::has_proliferation() const
  {
    return proliferation_law != "none" ||
           std::any_of(cell_types.types.begin(),
                       cell_types.types.end(),
                       [](const CellTypeKeys &type) {
                         return type.proliferation_law == "cell cycle";
                       });
  }


  void
  Scene::declare_sections(const std::map<std::string, std::string> &names)
  {
    const auto names_in = [&names](const AnyKey &key) {
      const auto found = names.find(key.path());
      return found == names.end() ? "" : found->second;
    };
    fields.declare_fields(names_in(fields.names));
    for (const std::string &field : fields.name_list())
      cell_cycle.division_axis.add_word("gradient of " + field);
    std::string laws;
    for (const auto &law : catalogue.growth_laws)
      laws += (laws.empty() ? "" : "|") + law.name();
    const std::vector<ExpressionKey *> of_cells = keys_of_cells(list());
    cell_types.declare_types(names_in(cell_types.names),
                             {of_cells.begin(), of_cells.end()},
                             laws,
                             fields.name_list());
    for (auto &condition : catalogue.boundary_conditions)
      if (const AnyKey *key = condition.keys().names_key())
        condition.keys().declare_sections(names_in(*key));
  }


  void
  Scene::apply_types()
  {
    for (ExpressionKey *key : keys_of_cells(list()))
      key->set_fields(fields.name_list());
    if (!cell_types.present())
      return;
    cell_types.apply(keys_of_cells(list_without_types()));
    // Cells of a type that does not proliferate stay in G0.
    if (!has_proliferation())
      return;
    for (unsigned int i = 0; i < cell_types.types.size(); ++i)
      {
        const Key<std::string> &own = cell_types.types[i].proliferation_law;
        const Key<std::string> &law = own.empty() ? proliferation_law : own;
        if (law == "none")
          cell_cycle.exit_rate.set_for_type(i, law.path(), "0");
      }
  }


  bool
  Scene::has_set(const AnyKey &key) const
  {
    return as_written.count(key.path()) > 0;
  }


  KeyList
  Scene::list()
  {
    KeyList list = list_without_types();
    append(list, cell_types.list());
    return list;
  }


  KeyList
  Scene::list_without_types()
  {
    KeyList list = {&method, &dimension, &output_directory, &random_seed};
    for (Keys *section : std::vector<Keys *>{&time, &tissue, &grid, &material})
      append(list, section->list());
    list.push_back(&growth_law);
    for (auto &law : catalogue.growth_laws)
      append(list, law.keys().list());
    list.push_back(&proliferation_law);
    append(list, cell_cycle.list());
    for (auto &rule : catalogue.division_rules)
      append(list, rule.keys().list());
    append(list, contraction.list());
    append(list, death.list());
    append(list, fields.list());
    for (auto &fate : catalogue.fates)
      append(list, fate.keys().list());
    // Nitsche's term belongs to the library's own conditions.
    for (auto &condition : catalogue.boundary_conditions)
      if (!condition.has_section())
        append(list, condition.keys().list());
    append(list, nitsche.list());
    for (auto &condition : catalogue.boundary_conditions)
      if (condition.has_section())
        append(list, condition.keys().list());
    for (auto &force : catalogue.forces)
      append(list, force.keys().list());
    append(list, solver.list());
    append(list, output.list());
    return list;
  }


  Scene
  Scene::read(const std::string              &file,
              const std::vector<std::string> &overrides,
              const Catalogue                &catalogue)
  {
    Scene                  scene(catalogue);
    std::vector<Statement> statements = read_statements(file);
    for (const std::string &text : overrides)
      statements.push_back(read_override(text));
    // Names first: they say which sections there are.
    std::map<std::string, std::string> names;
    for (const Statement &statement : statements)
      if (statement.kind == Statement::set)
        names[statement.path] = statement.value;
    scene.declare_sections(names);
    const ParameterKeys keys(scene.list());

    for (const Statement &statement : statements)
      {
        keys.apply(statement);
        if (statement.kind == Statement::set)
          {
            const std::string path = keys.current_name(statement.path);
            scene.as_written[path] = statement.value;
            scene.places[path]     = statement.place;
            if (path != statement.path)
              scene.renamed.push_back(statement.place + "the key '" +
                                      statement.path + "' is called '" + path +
                                      "' today; 'contrib/migrate " + file +
                                      "' rewrites the file");
          }
      }
    for (AnyKey *key : scene.list())
      for (const auto &[method, text] : key->texts_with_methods())
        if (scene.method == method && !scene.has_set(*key))
          key->assign(text);
    scene.apply_types();
    scene.file = file;
    if (scene.output_directory.empty())
      scene.output_directory =
        (std::filesystem::path("output") / std::filesystem::path(file).stem())
          .string();
    return scene;
  }


  std::string
  Scene::located(const std::string &message) const
  {
    // "SECTION/KEY (cells.csv, line 3) = '...'": the key comes first
    const auto place = places.find(
      message.substr(0, std::min(message.find(" = '"), message.find(" ("))));
    return place == places.end() ? message : place->second + message;
  }


  std::string
  Scene::parameters() const
  {
    ParameterHandler prm;
    Scene            copy(*this);
    copy.declare(prm);
    for (const AnyKey *key : list())
      {
        std::vector<std::string> names;
        boost::split(names, key->path(), boost::is_any_of("/"));
        for (std::size_t i = 0; i + 1 < names.size(); ++i)
          prm.enter_subsection(names[i]);
        prm.set(names.back(), key->text());
        for (std::size_t i = 0; i + 1 < names.size(); ++i)
          prm.leave_subsection();
      }
    std::ostringstream out;
    prm.print_parameters(out,
                         ParameterHandler::ShortPRM |
                           ParameterHandler::KeepDeclarationOrder);
    return out.str();
  }


  namespace
  {
    /** Where the tissue has its centre, µm. */
    template <int dim>
    Point<dim>
    center_of(const TissueParameters &tissue)
    {
      return tissue.shape == "mesh" || tissue.shape == "points" ?
               Point<dim>() :
               leading_components<dim>(tissue.center);
    }
  } // namespace


  template <int dim>
  SceneEffects<dim>
  effects_of(const Scene &scene)
  {
    SceneEffects<dim> effects;
    effects.state =
      StateColumns<dim>(scene.cell_types.name_list(), scene.fields.name_list());
    effects.state.declare_types(effects.columns);
    effects.state.use(scene.material.youngs_modulus);
    effects.state.use(scene.material.poissons_ratio);
    DevelopmentEffects<dim> &development = effects.development;
    if (scene.has_growth())
      effects.columns.need_growth();
    if (scene.has_proliferation())
      {
        const auto &cycle = development.cycle.emplace(scene.cell_cycle,
                                                      scene.random_seed,
                                                      scene.time.slack(),
                                                      effects.state);
        development.clock.emplace(effects.columns,
                                  cycle.has_own_duration(),
                                  cycle.has_own_hazard());
      }
    const EffectSetting<dim> setting{scene.random_seed,
                                     scene.time.slack(),
                                     effects.columns,
                                     effects.state,
                                     center_of<dim>(scene.tissue)};
    const auto               make = [&](const auto &choice) {
      const unsigned int n = effects.columns.n_numbers();
      auto               effect = choice.template make<dim>(setting);
      if (effects.columns.n_numbers() > n)
        development.with_state.push_back(effect.get());
      return effect;
    };

    if (scene.cell_types.present())
      {
        development.types.emplace(scene.cell_types, setting);
        for (unsigned int type = 0; type < development.types->size(); ++type)
          development.grows.push_back(scene.grows(type));
      }
    const Catalogue &catalogue = scene.catalogue;
    if (scene.has_growth())
      development.law =
        make(*find_choice(catalogue.growth_laws, scene.law_of_growth()));
    if (scene.has_proliferation())
      {
        const std::string &axis  = scene.cell_cycle.division_axis;
        const std::string  field = field_of_gradient(axis);
        if (!field.empty())
          development.rule =
            std::make_unique<GradientAxis<dim>>(field, setting);
        else if (const auto *rule = find_choice(catalogue.division_rules, axis))
          development.rule = make(*rule);
      }
    if (scene.has_contraction())
      {
        development.contraction =
          std::make_unique<Contraction<dim>>(scene.contraction, setting);
        if (scene.has_growth())
          development.law_growth = effects.columns.template add<Tensor<2, dim>>(
            {"law_growth",
             "",
             "F_g of the growth law",
             Tensor<2, dim>(unit_symmetric_tensor<dim>())});
      }
    if (scene.material.relaxes())
      {
        effects.columns.need_growth();
        development.relaxation =
          std::make_unique<Relaxation<dim>>(scene.material, effects.state);
      }
    development.forgets_stress =
      scene.cell_types.present() && scene.material.forgets_stress();
    if ((development.relaxation || development.forgets_stress) &&
        !scene.has_proliferation())
      {
        effects.columns.need_growth();
        development.relaxed = effects.columns.template add<Tensor<2, dim>>(
          {"relaxed",
           "",
           "F_r, what has relaxed of F_g",
           Tensor<2, dim>(unit_symmetric_tensor<dim>())});
      }
    if (scene.has_death())
      development.death.emplace(scene.death, setting);
    for (const auto &choice : catalogue.fates)
      if (choice.keys().is_on())
        effects.fates.push_back(make(choice));
    for (const auto &choice : catalogue.forces)
      if (choice.keys().is_on())
        effects.forces.push_back({choice.name(), make(choice)});
    for (const auto &choice : catalogue.boundary_conditions)
      if (choice.keys().is_on())
        effects.conditions.push_back({choice.name(), make(choice)});
    if (scene.fields.present())
      effects.fields = Fields<dim>(scene.fields, setting);
    effects.state.declare(effects.columns);
    return effects;
  }


  template <int dim>
  BoundaryConditions<dim>
  boundary_conditions_of(const Scene &scene)
  {
    return {effects_of<dim>(scene).conditions, scene.nitsche};
  }


#define INSTANTIATE(dim)                                      \
  template SceneEffects<dim>       effects_of(const Scene &); \
  template BoundaryConditions<dim> boundary_conditions_of(const Scene &);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
