// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_output_parameters_h
#define morula_output_output_parameters_h

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** Section "Output". */
  struct OutputParameters
  {
    double                   interval           = 0.25;
    std::vector<std::string> formats            = {"vtu"};
    double                   snapshot_interval  = 0.;
    bool                     condition_estimate = false;

    void
    declare(ParameterHandler &prm);
  };
} // namespace Morula

#endif
