// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/catalogue.h>
#include <morula/effects/fate/cell_cycle.h>
#include <morula/effects/rest_of_scene.h>

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
  CellCycleParameters::take_laws_of_types(
    const std::vector<const Key<std::string> *> &laws)
  {
    // Cells of a type that does not proliferate stay in G0: their rate of
    // leaving it is set to 0, so that one cell cycle serves all types.
    is_law_of_types =
      std::any_of(laws.begin(), laws.end(), [](const Key<std::string> *own) {
        return !own->value().empty() && *own != "none";
      });
    if (!is_on())
      return;
    for (unsigned int i = 0; i < laws.size(); ++i)
      {
        const Key<std::string> &of_type =
          laws[i]->value().empty() ? law : *laws[i];
        if (of_type == "none")
          exit_rate.set_for_type(i, of_type.path(), "0");
      }
  }
} // namespace Morula
