// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_condition_watch_h
#define morula_simulation_condition_watch_h

#include <morula/base/announce.h>
#include <morula/particles/tissue.h>
#include <morula/scene/tissue_model.h>

#include <cstdint>
#include <map>
#include <string>

namespace Morula
{
  /** Tells the user when a condition on the surface, of the tissue or of a
   *  field, has lost its last point, as the cells there are gone: what it held,
   *  loaded or fed goes on without it. */
  template <int dim>
  class ConditionWatch
  {
  public:
    /** @param model of the run; it must stay */
    ConditionWatch(const TissueModel<dim> &model, const Announce &announce);

    /** Counts the points of each condition, before cells are removed for the
     *  first time. Collective. */
    void
    begin(const Tissue<dim> &tissue);

    /** Counts them anew after boundary points have gone with their cells, at
     *  @p t (day). Collective. */
    void
    look(const Tissue<dim> &tissue, const double t);

  private:
    /** How many points each condition acts on. Collective. */
    std::map<std::string, std::uint64_t>
    count(const Tissue<dim> &tissue) const;

    const TissueModel<dim>              &model;
    const Announce                       announce;
    std::map<std::string, std::uint64_t> before;
    bool                                 has_begun = false;
  };
} // namespace Morula

#endif
