// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_effects_check_h
#define morula_scene_effects_check_h

#include <morula/scene/scene.h>

namespace Morula
{
  /**
   * The part of Scene::check() about growth, proliferation, boundary
   * conditions and body force: expressions parse, numbers are in range,
   * directions exist, and no value belongs to an effect that is not switched
   * on.
   * @throws InputError
   */
  template <int dim>
  void
  check_effects(const Scene &scene);
} // namespace Morula

#endif
