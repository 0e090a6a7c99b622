// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_output_room_h
#define morula_tests_output_room_h

#include <morula/base/input_error.h>
#include <morula/output/directory.h>
#include <morula/output/output_file.h>
#include <morula/output/point_fields.h>
#include <morula/output/progress.h>
#include <morula/output/rows.h>
#include <morula/output/sealed_file.h>
#include <morula/output/snapshot.h>
#include <morula/output/table.h>
#include <morula/particles/boundary_state.h>
#include <morula/particles/tissue.h>

#include <deal.II/base/utilities.h>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>

#include <hdf5.h>
#include <sys/file.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <future>
#include <thread>

#include "common/diagonal.h"
#include "common/materials.h"
#include "common/tests.h"
#include "output/scratch_directory.h"

using namespace Morula;
using namespace dealii;

#endif
