// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_particles_room_h
#define morula_tests_particles_room_h

#include <morula/particles/detached_points.h>
#include <morula/particles/nearest.h>
#include <morula/particles/neighbours.h>
#include <morula/particles/places.h>
#include <morula/particles/point_exchange.h>
#include <morula/particles/point_store.h>
#include <morula/particles/surface_refinement.h>
#include <morula/particles/tissue.h>

#include "common/body_on_grid.h"
#include "common/tests.h"
#include "particles/random_points.h"
#include "particles/surface_patches.h"

using namespace Morula;

#endif
