// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_obstacles_obstacle_parameters_h
#define morula_effects_obstacles_obstacle_parameters_h

#include <morula/base/expression_key.h>
#include <morula/base/unit_vector.h>
#include <morula/effects/effect.h>

#include <deque>
#include <string>
#include <vector>

namespace Morula
{
  /** Section "Obstacles/NAME". */
  struct ObstacleKeys : public Keys
  {
    /** @param name of the obstacle */
    explicit ObstacleKeys(const std::string &name);

    std::string      name;
    Key<std::string> shape{
      {this, "Shape"},
      "",
      "plane, sphere (2-D: a disc), cylinder (without ends), box (its "
      "edges along the axes) or mesh.",
      {"|plane|sphere|cylinder|box|mesh"}};

    Key<std::string> side{
      {this, "Side"},
      "outside",
      "outside: the tissue is outside of the body, in front of the plane; "
      "inside: the tissue is inside, as in a mould.",
      {"outside|inside"}};

    Key<std::vector<double>> center{
      {this, "Center"},
      {0., 0., 0.},
      "Center of the body, a point of the plane, or where the origin of the "
      "mesh's file is, at t = 0. Units: um."};

    Key<double> radius{{this, "Radius"},
                       0.,
                       "Of a sphere or cylinder; > 0. Units: um."};

    DirectionKey normal{
      {this, "Normal"},
      "",
      "Of a plane; it points to the tissue if Side = outside."};

    Key<std::vector<double>> size{{this, "Size"},
                                  {},
                                  "Full edge lengths of a box. Units: um."};

    DirectionKey axis{{this, "Axis"}, "", "Of a cylinder."};

    Key<std::string> surface_mesh{
      {this, "Surface mesh"},
      "",
      "Of a mesh: closed surface in um, as an STL, OFF, PLY or "
      "OBJ file."};

    Key<double> stiffness{
      {this, "Stiffness"},
      100.,
      "Pressure on the tissue over its depth in the obstacle; > 0. E "
      "is that of the stiffest cell. Units: E/h.",
      {},
      positive("E/h", "100 lets tissue under the pressure E go in by h/100.")};

    ExpressionKey velocity{
      {this, "Velocity"},
      "0; 0; 0",
      "Velocity of the obstacle: functions of t separated by ';'. "
      "Units: um/day.",
      Evaluated::place,
      3};
  };

  /** Section "Obstacles": names first, then a section for each of them. */
  struct ObstaclesParameters : public EffectKeys
  {
    Key<std::string> names{
      {this, "Obstacles/Names"},
      "",
      "Rigid bodies that the surface of the tissue cannot enter, "
      "separated by commas. Each has a section of this name. Empty: "
      "none."};
    std::deque<ObstacleKeys> obstacles;

    bool
    is_on() const override
    {
      return !obstacles.empty();
    }
    std::string
    details() const override;
    EffectFacts
    facts() const override
    {
      EffectFacts facts;
      facts.names_key = &names;
      return facts;
    }
    void
    declare_sections(const std::string              &text,
                     const std::vector<std::string> &types) override;
    using Keys::list;
    KeyList
    list() override;
  };
} // namespace Morula

#endif
