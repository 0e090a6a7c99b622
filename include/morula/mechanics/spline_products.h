// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_spline_products_h
#define morula_mechanics_spline_products_h

#include <morula/mechanics/material.h>
#include <morula/mechanics/vector_kernels.h>

#include <string>

namespace Morula
{
  class Material;

  /** See AddProducts; for any processor, as plain as can be. */
  template <int dim>
  void
  add_products_plainly(const SplineProduct<dim> *products,
                       const unsigned int        n,
                       double                   *block,
                       const unsigned int        stride);

  /** How products are added with the value @p kernel of Solver/Kernel. */
  template <int dim>
  AddProducts<dim>
  product_kernel(const Material &material, const std::string &kernel);
} // namespace Morula

#endif
