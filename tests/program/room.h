// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_program_room_h
#define morula_tests_program_room_h

#include <morula/base/input_error.h>
#include <morula/base/parameter_keys.h>
#include <morula/program/command_line.h>
#include <morula/program/ranks.h>

#include <cstdlib>

#include "common/tests.h"

using namespace Morula;
using namespace dealii;

#endif
