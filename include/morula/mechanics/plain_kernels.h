// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_plain_kernels_h
#define morula_mechanics_plain_kernels_h

#include <morula/grid/bspline.h>
#include <morula/mechanics/material.h>
#include <morula/mechanics/materials/material.h>
#include <morula/mechanics/spline_field.h>
#include <morula/mechanics/vector_kernels.h>

#include <algorithm>
#include <string>
#include <vector>

namespace Morula
{
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
  find_motions_plainly(const KernelInput &input, double *motions)
  {
    // The slow but obvious form of the kernels: tests compare with it, and
    // materials without kernels of their own use it.
    LocalField<dim> field;
    std::copy_n(input.coefficients,
                LocalSystem<dim>::n_dofs,
                &field.coefficient[0][0]);
    for (unsigned int p = 0; p < input.n; ++p)
      {
        Point<dim> xi;
        for (unsigned int d = 0; d < dim; ++d)
          xi[d] = input.xi[dim * p + d];
        const SplineValues<dim> splines(xi, input.h);
        const Tensor<1, dim>    u = field.value(splines);
        const Tensor<2, dim>    f = field.step_deformation(splines);
        for (unsigned int i = 0; i < dim; ++i)
          *motions++ = u[i];
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            *motions++ = f[i][j];
      }
  }

  /** How motions are found with the value @p kernel of Solver/Kernel. */
  template <int dim>
  FindMotions
  motion_kernel(const Material &material, const std::string &kernel)
  {
    // Kernels are listed fastest first, so "automatic" takes the first one.
    for (const auto &kernels : material.vector_kernels<dim>())
      if (kernel == "automatic" || kernel == kernels.name)
        return kernels.find_motions;
    return &find_motions_plainly<dim>;
  }

  /** The motions of the points of a store, in order; only those of @p wanted
   *  points, if it is given, which is in order, too. */
  template <int dim>
  std::vector<PointMotion<dim>>
  point_motions(const PointStore<dim>           &store,
                const DisplacementField<dim>    &displacement,
                const FindMotions                find_motions,
                const std::vector<unsigned int> *wanted = nullptr)
  {
    // Kernels write u and f one after the other as plain numbers, into the
    // memory of the result.
    static_assert(sizeof(PointMotion<dim>) ==
                  (dim + dim * dim) * sizeof(double));
    std::vector<PointMotion<dim>> motions(wanted ? wanted->size() :
                                                   store.size());
    std::vector<Point<dim>>       xi;
    std::size_t                   n = 0; // motions so far
    // One call for each grid cell that holds points of the store. The points of
    // a grid cell are neighbours in the store, so their results are, too.
    displacement.on_grid_cells(
      store,
      [&](const auto            &grid_cell,
          const LocalField<dim> &field,
          const GridIndex<dim>  &index) {
        xi.clear();
        for (unsigned int p = grid_cell.begin; p < grid_cell.end; ++p)
          if (!wanted ||
              (n + xi.size() < wanted->size() && (*wanted)[n + xi.size()] == p))
            xi.push_back(
              displacement.box().unit_position(store.position(p), index));
        if (xi.empty())
          return;
        KernelInput input{};
        input.n            = xi.size();
        input.xi           = &xi[0][0];
        input.h            = displacement.box().spacing();
        input.coefficients = &field.coefficient[0][0];
        find_motions(input, &motions[n].u[0]);
        n += xi.size();
      });
    return motions;
  }

  /** See AddProducts; for any processor, as plain as can be. */
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

  /** How products are added with the value @p kernel of Solver/Kernel. */
  template <int dim>
  AddProducts<dim>
  product_kernel(const Material &material, const std::string &kernel)
  {
    for (const auto &kernels : material.vector_kernels<dim>())
      if (kernel == "automatic" || kernel == kernels.name)
        return kernels.add_products;
    return &add_products_plainly<dim>;
  }
} // namespace Morula

#endif
