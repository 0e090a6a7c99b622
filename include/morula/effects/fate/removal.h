// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fate_removal_h
#define morula_effects_fate_removal_h

#include <morula/effects/development.h>
#include <morula/particles/cell_event.h>
#include <morula/particles/tissue.h>

#include <vector>

namespace Morula
{
  /**
   * Removes the dead cells that are due at or before @p t (day) from the
   * tissue, and the boundary points that then have no cell within reach. The
   * remaining volume of shrunken cells goes to the cells in their grid cells:
   * doc/theory.md, section 6.9. Only with death. Collective.
   * @param carried columns of amounts per volume, which these cells take over,
   *        too
   * @return the removals of this rank
   */
  template <int dim>
  std::vector<CellEvent>
  remove_dead_cells(Tissue<dim>                       &tissue,
                    const CellDevelopment<dim>        &development,
                    const double                       t,
                    const std::vector<Column<double>> &carried = {});

  /**
   * Carves the tissue at t = 0: takes out the cells that Death/When kills then
   * and that go at once, and the boundary points whose nearest cell is one of
   * them. Only with death. Collective.
   * @return the deaths and removals of this rank
   * @throws InputError on all ranks
   */
  template <int dim>
  std::vector<CellEvent>
  carve(Tissue<dim> &tissue, const CellDevelopment<dim> &development);
} // namespace Morula

#endif
