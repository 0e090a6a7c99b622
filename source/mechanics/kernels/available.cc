// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/mechanics/vector_kernels.h>

namespace Morula
{
  template <int dim>
  VectorKernels<dim>
  baseline_kernels(const unsigned int law);
  template <int dim>
  VectorKernels<dim>
  avx2_kernels(const unsigned int law);
  template <int dim>
  VectorKernels<dim>
  avx512_kernels(const unsigned int law);

  template <int dim>
  std::vector<VectorKernels<dim>>
  available_vector_kernels(const unsigned int law)
  {
    std::vector<VectorKernels<dim>> kernels;
// The processor is asked at run time, since one program serves all machines.
// The widest instruction set comes first.
#ifdef MORULA_X86_KERNELS
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"))
      kernels.push_back(avx512_kernels<dim>(law));
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
      kernels.push_back(avx2_kernels<dim>(law));
#endif
    kernels.push_back(baseline_kernels<dim>(law));
    return kernels;
  }

  MORULA_INSTANTIATE(available_vector_kernels);
} // namespace Morula
