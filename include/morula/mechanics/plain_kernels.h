// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_plain_kernels_h
#define morula_mechanics_plain_kernels_h

#include <morula/mechanics/material.h>
#include <morula/mechanics/spline_field.h>
#include <morula/mechanics/vector_kernels.h>

#include <string>
#include <vector>

namespace Morula
{
  class Material;

  /** How a point moves in a step: the kernels store it so. */
  template <int dim>
  struct PointMotion
  {
    Tensor<1, dim> u; // displacement, µm
    Tensor<2, dim> f; // I + ∇u
  };

  /** See FindMotions; for any processor, as plain as can be. */
  template <int dim>
  void
  find_motions_plainly(const KernelInput &input, double *motions);

  /** How motions are found with the value @p kernel of Solver/Kernel. */
  template <int dim>
  FindMotions
  motion_kernel(const Material &material, const std::string &kernel);

  /** The motions of the points of a store, in order. */
  template <int dim>
  std::vector<PointMotion<dim>>
  point_motions(const PointStore<dim>        &store,
                const DisplacementField<dim> &displacement,
                const FindMotions             find_motions);

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
