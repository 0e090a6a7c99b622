// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/mechanics/internal_force.h>
#include <morula/mechanics/materials/material.h>

namespace Morula
{
  namespace
  {
    /**
     * The InternalForce, all particles of a grid cell at once and some in a
     * register: the same to rounding, several times faster.
     */
    template <int dim>
    class VectorizedInternalForce : public InternalForce<dim>
    {
    public:
      /** Keeps a reference to the points, whose material the kernels are for.
       */
      VectorizedInternalForce(
        const MaterialPoints<dim> &points,
        const VectorKernels<dim>  &kernels,
        const VolumetricStrain     form = VolumetricStrain::pointwise)
        : InternalForce<dim>(points, form)
        , kernels(kernels)
      {
        // The kernels read arrays of these types as plain numbers, and rely on
        // their layout.
        static_assert(sizeof(Point<dim>) == dim * sizeof(double));
        static_assert(sizeof(ElasticState<dim>) ==
                      (dim * dim + 1) * sizeof(double));
        static_assert(sizeof(Lame) == 2 * sizeof(double));
        static_assert(sizeof(LocalField<dim>) ==
                      LocalSystem<dim>::n_dofs * sizeof(double));
      }

    private:
      using Range = typename InternalForce<dim>::Range;

      bool
      add_forces(const Range           &range,
                 const LocalField<dim> &field,
                 const GrowthAt         growth,
                 PoolVolume<dim>       *volume,
                 LocalSystem<dim>      &system) const override
      {
        // input() needs at least one point.
        if (range.first == range.last)
          return true;
        // The kernel adds the gradients to the volume's own array.
        KernelVolume sums;
        if (volume != nullptr)
          {
            sums.pressed   = volume->pressed();
            sums.gradients = &volume->gradients[0][0];
          }
        const KernelResult found =
          kernels.residual(input(range, field, growth),
                           system.residual.data(),
                           system.wanted == LocalSystem<dim>::rounding ?
                             system.magnitude.data() :
                             nullptr,
                           volume == nullptr ? nullptr : &sums);
        if (volume != nullptr)
          volume->v += sums.v;
        system.add_energy(found.energy, found.energy_magnitude);
        return admit(found, range, system);
      }

      bool
      add_tangent(const Range           &range,
                  const LocalField<dim> &field,
                  const GrowthAt         growth,
                  const PressureOfPool  *pressure,
                  LocalSystem<dim>      &system) const override
      {
        // The caller says whether rounding to seven digits does here.
        const auto tangent =
          system.in_single ? kernels.tangent_in_single : kernels.tangent;
        return range.first == range.last ||
               admit(tangent(input(range, field, growth),
                             pressure,
                             system.matrix.data()),
                     range,
                     system);
      }

      /** Points, of which there must be some. */
      KernelInput
      input(const Range           &range,
            const LocalField<dim> &field,
            const GrowthAt         growth) const
      {
        // A uniform material has one pair of constants, which the kernels read
        // again for each point with stride 0.
        const auto        &points = this->points;
        const unsigned int stride = points.lame.size() == 1 ? 0 : 2;
        return {range.last - range.first,
                &points.xi[range.first][0],
                &points.states(growth)[range.first].A[0][0],
                &points.lame[stride == 0 ? 0 : range.first].lambda,
                stride,
                points.h,
                &field.coefficient[0][0],
                points.material->law(),
                points.carried.empty() ? nullptr :
                                         &points.carried[range.first]};
      }

      /** Tells @p system what a kernel found; false if a point is inverted. */
      bool
      admit(const KernelResult &found,
            const Range        &range,
            LocalSystem<dim>   &system) const
      {
        // Kernels fold det f into their smallest J: it is det f where that is
        // not positive. So 1 stands for det f here.
        return system.admits(1.,
                             found.smallest_J,
                             this->points.xi[range.first + found.at]);
      }

      const VectorKernels<dim> kernels;
    };
  } // namespace


  template <int dim>
  std::unique_ptr<InternalForce<dim>>
  internal_force(const MaterialPoints<dim> &points,
                 const VolumetricStrain     form,
                 const std::string         &kernel)
  {
    // A material without kernels for this processor, or "plain", takes the
    // simple form.
    for (const auto &kernels : points.material->template vector_kernels<dim>())
      if (kernel == "automatic" || kernel == kernels.name)
        return std::make_unique<VectorizedInternalForce<dim>>(points,
                                                              kernels,
                                                              form);
    return std::make_unique<InternalForce<dim>>(points, form);
  }

  MORULA_INSTANTIATE(internal_force);
} // namespace Morula
