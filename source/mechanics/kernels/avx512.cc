// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// Compiled with -mavx512f and -mavx512dq.
#define MORULA_KERNELS avx512
#define MORULA_LANES 8
#include <morula/mechanics/kernels/kernels.h>

namespace Morula
{
  extern const VectorKernels avx512_kernels;
  const VectorKernels        avx512_kernels = {"avx512",
                                               &avx512::residual,
                                               &avx512::tangent};
} // namespace Morula
