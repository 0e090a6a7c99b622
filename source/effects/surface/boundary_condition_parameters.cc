// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/surface/boundary_conditions.h>

#include <deal.II/base/patterns.h>

namespace Morula
{
  void
  BoundaryConditionParameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter("Fixed where",
                      fixed_where,
                      "Expression of X, Y, Z (initial position on the surface, "
                      "um): points where it is > 0 are fixed, e.g. Z <= 0; "
                      "empty: nowhere. Fixed wins over slip.");
    prm.add_parameter("Displacement",
                      displacement,
                      "Displacement of the fixed points: functions of "
                      "X, Y, Z, t separated by ';'. Units: um.");
    prm.add_parameter(
      "Slip where",
      slip_where,
      "Expression of X, Y, Z: the displacement along the normal "
      "is zero where it is > 0; empty: nowhere. Slip wins over "
      "traction.");
    prm.add_parameter("Slip normal",
                      slip_normal,
                      "Direction, e.g. 0, 0, 1: only points whose initial "
                      "normal N is along it, |N.normal| > 0.9, slip; empty: "
                      "all, each along its own normal.");
    prm.add_parameter("Traction where",
                      traction_where,
                      "Expression of X, Y, Z: traction acts where it is > 0; "
                      "empty: nowhere.");
    prm.add_parameter("Traction",
                      traction,
                      "Traction per initial area (dead load): functions of "
                      "X, Y, Z, t separated by ';'. Units: kPa.");
    prm.add_parameter("Pressure where",
                      pressure_where,
                      "Expression of X, Y, Z: pressure acts where it is > 0; "
                      "empty: nowhere.");
    prm.add_parameter("Pressure",
                      pressure,
                      "Pressure that follows the surface, a function of "
                      "X, Y, Z, t; positive pushes inward. Units: kPa.");
    prm.add_parameter("Nitsche penalty",
                      nitsche_penalty,
                      "Penalty of fixed and slip points; > 0. "
                      "The symmetric form uses at least "
                      "20 (lambda + 2 mu)/h. Units: E/h.",
                      Patterns::Double());
    prm.add_parameter(
      "Nitsche form",
      nitsche_form,
      "symmetric: the paper's, for large penalties. unsymmetric: stable for "
      "any penalty; with Nitsche penalty = 20 it is much more accurate beside "
      "the edge of a fixed surface, for somewhat dearer linear solves.",
      Patterns::Selection("symmetric|unsymmetric"));
  }
} // namespace Morula
