// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/division/halve_shape.h>

#include <cmath>

namespace Morula
{
  template <int dim>
  void
  halve_shape(const CellView<dim, double> &daughter, const Tensor<1, dim> &axis)
  {
    // V⁰ has the volume, so the determinant of the shape is kept at 1.
    const Column<Tensor<2, dim>> &shape = daughter.columns().shape;
    if (!shape.exists())
      return;
    const Tensor<2, dim> whole = daughter.shape();
    const Tensor<2, dim> half = whole - 0.5 * outer_product(axis, axis * whole);
    daughter.set(shape,
                 std::pow(2., 1. / dim) *
                   (invert(daughter.unrelaxed_deformation()) * half));
  }


  MORULA_INSTANTIATE(halve_shape);
} // namespace Morula
