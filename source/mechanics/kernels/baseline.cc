// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// This file is compiled for any processor of the architecture. Two lanes are
// what x86-64 and ARM have at least.
#define MORULA_KERNELS baseline
#define MORULA_LANES 2
#include <morula/mechanics/kernels/kernels.h>

namespace Morula
{
  template <int dim>
  VectorKernels<dim>
  baseline_kernels(const unsigned int law)
  {
    return baseline::kernels_of<dim>(OwnLaws(), law, "baseline");
  }

  template VectorKernels<2>
  baseline_kernels(const unsigned int);
  template VectorKernels<3>
  baseline_kernels(const unsigned int);
} // namespace Morula
