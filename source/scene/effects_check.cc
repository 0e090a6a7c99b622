// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/expression.h>
#include <morula/base/input_error.h>
#include <morula/base/unit_vector.h>
#include <morula/scene/effects_check.h>
#include <morula/scene/refusals.h>

#include <deal.II/base/patterns.h>

namespace Morula
{
  using namespace Refusals;

  namespace
  {
    /** Makes the effect of the catalogue that the scene names, for what it
     *  refuses, and refuses values of those that it does not. */
    template <int dim, template <int> class Interface>
    void
    check_choices(const Scene                          &scene,
                  const std::vector<Choice<Interface>> &choices,
                  const std::string                    &section,
                  const std::string                    &switch_key,
                  const std::string                    &chosen)
    {
      for (const auto &choice : choices)
        {
          if (choice.name() == chosen)
            {
              choice.template make<dim>();
              continue;
            }
          const auto values   = choice.keys();
          const auto defaults = choice.with_defaults().keys();
          for (std::size_t i = 0; i < values.size(); ++i)
            refuse_forgotten(scene,
                             switch_key,
                             section + choice.section() + "/" + values[i].path,
                             values[i].default_value,
                             same_value(values[i].default_value,
                                        defaults[i].default_value),
                             "Set " + switch_key + " = " + choice.name());
        }
    }

    void
    check_cell_cycle_unused(const Scene &scene)
    {
      const CellCycleParameters &cycle = scene.cell_cycle;
      const CellCycleParameters  defaults;
      const std::string          section = "Proliferation/Cell cycle/";
      const auto                 check   = [&](const std::string &key,
                             const auto        &value,
                             const auto        &default_value) {
        const std::string text = Patterns::Tools::to_string(value);
        refuse_forgotten(scene,
                         "Proliferation/Law",
                         section + key,
                         text,
                         same_value(text,
                                    Patterns::Tools::to_string(default_value)),
                         "Set Proliferation/Law = cell cycle");
      };
      check("Start", cycle.start, defaults.start);
      check("Duration", cycle.duration, defaults.duration);
      check("G0 exit rate", cycle.exit_rate, defaults.exit_rate);
      check("Size checkpoint", cycle.size_checkpoint, defaults.size_checkpoint);
      check("Where", cycle.where, defaults.where);
      check("Division axis", cycle.division_axis, defaults.division_axis);
      check("Fixed axis", cycle.fixed_axis, defaults.fixed_axis);
      check("Axis follows rotation",
            cycle.axis_follows_rotation,
            defaults.axis_follows_rotation);
    }

    template <int dim>
    void
    check_cell_cycle(const Scene &scene)
    {
      const CellCycleParameters &cycle   = scene.cell_cycle;
      const std::string          section = "Proliferation/Cell cycle/";
      refuse_constant_unless(Sign::positive,
                             "day",
                             in_space_only(section + "Duration",
                                           cycle.duration,
                                           dim),
                             "Choose the duration of a cycle in days.");
      refuse_constant_unless(Sign::not_negative,
                             "1/day",
                             in_space_only(section + "G0 exit rate",
                                           cycle.exit_rate,
                                           dim),
                             "0 lets cells wait forever.");
      refuse_constant_unless(Sign::not_negative,
                             "(a ratio of volumes)",
                             in_space_only(section + "Size checkpoint",
                                           cycle.size_checkpoint,
                                           dim),
                             "0 means no checkpoint.");
      in_space_only(section + "Where", cycle.where, dim);
      refuse_forgotten(scene,
                       section + "Division axis",
                       section + "Fixed axis",
                       Patterns::Tools::to_string(cycle.fixed_axis),
                       cycle.division_axis == "fixed" ||
                         cycle.fixed_axis == CellCycleParameters().fixed_axis,
                       "Set " + section + "Division axis = fixed");
      CellCycle<dim>(cycle, scene.random_seed, 1e-9 * scene.time.step);
    }

