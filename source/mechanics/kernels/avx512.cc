// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// This file is compiled with -mavx512f, -mavx512dq and -mfma. Its kernels have
// a namespace of their own: were the linker to take one of its copies for the
// other files', processors without these instructions would end the program.
#define MORULA_KERNELS avx512
#define MORULA_LANES 8
#include <morula/mechanics/kernels/kernels.h>

namespace Morula
{
  template <int dim>
  VectorKernels<dim>
  avx512_kernels(const unsigned int law)
  {
    return avx512::kernels_of<dim>(OwnLaws(), law, "avx512");
  }

  template VectorKernels<2>
  avx512_kernels(const unsigned int);
  template VectorKernels<3>
  avx512_kernels(const unsigned int);
} // namespace Morula
