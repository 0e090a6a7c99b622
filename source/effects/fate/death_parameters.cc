// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/death.h>
#include <morula/effects/rest_of_scene.h>

namespace Morula
{
  DeathParameters::DeathParameters()
    : rate("Death/Rate",
           "0",
           "Rate at which cells die, an expression of their state; not "
           "negative. Units: 1/day.",
           Evaluated::step)
    , when("Death/When",
           "0",
           "Cells for which this is > 0 at the beginning of a step die then, "
           "those with Shrinking time = 0 at the end of one: an expression of "
           "their state. E.g. abs(X) < 20 && t >= 1, for a cut.",
           Evaluated::step)
    , shrinking_time(
        "Death/Shrinking time",
        "0.36",
        "How long a dead cell shrinks, linearly in its volume, until it is "
        "removed; not negative. 0: it is removed at once, as in a cut. An "
        "expression of the cell's state. Units: day.",
        Evaluated::event)
    , final_volume(
        "Death/Final volume",
        "0.05",
        "Part of its volume at death that a cell has when it is removed; > 0 "
        "and at most 1. An expression of the cell's state.",
        Evaluated::event)
    , keep_debris("Death/Keep debris",
                  "false",
                  "Where this is true, dead cells stay at their final volume. "
                  "false, true, or an expression of the cell's state, which is "
                  "true if it is > 0.",
                  Evaluated::event)
  {
    // Rate and condition are evaluated in each step; all others once, at the
    // death of a cell. A final volume of zero is refused, as F_g would be
    // singular.
    rate.not_negative("1/day", "0 lets cells live.");
    shrinking_time.not_negative("day", "0 removes cells at once.");
    final_volume.require(
      [](const double part) { return part > 0. && part <= 1.; },
      "a number > 0 and at most 1",
      "It is the part of the cell's volume that is left.");
  }


  bool
  DeathParameters::is_on() const
  {
    // Death has two switches: a rate or a condition that may ever hold.
    return !(rate.expression(3).is_always(0.) &&
             when.expression(3).is_always(0.));
  }


  const AnyKey *
  DeathParameters::switch_key() const
  {
    return &rate;
  }


  void
  DeathParameters::check_with(const RestOfScene &scene) const
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


  KeyList
  DeathParameters::list()
  {
    return {&rate, &when, &shrinking_time, &final_volume, &keep_debris};
  }
} // namespace Morula
