// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_grid_parameters_h
#define morula_grid_grid_parameters_h

#include <morula/base/key.h>

namespace Morula
{
  /** Section "Grid": the background grid. */
  struct GridParameters : public Keys
  {
    GridParameters();

    Key<double>              spacing;
    Key<std::vector<double>> offset;
    Key<double>              occupation_parameter;
    Key<bool>                extension;
    Key<unsigned int>        points_per_cell;

    using Keys::list;
    KeyList
    list() override
    {
      return {
        &spacing, &offset, &occupation_parameter, &extension, &points_per_cell};
    }
  };
} // namespace Morula

#endif
