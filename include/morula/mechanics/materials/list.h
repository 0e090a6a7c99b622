// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_materials_list_h
#define morula_mechanics_materials_list_h

#include <morula/mechanics/materials/isochoric_neo_hookean.h>
#include <morula/mechanics/materials/neo_hookean.h>

namespace Morula
{
  /** A list of laws of materials. */
  template <typename... Law>
  struct Laws
  {};

  /**
   * The library's own laws, the default first. A new one is its file and its
   * name here. Programs add theirs with Materials::add().
   */
  using OwnLaws = Laws<NeoHookean, IsochoricNeoHookean>;
} // namespace Morula

#endif
