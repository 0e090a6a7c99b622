// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/catalogue.h>
#include <morula/effects/division/axis_rules.h>
#include <morula/effects/fate/death.h>
#include <morula/effects/forces/body_force.h>
#include <morula/effects/forces/friction.h>
#include <morula/effects/growth/contraction.h>
#include <morula/effects/growth/isotropic.h>
#include <morula/effects/growth/rate_growth.h>
#include <morula/effects/growth/relaxation.h>
#include <morula/effects/obstacles/obstacles.h>
#include <morula/effects/surface/fixed.h>
#include <morula/effects/surface/lumen.h>
#include <morula/effects/surface/pressure.h>
#include <morula/effects/surface/slip.h>
#include <morula/effects/surface/surface_tension.h>
#include <morula/effects/surface/traction.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>

namespace Morula
{
  namespace
  {
    /** Adds one of the library's own, whose keys know their full paths. */
    template <template <int> class Effect, template <int> class Interface>
    void
    add(Choices<Interface> &choices, const std::string &name)
    {
      choices.push_back(Choice<Interface>::template of<Effect>(name, ""));
    }
  } // namespace


  Catalogue::Catalogue()
  {
    add<IsotropicGrowth>(growth_laws, "isotropic");
    add<RateGrowth>(growth_laws, "rate");
    add<Contraction>(growth_factors, "contraction");
    add<Relaxation>(flows, "relaxation");
    add<Death>(fates, "death");
    add<FixedAxis>(division_rules, "fixed");
    add<StretchAxis>(division_rules, "stretch");
    add<StressAxis>(division_rules, "stress");
    add<RadialAxis>(division_rules, "radial");
    add<SurfaceNormalAxis>(division_rules, "surface normal");
    add<TangentialAxis>(division_rules, "tangential");
    add<BodyForce>(forces, "body force");
    add<Friction>(forces, "friction");
    add<Fixed>(boundary_conditions, "fixed");
    add<Slip>(boundary_conditions, "slip");
    add<Traction>(boundary_conditions, "traction");
    add<Pressure>(boundary_conditions, "pressure");
    add<SurfaceTension>(boundary_conditions, "surface tension");
    add<Lumen>(boundary_conditions, "lumen");
    add<Obstacles>(boundary_conditions, "obstacles");
  }


  Catalogue
  Catalogue::with_defaults() const
  {
    Catalogue copy(*this);
    copy.for_each([](auto &choice) { choice.reset(); });
    return copy;
  }


  void
  Catalogue::check_name(const std::string &name)
  {
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
    for_each(
      [&](const auto &choice) { in_use = in_use || choice.name() == name; });
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
