// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_redistribution_rule_h
#define morula_scene_redistribution_rule_h

#include <morula/scene/scene.h>

namespace Morula
{
  /** Which laws keep places and volumes of cells together: doc/theory.md,
   *  section 6.11. */
  struct Redistribution
  {
    /** Cells that come too near to each other move apart. */
    bool places = false;
    /** Volumes follow the space that cells have. */
    bool volumes = false;
    /** All tissue flows, not only that which relaxes. */
    bool all_flows = false;
  };

  /** What Tissue/Redistribution means in a scene. */
  Redistribution
  redistribution_of(const Scene &scene);
} // namespace Morula

#endif
