// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_scene_room_h
#define morula_tests_scene_room_h

#include <morula/base/input_error.h>
#include <morula/effects/fate/random.h>
#include <morula/effects/forces/body_force.h>
#include <morula/effects/growth/contraction.h>
#include <morula/effects/growth/isotropic.h>
#include <morula/effects/growth/relaxation.h>
#include <morula/effects/surface/fixed.h>
#include <morula/effects/surface/lumen.h>
#include <morula/effects/surface/pressure.h>
#include <morula/effects/surface/slip.h>
#include <morula/effects/surface/traction.h>
#include <morula/scene/checks.h>
#include <morula/scene/scene.h>
#include <morula/scene/seeded_tissue.h>

#include <boost/algorithm/string.hpp>

#include <cstdint>

#include "common/temporary_file.h"
#include "common/tests.h"
#include "output/scratch_directory.h"

using namespace Morula;

#endif
