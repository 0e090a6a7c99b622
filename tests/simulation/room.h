// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_simulation_room_h
#define morula_tests_simulation_room_h

#include <morula/base/input_error.h>
#include <morula/effects/surface/fixed.h>
#include <morula/simulation/run_state.h>
#include <morula/simulation/simulation.h>
#include <morula/simulation/snapshot_check.h>
#include <morula/simulation/step_checks.h>
#include <morula/simulation/stop_signals.h>

#include <filesystem>
#include <regex>

#include "common/tests.h"
#include "effects/small_tissue.h"
#include "output/scratch_directory.h"
#include "simulation/field_runs.h"

using namespace Morula;

#endif
