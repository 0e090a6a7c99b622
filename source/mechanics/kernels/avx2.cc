// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// This file is compiled with -mavx2 -mfma, in a namespace of its own as
// avx512.cc.
#define MORULA_KERNELS avx2
#define MORULA_LANES 4
#include <morula/mechanics/kernels/kernels.h>

namespace Morula
{
  template <int dim>
  VectorKernels<dim>
  avx2_kernels(const unsigned int law)
  {
    return avx2::kernels_of<dim>(OwnLaws(), law, "avx2");
  }

  template VectorKernels<2>
  avx2_kernels(const unsigned int);
  template VectorKernels<3>
  avx2_kernels(const unsigned int);
} // namespace Morula
