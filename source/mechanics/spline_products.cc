// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/grid/bspline.h>
#include <morula/mechanics/materials/material.h>
#include <morula/mechanics/spline_products.h>

namespace Morula
{
  template <int dim>
  void
  add_products_plainly(const SplineProduct<dim> *products,
                       const unsigned int        n,
                       double                   *block,
                       const unsigned int        stride)
  {
    // The slow but obvious form of the kernels: tests compare with it, and
    // materials without kernels of their own use it.
    for (unsigned int p = 0; p < n; ++p)
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        for (unsigned int b = 0; b < BSpline<dim>::n; ++b)
          block[a * stride + b] +=
            products[p].factors[0][a] * products[p].factors[1][b];
  }

  template <int dim>
  AddProducts<dim>
  product_kernel(const Material &material, const std::string &kernel)
  {
    for (const auto &kernels : material.vector_kernels<dim>())
      if (kernel == "automatic" || kernel == kernels.name)
        return kernels.add_products;
    return &add_products_plainly<dim>;
  }

  MORULA_INSTANTIATE(add_products_plainly);
  MORULA_INSTANTIATE(product_kernel);
} // namespace Morula
