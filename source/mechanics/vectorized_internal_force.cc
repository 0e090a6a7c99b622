// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/vectorized_internal_force.h>

namespace Morula
{
  template <int dim>
  VectorizedInternalForce<dim>::VectorizedInternalForce(
    const MaterialPoints<dim> &points, const VectorKernels<dim> &kernels)
    : points(points)
    , kernels(kernels)
  {
    // What the kernels take arrays of these for.
    static_assert(sizeof(Point<dim>) == dim * sizeof(double));
    static_assert(sizeof(ElasticState<dim>) ==
                  (dim * dim + 1) * sizeof(double));
    static_assert(sizeof(Lame) == 2 * sizeof(double));
    static_assert(sizeof(LocalField<dim>) ==
                  LocalSystem<dim>::n_dofs * sizeof(double));
  }

  template <int dim>
  void
  VectorizedInternalForce<dim>::add(const unsigned int     grid_cell,
                                    const LocalField<dim> &field,
                                    const GrowthAt         growth,
                                    LocalSystem<dim>      &system) const
  {
    const unsigned int first  = points.offsets[grid_cell],
                       n      = points.offsets[grid_cell + 1] - first,
                       stride = points.lame.size() == 1 ? 0 : 2;
    if (n == 0)
      return;
    const KernelInput  input = {n,
                                &points.xi[first][0],
                                &points.states(growth)[first].A[0][0],
                                &points.lame[stride == 0 ? 0 : first].lambda,
                                stride,
                                points.h,
                                &field.coefficient[0][0]};
    const KernelResult found =
      system.wanted == LocalSystem<dim>::tangent ?
        kernels.tangent(input, system.matrix.data()) :
        kernels.residual(input,
                         system.residual.data(),
                         system.wanted == LocalSystem<dim>::rounding ?
                           system.magnitude.data() :
                           nullptr);
    system.admits(1., found.smallest_J, points.xi[first + found.at]);
    system.add_energy(found.energy, found.energy_magnitude);
  }

  template <int dim>
  std::unique_ptr<Term<dim>>
  internal_force(const MaterialPoints<dim> &points,
                 const VolumetricStrain     form,
                 const std::string         &kernel)
  {
    if (form == VolumetricStrain::pointwise)
      for (const auto &kernels : available_vector_kernels<dim>())
        if (kernel == "automatic" || kernel == kernels.name)
          return std::make_unique<VectorizedInternalForce<dim>>(points,
                                                                kernels);
    return std::make_unique<InternalForce<dim>>(points, form);
  }

  template class VectorizedInternalForce<2>;
  template class VectorizedInternalForce<3>;
  template std::unique_ptr<Term<2>>
  internal_force(const MaterialPoints<2> &,
                 const VolumetricStrain,
                 const std::string &);
  template std::unique_ptr<Term<3>>
  internal_force(const MaterialPoints<3> &,
                 const VolumetricStrain,
                 const std::string &);
} // namespace Morula
