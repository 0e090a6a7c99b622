// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_allocations_h
#define morula_tests_allocations_h

#include <cstddef>

/** Bytes that this process has asked for in C++ so far, freed or not. */
std::size_t
bytes_asked_for();

#endif
