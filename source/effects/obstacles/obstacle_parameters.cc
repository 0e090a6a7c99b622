// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/name_list.h>
#include <morula/effects/obstacles/obstacle_parameters.h>

namespace Morula
{
  ObstacleKeys::ObstacleKeys(const std::string &name)
    : name(name)
    , shape("Shape",
            "",
            "plane, sphere (2-D: a disc), cylinder (without ends), box (its "
            "edges along the axes) or mesh.",
            {"|plane|sphere|cylinder|box|mesh"})
    , side("Side",
           "outside",
           "outside: the tissue is outside of the body, in front of the plane; "
           "inside: the tissue is inside, as in a mould.",
           {"outside|inside"})
    , center(
        "Center",
        {0., 0., 0.},
        "Center of the body, a point of the plane, or where the origin of the "
        "mesh's file is, at t = 0. Units: um.")
    , radius("Radius", 0., "Of a sphere or cylinder; > 0. Units: um.")
    , normal("Normal",
             "",
             "Of a plane; it points to the tissue if Side = outside.")
    , size("Size", {}, "Full edge lengths of a box. Units: um.")
    , axis("Axis", "", "Of a cylinder.")
    , surface_mesh("Surface mesh",
                   "",
                   "Of a mesh: closed surface in um, as an STL, OFF, PLY or "
                   "OBJ file.")
    , stiffness("Stiffness",
                100.,
                "Pressure on the tissue over its depth in the obstacle; > 0. E "
                "is that of the stiffest cell. Units: E/h.")
    , velocity("Velocity",
               "0; 0; 0",
               "Velocity of the obstacle: functions of t separated by ';'. "
               "Units: um/day.",
               Evaluated::place,
               3)
  {
    place_in(list(), "Obstacles/" + name);
    surface_mesh.of_file();
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
            &surface_mesh,
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


  std::string
  ObstaclesParameters::details() const
  {
    std::string text;
    for (const ObstacleKeys &obstacle : obstacles)
      text += "; " + obstacle.name + ": " + obstacle.shape.value() +
              ", tissue " + obstacle.side.value();
    return text;
  }


  void
  ObstaclesParameters::declare_sections(const std::string &text)
  {
    for (const std::string &name :
         declared_names(names, text, reason_against_section))
      obstacles.emplace_back(name);
  }


  KeyList
  ObstaclesParameters::list()
  {
    return keys_of_all(names, obstacles);
  }
} // namespace Morula
