// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/cell_cycle.h>
#include <morula/effects/scene_keys.h>

#include <algorithm>

namespace Morula
{
  bool
  CellCycleParameters::is_on() const
  {
    return law != "none" || is_law_of_types;
  }


  std::string
  CellCycleParameters::details() const
  {
    return "cell cycle, T = " + duration.text() +
           " day, Lambda = " + exit_rate.text() + " /day" +
           (size_checkpoint.is_default() ?
              "" :
              ", size checkpoint J_th = " + size_checkpoint.text());
  }


  void
  CellCycleParameters::see(const SceneKeys &scene,
                           const std::vector<ExpressionKey *> &)
  {
    // Cells of a type that does not proliferate stay in G0: their rate of
    // leaving it is set to 0, so that one cell cycle serves all types.
    const auto &types = scene.cell_types.types;
    is_law_of_types =
      std::any_of(types.begin(), types.end(), [](const CellTypeKeys &type) {
        return !type.proliferation_law->empty() &&
               type.proliferation_law != "none";
      });
    if (!is_on())
      return;
    for (unsigned int i = 0; i < types.size(); ++i)
      {
        const Key<std::string> &own     = types[i].proliferation_law;
        const Key<std::string> &of_type = own->empty() ? law : own;
        if (of_type == "none")
          exit_rate.set_for_type(i, of_type.path(), "0");
      }
  }
} // namespace Morula
