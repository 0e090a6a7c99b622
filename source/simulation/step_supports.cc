// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/surface/boundary_terms.h>
#include <morula/mechanics/drag.h>
#include <morula/simulation/step_supports.h>

namespace Morula
{
  template <int dim>
  std::vector<typename RigidModes<dim>::Support>
  step_supports(const TissueModel<dim> &model,
                const Tissue<dim>      &tissue,
                const SplineSpace<dim> &space,
                const double            t,
                const double            t_next)
  {
    // Held points come first, then cells with friction, each with its weight in
    // the matrix S of doc/theory.md (4.9) and section 4.4. Friction holds all
    // directions (M = I). If ζh²/(E Δt) is below the least drag rounding would
    // decide where a free piece goes; it then counts as none. Each rank lists
    // what lies in its own grid cells; RigidModes adds the lists up.
    auto              list = supports(model.boundary_conditions, tissue, space);
    const double      h    = space.box().spacing();
    const Cells<dim> &cells       = tissue.cells();
    const CellReader<dim> &reader = model.development.reader(t);
    for (const auto &named : model.forces)
      {
        const std::vector<double> friction =
          named.effect->friction(tissue, reader, t);
        // The list is empty for a force without friction.
        if (friction.empty())
          continue;
        for (const auto &grid_cell : cells.grid_cells())
          for (unsigned int p = grid_cell.begin; p < grid_cell.end; ++p)
            {
              const double stiffness =
                youngs_modulus(present_cell(tissue, p, reader).lame());
              const double strength =
                friction[p] * h * h / ((t_next - t) * stiffness);
              if (strength >= Drag<dim>::least)
                list.push_back({space.piece(grid_cell.number, grid_cell.part),
                                cells.position(p),
                                Tensor<2, dim>(unit_symmetric_tensor<dim>()),
                                strength * cells.initial_volume(p) / h});
            }
      }
    return list;
  }


  MORULA_INSTANTIATE(step_supports);
} // namespace Morula
