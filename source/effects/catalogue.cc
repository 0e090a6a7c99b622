// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/catalogue.h>
#include <morula/effects/forces/type_tension.h>

#include <algorithm>
#include <stdexcept>

namespace Morula
{
  // Each of these adds the effect of the library that its name says: keys,
  // effect and example stand together in the file of that name.
  using Addition = void(Catalogue &);
  Addition add_isotropic_growth, add_rate_growth, add_contraction,
    add_relaxation, add_cell_cycle, add_division_by_size, add_division_at_rate,
    add_death, add_extrusion, add_fields, add_division_rules, add_rearrangement,
    add_cell_numbers, add_neighbours, add_present_depth, add_shape_numbers,
    add_body_force, add_friction, add_type_tension, add_fixed, add_slip,
    add_traction, add_pressure, add_surface_tension, add_lumen, add_obstacles,
    add_type_surface_tension, add_contact;


  Catalogue::Catalogue()
  {
    // The order of these lines is the order in which effects of a kind are
    // made, declare their columns and stand in the printed parameters. Growth
    // factors and flows are applied in it as well, so a new effect belongs at
    // the end of its kind.
    add_isotropic_growth(*this);
    add_rate_growth(*this);
    add_contraction(*this);
    add_relaxation(*this);
    add_cell_cycle(*this);
    add_division_by_size(*this);
    add_division_at_rate(*this);
    add_death(*this);
    add_extrusion(*this);
    add_fields(*this);
    add_division_rules(*this);
    add_rearrangement(*this);
    add_cell_numbers(*this);
    add_neighbours(*this);
    add_present_depth(*this);
    add_shape_numbers(*this);
    add_body_force(*this);
    add_friction(*this);
    add_type_tension(*this);
    add_fixed(*this);
    add_slip(*this);
    add_traction(*this);
    add_pressure(*this);
    add_surface_tension(*this);
    add_lumen(*this);
    add_obstacles(*this);
    add_type_surface_tension(*this);
    add_contact(*this);
  }


  TypeTensions
  Catalogue::tensions() const
  {
    const auto &with_surface = keys<TypeSurfaceTensionParameters>().tensions;
    return {keys<TypeTensionParameters>().matrix(),
            {with_surface.begin(), with_surface.end()}};
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


} // namespace Morula
