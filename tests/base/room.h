// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_base_room_h
#define morula_tests_base_room_h

#include <morula/base/agreement.h>
#include <morula/base/available_memory.h>
#include <morula/base/expression.h>
#include <morula/base/expression_parser.h>
#include <morula/base/input_error.h>
#include <morula/base/name_list.h>
#include <morula/base/parameter_keys.h>
#include <morula/base/send_records.h>
#include <morula/base/step_failed.h>
#include <morula/scene/scene.h>

#include <boost/property_tree/json_parser.hpp>

#include <filesystem>
#include <typeinfo>

#include "common/temporary_file.h"
#include "common/tests.h"
#include "output/scratch_directory.h"

using namespace Morula;

#endif
