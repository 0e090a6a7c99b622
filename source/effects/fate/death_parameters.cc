// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/death.h>
#include <morula/effects/scene_keys.h>

namespace Morula
{
  bool
  DeathParameters::is_on() const
  {
    // Death has two switches: a rate or a condition that may ever hold.
    return !(rate.expression(3).is_always(0.) &&
             when.expression(3).is_always(0.));
  }


  void
  DeathParameters::check(const SceneKeys &scene, Review &) const
  {
    // Cells that go at once are never part of the balance of momentum as dead
    // ones, so they may have any weight. A cell that shrinks needs a weight
    // that shrinks with it.
    const bool shrink =
      !shrinking_time.expression(3).is_always(0.) || keep_debris.is_changed();
    if (is_on() && shrink && !scene.material.per_grown_volume())
      scene.material.energy_per.refuse(
        "grown volume, as cells die (" + rate.path() + " or " + when.path() +
          ") and shrink",
        "A shrunken cell would pull with the stiffness of a whole one. Cells "
        "may also go at once: " +
          shrinking_time.path() + " = 0.");
  }


  std::string
  DeathParameters::details() const
  {
    // The text is what --explain says of death.
    return "rate = " + rate.text() + " /day, when = " + when.text() +
           ", shrinking time = " + shrinking_time.text() + " day";
  }
} // namespace Morula
