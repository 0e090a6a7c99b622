// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/program/explain_parts.h>

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
      const bool grows = scene.has_growth() || scene.grows_by_fate();
      for (const EffectKeys *const keys : scene.keys_in_use())
        if (grows && !keys->lets_buckle().empty())
          text << "    tissue grows " << keys->lets_buckle() << '\n';
      if (grows && !scene.material.youngs_modulus.expression(scene.dimension)
                      .is_constant())
        text << "    tissue grows whose stiffness is not the same everywhere\n";
      return text.str();
    }

    /** What resists the motion of the tissue, and so decides the fold. */
    std::string
    resistance(const Scene &scene)
    {
      const RestOfScene rest = scene.rest_of_scene();
      std::string       all;
      for (const EffectKeys *const keys : scene.keys_in_use())
        if (const std::string one = keys->resistance(rest); !one.empty())
          all += (all.empty() ? "" : "; ") + one;
      return !all.empty() ? all :
                            "none: which fold is found is up to the grid; scan "
                            "Friction/Coefficient (doc/modelling.md, Folds)";
    }
  } // namespace


  void
  print_folds(std::ostream                    &out,
              const Scene                     &scene,
              const std::optional<FreeGrowth> &growth)
  {
    // First comes what may buckle, then keys that unequal growth asks for.
    // Either may be missing, and without both nothing is printed. Cells that
    // grow by a fate grow unequally because each has its own clock.
    const std::string what   = buckling(scene, growth);
    const bool        uneven = scene.grows_by_fate() ||
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
          << what << "  friction: " << resistance(scene) << '\n';
    if (!advice.empty())
      out << "  cells grow unequally; consider\n" << advice;
  }
} // namespace Morula
