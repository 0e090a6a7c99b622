// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_instantiate_h
#define morula_base_instantiate_h

/** Instantiates a function in 2-D and 3-D behind its definition, without saying
 *  its parameters once more: for a template of the dimension alone, whose name
 *  is not overloaded. */
#define MORULA_INSTANTIATE(function)          \
  template decltype(function<2>) function<2>; \
  template decltype(function<3>) function<3>

#endif
