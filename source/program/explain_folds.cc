// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/forces/friction.h>
#include <morula/effects/surface/lumen.h>
#include <morula/program/explain_folds.h>

#include <deal.II/base/numbers.h>

#include <cmath>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** Founders whose free growth differs by more than this factor of volume
     *  grow unequally: a layer that is longer by a seventh than the one below
     * it buckles on most of them. */
    constexpr double unequal = 1.5;

    /** What may buckle; empty if nothing does. */
    std::string
    buckling(const Scene &scene, const std::optional<FreeGrowth> &growth)
    {
      // A tissue folds where parts of it are held shorter than they would grow:
      // by neighbours that grow less, by a lumen that does not yield, or by
      // stiffer tissue. Each cause has a line.
      std::ostringstream text;
      if (growth && growth->most > unequal * growth->least)
        text << "    founders grow unequally: by factors of " << growth->least
             << " to " << growth->most << " in volume until End time\n";
      const bool  grows = scene.has_growth() || scene.has_proliferation();
      const auto &lumen = scene.keys<LumenParameters>();
      if (grows && lumen.is_on() && !lumen.volume.empty())
        text << "    tissue grows around a lumen whose volume is given\n";
      if (grows && !scene.material.youngs_modulus.expression(scene.dimension)
                      .is_constant())
        text << "    tissue grows whose stiffness is not the same everywhere\n";
      return text.str();
    }

    std::string
    meaning_of_friction(const Scene &scene)
    {
      const auto &friction = scene.keys<FrictionParameters>();
      if (!friction.is_on())
        return "none: which fold is found is up to the grid; scan "
               "Friction/Coefficient (doc/modelling.md, Folds)";
      const std::optional<double> value =
        friction.coefficient.largest_number(scene.dimension);
      if (!value)
        return friction.coefficient.text() + " kPa day/um^2";
      std::ostringstream text;
      text << *value << " kPa day/um^2, as cells of "
           << scene.tissue.cell_spacing
           << " um feel it one by one in a medium of "
           << viscosity_of_medium(*value, scene.tissue.cell_spacing) << " Pa s";
      return text.str();
    }
  } // namespace


  double
  viscosity_of_medium(const double friction, const double length)
  {
    // Stokes' force 6 π η R v on a sphere equals ζ V v with V = 4 π R³/3, hence
    // η = 2 ζ R²/9. R is that of the sphere with the volume of the cube.
    constexpr double pascal_seconds = 1e3 * 86400.; // in a kPa day
    const double     radius_squared =
      std::pow(3. / (4. * numbers::PI), 2. / 3.) * length * length;
    return 2. / 9. * friction * radius_squared * pascal_seconds;
  }


  void
  print_folds(std::ostream                    &out,
              const Scene                     &scene,
              const std::optional<FreeGrowth> &growth)
  {
    // First comes what may buckle, then keys that unequal growth asks for.
    // Either may be missing, and without both nothing is printed. Cells that
    // proliferate grow unequally because each has its own phase of the cycle.
    const std::string what   = buckling(scene, growth);
    const bool        uneven = scene.has_proliferation() ||
                        (growth && growth->most > unequal * growth->least);
    std::string advice;
    if (uneven &&
        scene.material.volumetric_form() == VolumetricStrain::pointwise)
      advice +=
        "    Material/Volumetric strain = pooled: otherwise the volumes "
        "of cells that share a grid cell need not match\n";
    if (uneven && scene.material.energy_per == "initial volume")
      advice += "    Material/Energy per = grown volume: otherwise tissue gets "
                "softer as it grows\n";
    if (what.empty() && advice.empty())
      return;
    out << "Folds\n";
    if (!what.empty())
      out << "  may buckle, as\n"
          << what << "  friction: " << meaning_of_friction(scene) << '\n';
    if (!advice.empty())
      out << "  cells grow unequally; consider\n" << advice;
  }
} // namespace Morula
