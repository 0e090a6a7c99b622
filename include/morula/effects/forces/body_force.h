// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_forces_body_force_h
#define morula_effects_forces_body_force_h

#include <deal.II/base/parameter_handler.h>

#include <string>

namespace Morula
{
  using namespace dealii;

  /** Section "Body force". */
  struct BodyForceParameters
  {
    std::string force_density = "0; 0; 0";

    void
    declare(ParameterHandler &prm);
  };
} // namespace Morula

#endif
