// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/vector_kernels.h>

namespace Morula
{
  template <int dim>
  VectorKernels<dim>
  baseline_kernels();
  template <int dim>
  VectorKernels<dim>
  avx2_kernels();
  template <int dim>
  VectorKernels<dim>
  avx512_kernels();

  template <int dim>
  std::vector<VectorKernels<dim>>
  available_vector_kernels()
  {
    std::vector<VectorKernels<dim>> kernels;
#ifdef MORULA_X86_KERNELS
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"))
      kernels.push_back(avx512_kernels<dim>());
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
      kernels.push_back(avx2_kernels<dim>());
#endif
    kernels.push_back(baseline_kernels<dim>());
    return kernels;
  }

  template std::vector<VectorKernels<2>>
  available_vector_kernels();
  template std::vector<VectorKernels<3>>
  available_vector_kernels();
} // namespace Morula
