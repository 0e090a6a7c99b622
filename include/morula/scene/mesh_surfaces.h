// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_mesh_surfaces_h
#define morula_scene_mesh_surfaces_h

#include <morula/base/surface_mesh.h>

#include <string>
#include <vector>

namespace Morula
{
  /**
   * The volumes within the closed surfaces that a mesh consists of, µm^3, in
   * the order of their first triangles; negative: the surface is the wall of a
   * cavity, as it stands inside another one.
   */
  std::vector<double>
  volumes_of_surfaces(const std::vector<SurfaceTriangle> &triangles);

  /** E.g. "2 closed surfaces, 1 of them the wall of a cavity of 4188 um^3". */
  std::string
  surfaces_text(const std::vector<double> &volumes);
} // namespace Morula

#endif
