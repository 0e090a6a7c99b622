// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/vectorized_internal_force.h>

namespace Morula
{
  // What the kernels take arrays of these for.
  static_assert(sizeof(Point<3>) == 3 * sizeof(double));
  static_assert(sizeof(ElasticState<3>) == 10 * sizeof(double));
  static_assert(sizeof(Lame) == 2 * sizeof(double));
  static_assert(sizeof(LocalField<3>) == 81 * sizeof(double));

  VectorizedInternalForce::VectorizedInternalForce(
    const MaterialPoints<3> &points, const VectorKernels &kernels)
    : points(points)
    , kernels(kernels)
  {}

  void
  VectorizedInternalForce::add(const unsigned int   cell,
                               const LocalField<3> &field,
                               const GrowthAt       growth,
                               LocalSystem<3>      &system) const
  {
    const unsigned int first  = points.offsets[cell],
                       n      = points.offsets[cell + 1] - first,
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
      system.wanted == LocalSystem<3>::tangent ?
        kernels.tangent(input, system.matrix.data()) :
        kernels.residual(input,
                         system.residual.data(),
                         system.wanted == LocalSystem<3>::rounding ?
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
    if constexpr (dim == 3)
      if (form == VolumetricStrain::pointwise)
        for (const VectorKernels &kernels : available_vector_kernels())
          if (kernel == "automatic" || kernel == kernels.name)
            return std::make_unique<VectorizedInternalForce>(points, kernels);
    return std::make_unique<InternalForce<dim>>(points, form);
  }

  template std::unique_ptr<Term<2>>
  internal_force(const MaterialPoints<2> &,
                 const VolumetricStrain,
                 const std::string &);
  template std::unique_ptr<Term<3>>
  internal_force(const MaterialPoints<3> &,
                 const VolumetricStrain,
                 const std::string &);
} // namespace Morula
