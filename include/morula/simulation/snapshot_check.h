// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_snapshot_check_h
#define morula_simulation_snapshot_check_h

#include <morula/scene/scene.h>

#include <string>

namespace Morula
{
  /**
   * Refuses to resume from a snapshot of another scene. Only Time/End time,
   * Time/Step, Time/Stop at cells, and the sections Solver and Output may
   * differ. The directory's name may differ too, since it may have been moved.
   * @param parameters the snapshot's scene, as the text of a .prm file
   * @throws InputError with the key and both values
   */
  void
  check_resumable(const Scene &scene, const std::string &parameters);
} // namespace Morula

#endif
