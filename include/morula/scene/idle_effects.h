// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_idle_effects_h
#define morula_scene_idle_effects_h

#include <morula/base/review.h>
#include <morula/scene/scene.h>

namespace Morula
{
  /** Warns of values that the scene sets and nothing reads, as the keys alone
   *  tell: of effects that it switches off, and of keys that only some scenes
   *  read. Values of an effect whose switch it does not set are refused. */
  void
  review_idle_effects(const Scene &scene, Review &review);
} // namespace Morula

#endif
