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
#include <morula/scene/checks.h>
#include <morula/scene/scene.h>
#include <morula/scene/seeded_tissue.h>

#include <boost/algorithm/string.hpp>

#include <cstdint>

#include "common/temporary_file.h"
#include "common/tests.h"
#include "output/scratch_directory.h"

using namespace Morula;

/** Sets a key of "Boundary conditions". */
inline void
set_condition(Scene &scene, const std::string &name, const std::string &value)
{
  for (AnyKey *const key : scene.list())
    if (key->path() == "Boundary conditions/" + name)
      return key->assign(value);
  ADD_FAILURE() << "no key " << name;
}

#endif
