// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_grid_room_h
#define morula_tests_grid_room_h

#include <morula/grid/background_grid.h>
#include <morula/grid/bspline.h>
#include <morula/grid/grid_box.h>
#include <morula/grid/grid_window.h>
#include <morula/grid/occupancy.h>
#include <morula/grid/particle_domain.h>
#include <morula/grid/parting.h>
#include <morula/grid/spline_space.h>
#include <morula/grid/unknown_numbers.h>

#include "common/allocations.h"
#include "common/body_on_grid.h"
#include "common/tests.h"
#include "grid/cut_bodies.h"

using namespace Morula;

#endif
