// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/name_list.h>
#include <morula/effects/obstacles/obstacle_parameters.h>

#include <algorithm>
#include <cctype>

namespace Morula
{
  namespace
  {
    /** Why a section cannot have this name; empty if it can. */
    std::string
    reason_against_obstacle(const std::string &name)
    {
      const bool plain =
        !name.empty() &&
        std::all_of(name.begin(), name.end(), [](const char c) {
          return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
        });
      return plain ? "" : "Names have letters, digits and '_'.";
    }

    std::string
    obstacle_path(const std::string &name, const std::string &key)
    {
      return "Obstacles/" + name + "/" + key;
    }
  } // namespace


  ObstacleKeys::ObstacleKeys(const std::string &name)
    : name(name)
    , shape(obstacle_path(name, "Shape"),
            "",
            "plane, sphere (2-D: a disc), cylinder (without ends) or box (its "
            "edges along the axes).",
            {"|plane|sphere|cylinder|box"})
    , side(obstacle_path(name, "Side"),
           "outside",
           "outside: the tissue is outside of the body, in front of the plane; "
           "inside: the tissue is inside, as in a mould.",
           {"outside|inside"})
    , center(
        obstacle_path(name, "Center"),
        {0., 0., 0.},
        "Center of the body, or a point of the plane, at t = 0. Units: um.")
    , radius(obstacle_path(name, "Radius"),
             0.,
             "Of a sphere or cylinder; > 0. Units: um.")
    , normal(obstacle_path(name, "Normal"),
             "",
             "Of a plane; it points to the tissue if Side = outside.")
    , size(obstacle_path(name, "Size"),
           {},
           "Full edge lengths of a box. Units: um.")
    , axis(obstacle_path(name, "Axis"), "", "Of a cylinder.")
    , stiffness(obstacle_path(name, "Stiffness"),
                100.,
                "Pressure on the tissue over its depth in the obstacle; > 0. E "
                "is that of the stiffest cell. Units: E/h.")
    , velocity(obstacle_path(name, "Velocity"),
               "0; 0; 0",
               "Velocity of the obstacle: functions of t separated by ';'. "
               "Units: um/day.",
               Evaluated::place,
               3)
  {
    stiffness.require([](const double value) { return value > 0.; },
                      "a value > 0, in units of E/h",
                      "100 lets tissue under the pressure E go in by h/100.");
  }


  KeyList
  ObstacleKeys::list()
  {
    return {&shape,
            &side,
            &center,
            &radius,
            &normal,
            &size,
            &axis,
            &stiffness,
            &velocity};
  }


  ObstaclesParameters::ObstaclesParameters()
    : names("Obstacles/Names",
            "",
            "Rigid bodies that the surface of the tissue cannot enter, "
            "separated by commas. Each has a section of this name. Empty: "
            "none.")
  {}


  bool
  ObstaclesParameters::is_on() const
  {
    return !obstacles.empty();
  }


  std::string
  ObstaclesParameters::details() const
  {
    std::string text;
    for (const ObstacleKeys &obstacle : obstacles)
      text += "; " + obstacle.name + ": " + obstacle.shape.value() +
              ", tissue " + obstacle.side.value();
    return text;
  }


  const AnyKey *
  ObstaclesParameters::names_key() const
  {
    return &names;
  }


  void
  ObstaclesParameters::declare_sections(const std::string &text)
  {
    for (const std::string &name :
         declared_names(names, text, reason_against_obstacle))
      obstacles.emplace_back(name);
  }


  KeyList
  ObstaclesParameters::list()
  {
    KeyList list{&names};
    for (ObstacleKeys &obstacle : obstacles)
      for (AnyKey *key : obstacle.list())
        list.push_back(key);
    return list;
  }
} // namespace Morula
