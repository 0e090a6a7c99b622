// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_rearrangement_review_h
#define morula_scene_rearrangement_review_h

#include <morula/base/review.h>
#include <morula/scene/scene.h>

#include <string>

namespace Morula
{
  /** Refuses what exchanges of places cannot be combined with.
   *  @throws InputError */
  void
  check_rearrangement(const Scene &scene);

  /** Warns of exchanges that come too often, or that no stress follows. */
  void
  review_rearrangement(const Scene &scene, Review &review);

  /** What --explain says of the scene's exchanges, a line each; empty if there
   *  are none. */
  std::string
  rearrangement_lines(const Scene &scene);
} // namespace Morula

#endif
