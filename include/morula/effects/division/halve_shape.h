// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_division_halve_shape_h
#define morula_effects_division_halve_shape_h

#include <morula/particles/cell_state.h>

namespace Morula
{
  /**
   * Halves the shape of a daughter, doc/theory.md (6.10b); nothing if the shape
   * of cells is not followed.
   * @param daughter has the shape of her mother, and her F
   * @param axis     unit vector from one daughter to the other, in the present
   *                 configuration
   */
  template <int dim>
  void
  halve_shape(const CellView<dim, double> &daughter,
              const Tensor<1, dim>        &axis);
} // namespace Morula

#endif
