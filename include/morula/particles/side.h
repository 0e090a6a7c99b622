// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_side_h
#define morula_particles_side_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

namespace Morula
{
  using namespace dealii;

  /** Which cells a boundary point may look at where tissue touches tissue:
   *  those of its body and, if its body can touch itself, those behind it. */
  template <int dim>
  struct Side
  {
    unsigned int body;
    /** Outward normal of the surface; 0 if all cells of the body count. */
    Tensor<1, dim> n;

    /** Whether a cell at @p cell is on the side of the point at @p x. */
    bool
    has(const Point<dim> &x, const Point<dim> &cell) const
    {
      return n * (cell - x) <= 0.;
    }
  };
} // namespace Morula

#endif
