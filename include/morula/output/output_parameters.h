// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_output_parameters_h
#define morula_output_output_parameters_h

#include <morula/base/key.h>

namespace Morula
{
  /** Section "Output". */
  struct OutputParameters : public Keys
  {
    OutputParameters();

    Key<double>                   interval; // day
    Key<std::vector<std::string>> formats;
    Key<double>                   snapshot_interval; // day
    Key<double>                   snapshot_minutes;
    Key<bool>                     condition_estimate;
    Key<bool>                     newton_trace;

    using Keys::list;
    KeyList
    list() override;
  };
} // namespace Morula

#endif
