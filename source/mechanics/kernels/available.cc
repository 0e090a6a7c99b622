// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/vector_kernels.h>

namespace Morula
{
  extern const VectorKernels baseline_kernels, avx2_kernels, avx512_kernels;

  std::vector<VectorKernels>
  available_vector_kernels()
  {
    std::vector<VectorKernels> kernels;
#ifdef MORULA_X86_KERNELS
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"))
      kernels.push_back(avx512_kernels);
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
      kernels.push_back(avx2_kernels);
#endif
    kernels.push_back(baseline_kernels);
    return kernels;
  }
} // namespace Morula
