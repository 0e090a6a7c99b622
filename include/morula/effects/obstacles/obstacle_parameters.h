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

    std::string              name;
    Key<std::string>         shape;
    Key<std::string>         side;
    Key<std::vector<double>> center; // µm
    Key<double>              radius; // µm
    DirectionKey             normal;
    Key<std::vector<double>> size; // µm
    DirectionKey             axis;
    Key<std::string>         surface_mesh;
    Key<double>              stiffness; // κ h / E
    ExpressionKey            velocity;  // µm/day

    using Keys::list;
    KeyList
    list() override;
  };

  /** Section "Obstacles": names first, then a section for each of them. */
  struct ObstaclesParameters : public EffectKeys
  {
    ObstaclesParameters();

    Key<std::string>         names;
    std::deque<ObstacleKeys> obstacles;

    bool
    is_on() const override
    {
      return !obstacles.empty();
    }
    std::string
    details() const override;
    const AnyKey *
    names_key() const override
    {
      return &names;
    }
    void
    declare_sections(const std::string &text) override;
    using Keys::list;
    KeyList
    list() override;
  };
} // namespace Morula

#endif
