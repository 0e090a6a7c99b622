// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_mechanics_room_h
#define morula_tests_mechanics_room_h

#include <morula/mechanics/elastic_point.h>
#include <morula/mechanics/enclosure.h>
#include <morula/mechanics/internal_force.h>
#include <morula/mechanics/materials/material.h>
#include <morula/mechanics/momentum_balance.h>
#include <morula/mechanics/plain_kernels.h>
#include <morula/mechanics/point_term.h>
#include <morula/mechanics/relaxation.h>
#include <morula/mechanics/rigid_modes.h>
#include <morula/mechanics/spline_field.h>
#include <morula/mechanics/spline_moments.h>

#include <deal.II/lac/full_matrix.h>

#include "common/body_on_grid.h"
#include "common/diagonal.h"
#include "common/finite_differences.h"
#include "common/linear_problem.h"
#include "common/materials.h"
#include "common/own_law.h"
#include "common/tests.h"
#include "mechanics/random_points.h"
#include "mechanics/stressed_ball.h"

using namespace Morula;

#endif
