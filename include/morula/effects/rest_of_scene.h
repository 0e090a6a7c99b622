// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_rest_of_scene_h
#define morula_effects_rest_of_scene_h

#include <morula/base/key.h>
#include <morula/grid/grid_parameters.h>
#include <morula/mechanics/material.h>

#include <set>
#include <string>
#include <vector>

namespace Morula
{
  class Catalogue;

  /** What a scene says besides the keys of an effect, for what these refuse,
   *  warn of and explain. It refers to the scene. */
  struct RestOfScene
  {
    unsigned int dim;
    /** The keys of all effects: for those that know each other. */
    const Catalogue          &catalogue;
    const MaterialParameters &material;
    const GridParameters     &grid;
    /** Length of a step, day. */
    double step;
    /** Length of a cell, µm. */
    double cell_spacing;
    /** Names of the cells' types by their numbers; empty: all are alike. */
    std::vector<std::string> types;
    /** The law of all cells that grow, or "none". */
    std::string growth_law;
    /** The division axes of all types. */
    std::set<std::string> division_axes;
    bool                  cells_divide;
    /** Whether anything lets the tissue grow, shrink or change its shape. */
    bool is_active;
    /** Whether volumes of cells may differ. */
    bool volumes_differ;
    /** The key that says what surface cells from a file get, and whether it
     *  leaves them without boundary points. */
    const AnyKey &points_surface;
    bool          has_no_surface;
    /** Whether patches that grow long are split. */
    const Key<bool> &refine_surface;
    /** The file of cuts at t = 0; empty: there are none. */
    const Key<std::string> &cuts;
  };
} // namespace Morula

#endif
