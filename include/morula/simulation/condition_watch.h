// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_condition_watch_h
#define morula_simulation_condition_watch_h

#include <morula/output/forces.h>
#include <morula/simulation/announce.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace Morula
{
  /** Tells the user when a condition on the surface has lost its last point, as
   *  the cells there are gone: what it held or loaded goes on without it. */
  class ConditionWatch
  {
  public:
    explicit ConditionWatch(const Announce &announce);

    /** Looks at the rows of a step that ends at @p t (day). They are equal on
     *  all ranks. */
    void
    look(const std::vector<ForceRow> &rows, const double t);

  private:
    const Announce announce;
    /** How many points each condition acted on in the last step. */
    std::map<std::string, std::uint64_t> before;
  };
} // namespace Morula

#endif
