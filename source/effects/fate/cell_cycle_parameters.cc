// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/cell_cycle.h>

#include <deal.II/base/patterns.h>

namespace Morula
{
  void
  CellCycleParameters::declare(ParameterHandler  &prm,
                               const std::string &more_axes)
  {
    const std::string where_evaluated =
      " An expression of X, Y, Z (um), evaluated at the founder's initial "
      "position and inherited by all its descendants.";

    prm.add_parameter("Start",
                      start,
                      "State at t = 0: 'waiting': all cells in G0, with "
                      "exponentially distributed waits; 'together': all cells "
                      "enter S at t = 0.",
                      Patterns::Selection("waiting|together"));
    prm.add_parameter("Duration",
                      duration,
                      "T_cycle: total duration of S, G2, M and G1. "
                      "Positive, and at least twice Time/Step." +
                        where_evaluated + " Units: day.");
    prm.add_parameter("G0 exit rate",
                      exit_rate,
                      "Lambda: rate of the exponentially distributed "
                      "wait in G0. Not negative; 0: cells never leave G0." +
                        where_evaluated + " Units: 1/day.");
    prm.add_parameter("Size checkpoint",
                      size_checkpoint,
                      "J_th: a cell enters S only while its elastic volume "
                      "ratio J_e is above this value. Not negative; 0: no "
                      "checkpoint." +
                        where_evaluated);
    prm.add_parameter("Where",
                      where,
                      "Founders for which this is > 0 proliferate." +
                        where_evaluated);
    prm.add_parameter("Division axis",
                      division_axis,
                      "n_s: 'random': uniform on the sphere (2-D: circle), "
                      "drawn at every onset of S; 'fixed': along Fixed axis." +
                        std::string(more_axes.empty() ?
                                      "" :
                                      " Others: by a rule of this program."),
                      Patterns::Selection("random|fixed" + more_axes));
    prm.add_parameter("Fixed axis",
                      fixed_axis,
                      "Direction of n_s for Division axis = fixed, of any "
                      "length but zero. 2-D: the first two components.",
                      Patterns::List(Patterns::Double(), 2, 3));
    prm.add_parameter("Axis follows rotation",
                      axis_follows_rotation,
                      "false: daughters are placed along n_s, as in the paper; "
                      "true: along F_e n_s.");
  }
} // namespace Morula
