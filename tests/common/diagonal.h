// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_diagonal_h
#define morula_tests_diagonal_h

#include <deal.II/base/tensor.h>

#include <vector>

namespace Morula
{
  using namespace dealii;

  /** A tensor with these entries on its diagonal, as many as it takes. */
  template <int dim>
  Tensor<2, dim>
  diagonal(const std::vector<double> &entries)
  {
    Tensor<2, dim> t;
    for (unsigned int d = 0; d < dim; ++d)
      t[d][d] = entries[d];
    return t;
  }
} // namespace Morula

#endif
