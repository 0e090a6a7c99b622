// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fate_left_amounts_h
#define morula_effects_fate_left_amounts_h

#include <morula/particles/tissue.h>

#include <vector>

namespace Morula
{
  /** What a cell carries that goes without another one in its grid cell. */
  template <int dim>
  struct LeftAmounts
  {
    /** Where it is, µm. */
    Point<dim> position;
    /** Of the fields, times µm^dim. */
    std::vector<double> amounts;
  };

  /**
   * Gives what these cells of this rank leave to the nearest cells that stay,
   * of whichever rank: doc/theory.md (6.9d). Collective.
   * @param gone    numbers of this rank's cells that go, sorted
   * @param carried the columns of the fields
   */
  template <int dim>
  void
  give_to_nearest(Tissue<dim>                         &tissue,
                  const std::vector<unsigned int>     &gone,
                  const std::vector<Column<double>>   &carried,
                  const std::vector<LeftAmounts<dim>> &left);
} // namespace Morula

#endif