    template <int dim>
    void
    check_growth(const Scene &scene)
    {
      check_choices<dim>(scene,
                         scene.catalogue.growth_laws,
                         "Growth/",
                         "Growth/Law",
                         scene.growth_law);
      if (scene.growth_law == "isotropic")
        {
          const Expression stretch("Growth/Isotropic/Stretch",
                                   scene.isotropic_growth.stretch);
          stretch.check_dimension(dim);
          refuse_constant_unless(Sign::positive,
                                 "(a ratio of lengths)",
                                 stretch,
                                 "1 is the initial size.");
        }
      else
        refuse_forgotten(scene,
                         "Growth/Law",
                         "Growth/Isotropic/Stretch",
                         scene.isotropic_growth.stretch,
                         same_value(scene.isotropic_growth.stretch,
                                    IsotropicGrowthParameters().stretch),
                         "Set Growth/Law = isotropic");
    }

    /** A condition's key 'where' and the key of its value. */
    struct WrittenCondition
    {
      std::string where_key, where;
      std::string value_key, value, default_value;
      bool        is_vector;
    };

    void
    check_condition(const Scene &scene, const WrittenCondition &condition)
    {
      const std::string section   = "Boundary conditions/";
      const std::string where_key = section + condition.where_key;
      const bool        is_on     = !condition.where.empty();
      if (is_on)
        {
          in_space_only(where_key, condition.where, scene.dimension);
          if (scene.tissue.shape == "points")
            throw InputError(where_key,
                             condition.where,
                             "nothing for Tissue/Shape = points",
                             "Points from a file have no surface: remove the "
                             "condition or choose another shape.");
        }
      if (condition.value_key.empty())
        return;
      const Expression value(section + condition.value_key,
                             condition.value,
                             condition.is_vector ? 3 : 1,
                             condition.is_vector ? scene.dimension : 1);
      if (is_on)
        value.check_dimension(scene.dimension);
      refuse_forgotten(scene,
                       where_key,
                       section + condition.value_key,
                       condition.value,
                       is_on ||
                         same_value(condition.value, condition.default_value),
                       "Say where it acts by " + where_key);
    }

    template <int dim>
    void
    check_boundary_conditions(const Scene &scene)
    {
      const BoundaryConditionParameters &given = scene.boundary_conditions;
      const BoundaryConditionParameters  defaults;
      for (const WrittenCondition &condition : std::vector<WrittenCondition>{
             {"Fixed where",
              given.fixed_where,
              "Displacement",
              given.displacement,
              defaults.displacement,
              true},
             {"Slip where", given.slip_where, "", "", "", false},
             {"Traction where",
              given.traction_where,
              "Traction",
              given.traction,
              defaults.traction,
              true},
             {"Pressure where",
              given.pressure_where,
              "Pressure",
              given.pressure,
              defaults.pressure,
              false}})
        check_condition(scene, condition);

      const std::string section = "Boundary conditions/";
      if (!given.slip_normal.empty())
        {
          unit_vector<dim>(section + "Slip normal", given.slip_normal);
          refuse_forgotten(scene,
                           section + "Slip where",
                           section + "Slip normal",
                           given.slip_normal,
                           !given.slip_where.empty(),
                           "Say where points slip by " + section +
                             "Slip where");
        }
      refuse_unless(given.nitsche_penalty > 0.,
                    section + "Nitsche penalty",
                    given.nitsche_penalty,
                    "a number > 0, in units of E/h",
                    "1e3 is a good choice for the symmetric Nitsche form, 20 "
                    "for the unsymmetric one.");
    }
  } // namespace


  template <int dim>
  void
  check_effects(const Scene &scene)
  {
    check_growth<dim>(scene);
    if (scene.has_proliferation())
      check_cell_cycle<dim>(scene);
    else
      check_cell_cycle_unused(scene);
    check_choices<dim>(scene,
                       scene.catalogue.division_rules,
                       "Proliferation/Cell cycle/",
                       "Proliferation/Cell cycle/Division axis",
                       scene.has_proliferation() ?
                         scene.cell_cycle.division_axis :
                         "none");
    check_boundary_conditions<dim>(scene);
    Expression("Body force/Force density",
               scene.body_force.force_density,
               3,
               dim)
      .check_dimension(dim);
  }


  template void
  check_effects<2>(const Scene &);
  template void
  check_effects<3>(const Scene &);
} // namespace Morula
