// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/name_list.h>
#include <morula/effects/obstacles/obstacle_parameters.h>

namespace Morula
{
  ObstacleKeys::ObstacleKeys(const std::string &name)
    : name(name)
  {
    place_in(list(), "Obstacles/" + name);
    surface_mesh.of_file();
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


  void
  ObstaclesParameters::declare_sections(const std::string &text,
                                        const std::vector<std::string> &)
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
