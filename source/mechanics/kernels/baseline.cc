// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// For any processor.
#define MORULA_KERNELS baseline
#define MORULA_LANES 2
#include <morula/mechanics/kernels/kernels.h>

namespace Morula
{
  extern const VectorKernels baseline_kernels;
  const VectorKernels        baseline_kernels = {"baseline",
                                                 &baseline::residual,
                                                 &baseline::tangent};
} // namespace Morula
