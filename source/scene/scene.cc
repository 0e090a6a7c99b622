// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/parameter_file.h>
#include <morula/base/parameter_keys.h>
#include <morula/scene/scene.h>

#include <deal.II/base/patterns.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** Declares the keys of @p parameters in their own section. */
    template <typename Parameters>
    void
    declare_section(ParameterHandler  &prm,
                    const std::string &section,
                    Parameters        &parameters)
    {
      prm.enter_subsection(section);
      parameters.declare(prm);
      prm.leave_subsection();
    }

    /** Default value of each key, as deal.II prints it, by full path. */
    std::map<std::string, std::string>
    defaults(const ParameterKeys &keys)
    {
      std::map<std::string, std::string> result;
      for (const ParameterKey &key : keys.list())
        result[key.path] = key.default_value;
      return result;
    }
  } // namespace


  void
  TimeParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter("End time",
                      end_time,
                      "Time at which the run ends; > 0. Units: day.",
                      Patterns::Double());
    prm.add_parameter("Step",
                      step,
                      "Time step; > 0. Steps end at its multiples. Units: day.",
                      Patterns::Double());
    prm.add_parameter("Smallest step",
                      smallest_step,
                      "A step that fails is halved; the run gives up below "
                      "this; > 0. Units: day.",
                      Patterns::Double());
    prm.add_parameter("Stop at cells",
                      stop_at_cells,
                      "End early at the first step end with at least so many "
                      "cells; 0: never.",
                      Patterns::Integer(0));
  }


  void
  Scene::declare(ParameterHandler &prm)
  {
    prm.add_parameter("Method",
                      method,
                      "Defaults of the keys that say 'With Method'; those that "
                      "the scene sets keep their values. paper: the paper's. "
                      "consistent: much more exact beside the edge of a fixed "
                      "surface (doc/accuracy-and-cost.md says when not).",
                      Patterns::Selection(Method::choices));
    prm.add_parameter("Dimension",
                      dimension,
                      "3, or 2 for plane strain per um of thickness.",
                      Patterns::Integer(2, 3));
    prm.add_parameter("Output directory",
                      output_directory,
                      "Where all files go; empty: output/NAME for a scene "
                      "NAME.prm. A new run replaces a finished one of the same "
                      "scene file, and others with --replace only.");
    prm.add_parameter("Random seed",
                      random_seed,
                      "Equal seeds give equal runs.",
                      Patterns::Integer(0));
    declare_section(prm, "Time", time);
    declare_section(prm, "Tissue", tissue);
    declare_section(prm, "Grid", grid);
    declare_section(prm, "Material", material);
    declare_growth(prm);
    declare_proliferation(prm);
    declare_section(prm, "Boundary conditions", boundary_conditions);
    declare_section(prm, "Body force", body_force);
    declare_section(prm, "Solver", solver);
    declare_section(prm, "Output", output);
  }


  void
  Scene::declare_growth(ParameterHandler &prm)
  {
    prm.enter_subsection("Growth");
    prm.add_parameter("Law",
                      growth_law,
                      "How cells grow without dividing.",
                      Patterns::Selection(
                        "none|isotropic" +
                        as_alternatives(catalogue.growth_laws)));
    declare_section(prm, "Isotropic", isotropic_growth);
    for (auto &law : catalogue.growth_laws)
      law.declare(prm);
    prm.leave_subsection();
  }


  void
  Scene::declare_proliferation(ParameterHandler &prm)
  {
    prm.enter_subsection("Proliferation");
    prm.add_parameter("Law",
                      proliferation_law,
                      "How cells grow and divide.",
                      Patterns::Selection("none|cell cycle"));
    prm.enter_subsection("Cell cycle");
    cell_cycle.declare(prm, as_alternatives(catalogue.division_rules));
    for (auto &rule : catalogue.division_rules)
      rule.declare(prm);
    prm.leave_subsection();
    prm.leave_subsection();
  }


  Scene
  Scene::read(const std::string              &file,
              const std::vector<std::string> &overrides,
              const Catalogue                &catalogue)
  {
    Scene            scene(catalogue);
    ParameterHandler prm;
    scene.declare(prm);
    const ParameterKeys keys(prm);

    std::vector<Statement> statements = read_statements(file);
    for (const std::string &text : overrides)
      statements.push_back(read_override(text));
    for (const Statement &statement : statements)
      {
        keys.apply(statement, prm);
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
    for (const auto &[path, value] : Method::values(scene.method))
      if (scene.as_written.count(path) == 0)
        keys.apply({Statement::set, path, value, ""}, prm);
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
    // "Tissue/Points file (cells.csv, line 3) = '...'": the key comes first
    const auto place = places.find(
      message.substr(0, std::min(message.find(" = '"), message.find(" ("))));
    return place == places.end() ? message : place->second + message;
  }


  std::string
  Scene::parameters() const
  {
    // the members as they are, and as they were when they had just been read
    ParameterHandler prm, prm_read, prm_read_again;
    Scene            now(*this), read(with_defaults());
    now.declare(prm);
    const ParameterKeys keys(prm);
    read.declare(prm_read);
    for (const auto &[path, value] : as_written)
      keys.apply({Statement::set, path, value, ""}, prm_read);
    read.declare(prm_read_again);

    const auto value_now  = defaults(keys);
    const auto value_read = defaults(ParameterKeys(prm_read_again));
    for (const auto &[path, value] : as_written)
      if (value_now.at(path) == value_read.at(path))
        keys.apply({Statement::set, path, value, ""}, prm);

    std::ostringstream out;
    prm.print_parameters(out,
                         ParameterHandler::ShortPRM |
                           ParameterHandler::KeepDeclarationOrder);
    return out.str();
  }


  template <int dim>
  std::unique_ptr<const GrowthLaw<dim>>
  growth_law_of(const Scene &scene)
  {
    if (!scene.has_growth())
      return nullptr;
    const auto added =
      find_choice(scene.catalogue.growth_laws, scene.growth_law);
    if (added != nullptr)
      return added->make<dim>();
    return std::make_unique<const IsotropicGrowth<dim>>(scene.isotropic_growth);
  }


  template <int dim>
  CellColumns<dim>
  cell_columns_of(const Scene &scene)
  {
    CellColumns<dim> columns;
    if (scene.has_growth())
      columns.need_growth();
    if (scene.has_proliferation())
      CycleColumns<dim>{columns}; // declares them
    return columns;
  }


  template <int dim>
  std::unique_ptr<const DivisionRule<dim>>
  division_rule_of(const Scene &scene)
  {
    if (!scene.has_proliferation())
      return nullptr;
    const auto added = find_choice(scene.catalogue.division_rules,
                                   scene.cell_cycle.division_axis);
    return added == nullptr ? nullptr : added->make<dim>();
  }


#define INSTANTIATE(dim)                                                         \
  template std::unique_ptr<const GrowthLaw<dim>> growth_law_of(const Scene &);   \
  template CellColumns<dim>                      cell_columns_of(const Scene &); \
  template std::unique_ptr<const DivisionRule<dim>> division_rule_of(            \
    const Scene &);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
