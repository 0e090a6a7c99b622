// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/catalogue.h>
#include <morula/effects/contact/contact.h>
#include <morula/effects/division/axis_rules.h>
#include <morula/effects/division/cell_shape_axis.h>
#include <morula/effects/fate/death.h>
#include <morula/effects/fate/division_by_size.h>
#include <morula/effects/fate/extrusion.h>
#include <morula/effects/fate/proliferation.h>
#include <morula/effects/fields/fields.h>
#include <morula/effects/forces/body_force.h>
#include <morula/effects/forces/friction.h>
#include <morula/effects/forces/type_tension.h>
#include <morula/effects/growth/contraction.h>
#include <morula/effects/growth/isotropic.h>
#include <morula/effects/growth/rate_growth.h>
#include <morula/effects/growth/relaxation.h>
#include <morula/effects/obstacles/obstacles.h>
#include <morula/effects/rearrangement/rearrangement.h>
#include <morula/effects/state/neighbour_columns.h>
#include <morula/effects/state/present_depth.h>
#include <morula/effects/surface/fixed.h>
#include <morula/effects/surface/lumen.h>
#include <morula/effects/surface/pressure.h>
#include <morula/effects/surface/slip.h>
#include <morula/effects/surface/surface_tension.h>
#include <morula/effects/surface/traction.h>
#include <morula/effects/surface/type_surface_tension.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>

namespace Morula
{
  namespace
  {
    /** Adds one of the library's own effects. Its section is empty, as its keys
     *  know their full paths; an effect of a user's program gets a section. */
    template <template <int> class Effect, template <int> class Interface>
    void
    add(Choices<Interface> &choices, const std::string &name)
    {
      choices.push_back(Choice<Interface>::template of<Effect>(name, ""));
    }
  } // namespace


  Catalogue::Catalogue()
  {
    // The order of these lines is the order in which effects of a kind are
    // made, declare their columns and stand in the printed parameters. Growth
    // factors and flows are applied in it as well, so a new effect belongs at
    // the end of its kind.
    add<IsotropicGrowth>(growth_laws, "isotropic");
    add<RateGrowth>(growth_laws, "rate");
    add<Contraction>(growth_factors, "contraction");
    add<Relaxation>(flows, "relaxation");
    add<Proliferation>(fates, "cell cycle");
    add<DivisionBySize>(fates, "division by size");
    add<Death>(fates, "death");
    add<Extrusion>(fates, "extrusion");
    add<Fields>(equations, "fields");
    add<FixedAxis>(division_rules, "fixed");
    add<StretchAxis>(division_rules, "stretch");
    add<StressAxis>(division_rules, "stress");
    add<RadialAxis>(division_rules, "radial");
    add<SurfaceNormalAxis>(division_rules, "surface normal");
    add<TangentialAxis>(division_rules, "tangential");
    add<Rearrangement>(step_effects, "rearrangement");
    add<NeighbourColumns>(step_effects, "neighbours");
    add<PresentDepth>(step_effects, "present depth");
    add<CellShapeAxis>(division_rules, "cell shape");
    add<BodyForce>(forces, "body force");
    add<Friction>(forces, "friction");
    add<TypeTension>(forces, "type tension");
    add<Fixed>(boundary_conditions, "fixed");
    add<Slip>(boundary_conditions, "slip");
    add<Traction>(boundary_conditions, "traction");
    add<Pressure>(boundary_conditions, "pressure");
    add<SurfaceTension>(boundary_conditions, "surface tension");
    add<Lumen>(boundary_conditions, "lumen");
    add<Obstacles>(boundary_conditions, "obstacles");
    add<TypeSurfaceTension>(boundary_conditions, "type surface tension");
    add<Contact>(interactions, "contact");
  }


  void
  Catalogue::declare_types(const std::vector<std::string> &types)
  {
    for_each(*this, [&](auto &choice) { choice.keys().declare_types(types); });
  }


  void
  Catalogue::see_expressions(const std::vector<ExpressionKey *> &keys,
                             const std::vector<std::string>     &types,
                             const std::vector<std::string>     &fields)
  {
    for_each(*this, [&](auto &choice) {
      choice.keys().see_expressions(keys, types, fields);
      choice.keys().see_others(*this);
    });
  }


  std::vector<const EffectKeys *>
  Catalogue::all_keys() const
  {
    std::vector<const EffectKeys *> list;
    for_each(*this,
             [&list](const auto &choice) { list.push_back(&choice.keys()); });
    return list;
  }


  TypeTensions
  Catalogue::tensions() const
  {
    TypeTensions tensions;
    for (const EffectKeys *const keys : all_keys())
      keys->add_tensions(tensions);
    return tensions;
  }


  std::vector<NamedField>
  Catalogue::named_fields() const
  {
    std::vector<NamedField> all;
    for (const EffectKeys *const keys : all_keys())
      for (const NamedField &field : keys->named_fields())
        all.push_back(field);
    return all;
  }


  NeighbourSearch
  Catalogue::neighbour_search() const
  {
    return keys<NeighbourParameters>().search();
  }


  const std::vector<NeighbourVariable> &
  Catalogue::neighbour_variables() const
  {
    return keys<NeighbourParameters>().variables;
  }


  Catalogue
  Catalogue::with_defaults() const
  {
    // The values of keys live in the choices, so a copy that is read into must
    // begin with the defaults. Otherwise a scene would see what the one before
    // it set.
    Catalogue copy(*this);
    for_each(copy, [](auto &choice) { choice.reset(); });
    return copy;
  }


  void
  Catalogue::check_name(const std::string &name)
  {
    // A name is a value in a parameter file and, with a large first letter, the
    // name of a section. So only characters that are safe in both are allowed.
    // Then the name must be free among the effects of all kinds, and must not
    // be one of the words that mean the absence of a rule.
    const bool plain =
      !name.empty() && std::all_of(name.begin(), name.end(), [](const char c) {
        return std::islower(static_cast<unsigned char>(c)) || c == ' ' ||
               c == '-';
      });
    if (!plain || name.front() == ' ' || name.back() == ' ')
      throw std::invalid_argument("'" + name +
                                  "' cannot name an effect: small letters, "
                                  "blanks and '-' may.");
    bool in_use = name == "none" || name == "random";
    for_each(*this, [&](const auto &choice) {
      in_use = in_use || choice.name() == name;
    });
    if (in_use)
      throw std::invalid_argument("There is an effect '" + name + "' already.");
  }


  std::string
  Catalogue::section(const std::string &around, std::string name)
  {
    name[0] = std::toupper(static_cast<unsigned char>(name[0]));
    return around + name;
  }
} // namespace Morula
