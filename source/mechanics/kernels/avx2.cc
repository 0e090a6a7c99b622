// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// Compiled with -mavx2 -mfma.
#define MORULA_KERNELS avx2
#define MORULA_LANES 4
#include <morula/mechanics/kernels/kernels.h>

namespace Morula
{
  extern const VectorKernels avx2_kernels;
  const VectorKernels avx2_kernels = {"avx2", &avx2::residual, &avx2::tangent};
} // namespace Morula
