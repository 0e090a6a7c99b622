// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/parameter_file.h>
#include <morula/parameter_keys.h>
#include <morula/scene.h>

#include <deal.II/base/patterns.h>

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

    /**
     * Declares a section that chooses one of several laws, and the law's own
     * section inside.
     */
    template <typename Parameters>
    void
    declare_law(ParameterHandler  &prm,
                const std::string &section,
                std::string       &law,
                const std::string &documentation,
                const std::string &laws,
                const std::string &law_section,
                Parameters        &parameters)
    {
      prm.enter_subsection(section);
      prm.add_parameter("Law", law, documentation, Patterns::Selection(laws));
      declare_section(prm, law_section, parameters);
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
    prm.add_parameter("Dimension",
                      dimension,
                      "3, or 2 for plane strain per um of thickness.",
                      Patterns::Integer(2, 3));
    prm.add_parameter("Output directory",
                      output_directory,
                      "Where all files go. A new run replaces the run it finds "
                      "there.");
    prm.add_parameter("Random seed",
                      random_seed,
                      "Equal seeds give equal runs.",
                      Patterns::Integer(0));
    declare_section(prm, "Time", time);
    declare_section(prm, "Tissue", tissue);
    declare_section(prm, "Grid", grid);
    declare_section(prm, "Material", material);
    declare_law(prm,
                "Growth",
                growth_law,
                "How cells grow without dividing.",
                "none|isotropic",
                "Isotropic",
                isotropic_growth);
    declare_law(prm,
                "Proliferation",
                proliferation_law,
                "How cells grow and divide.",
                "none|cell cycle",
                "Cell cycle",
                cell_cycle);
    declare_section(prm, "Boundary conditions", boundary_conditions);
    declare_section(prm, "Body force", body_force);
    declare_section(prm, "Solver", solver);
    declare_section(prm, "Output", output);
  }


  Scene
  Scene::read(const std::string              &file,
              const std::vector<std::string> &overrides)
  {
    Scene            scene;
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
            if (path != statement.path)
              scene.renamed.push_back(statement.place + "the key '" +
                                      statement.path + "' is called '" + path +
                                      "' today; 'contrib/migrate " + file +
                                      "' rewrites the file");
          }
      }
    return scene;
  }


  std::string
  Scene::parameters() const
  {
    // the members as they are, and as they were when they had just been read
    ParameterHandler prm, prm_read, prm_read_again;
    Scene            now(*this), read;
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
} // namespace Morula
