// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_state_neighbour_columns_h
#define morula_effects_state_neighbour_columns_h

#include <morula/base/expression_key.h>
#include <morula/effects/effect.h>
#include <morula/particles/neighbours.h>

#include <algorithm>
#include <string>
#include <vector>

namespace Morula
{
  /** Section "Neighbours". */
  struct NeighbourParameters : public EffectKeys
  {
    Key<std::string> found_by{
      {this, "Neighbours/Found by"},
      "facets",
      "Which cells are neighbours: facets: those whose Voronoi cells "
      "touch; radius: those that are near, in 3-D much cheaper, but "
      "shares of the surface are estimates then.",
      {"facets|radius"}};

    Key<double> reach{
      {this, "Neighbours/Reach"},
      1.8,
      "Distance of the farthest neighbour across a gap: beyond it no free "
      "surface may lie between. With Found by = radius that of any, 1.5 "
      "unless it is set. At most 2.5. Units: mean cell spacings.",
      {},
      {[](const double value) { return value > 0. && value <= 2.5; },
       "a value > 0, at most 2.5",
       "Cells that far apart do not touch."}};

    /** What the scene's expressions say of neighbours. */
    std::vector<NeighbourVariable> variables;

    /** How they are found. */
    NeighbourSearch
    search() const;

    bool
    is_on() const override
    {
      return std::any_of(variables.begin(),
                         variables.end(),
                         [](const NeighbourVariable &told) {
                           return told.kind != NeighbourVariable::slope;
                         });
    }

    std::string
    details() const override;
    /**
     * Looks for names of such variables in the texts of keys, and lets the keys
     * use them besides the fields.
     * @param keys of cells
     * @throws InputError for one that does not exist, or stands in a key on
     *         which the stress depends
     */
    void
    see(const SceneKeys                    &scene,
        const std::vector<ExpressionKey *> &keys) override;
  };
} // namespace Morula

#endif
