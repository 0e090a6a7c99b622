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
      bool
      add_forces(const unsigned int     grid_cell,
                 const LocalField<dim> &field,
                 const GrowthAt         growth,
                 VolumeMean<dim>       *mean,
                 LocalSystem<dim>      &system) const override
      {
        // input() needs at least one point.
        if (!this->points.any(grid_cell))
          return true;
        KernelVolume volume{this->form};
        // The kernel adds the gradients to the mean's own array; the scalars of
        // the volume come back and are added below.
        if (mean != nullptr)
          {
            volume.pressed   = mean->pressed;
            volume.gradients = &mean->gradients[0][0];
          }
        const KernelResult found =
          kernels.residual(input(grid_cell, field, growth),
                           system.residual.data(),
                           system.wanted == LocalSystem<dim>::rounding ?
                             system.magnitude.data() :
                             nullptr,
                           mean == nullptr ? nullptr : &volume);
        if (mean != nullptr)
          {
            mean->modulus += volume.modulus;
            mean->weight += volume.weight;
            mean->sum += volume.sum;
          }
        system.add_energy(found.energy, found.energy_magnitude);
        return admit(found, grid_cell, system);
      }

      bool
      add_tangent(const unsigned int      grid_cell,
                  const LocalField<dim>  &field,
                  const GrowthAt          growth,
                  const StrainOfGridCell *strain,
                  LocalSystem<dim>       &system) const override
      {
        // The caller says whether rounding to seven digits does here.
        const auto tangent =
          system.in_single ? kernels.tangent_in_single : kernels.tangent;
        return !this->points.any(grid_cell) ||
               admit(tangent(input(grid_cell, field, growth),
                             strain,
                             system.matrix.data()),
                     grid_cell,
                     system);
      }

      /** The points of a grid cell, of which there must be some. */
      KernelInput
      input(const unsigned int     grid_cell,
            const LocalField<dim> &field,
            const GrowthAt         growth) const
      {
        // A uniform material has one pair of constants, which the kernels read
        // again for each point with stride 0.
        const auto        &points = this->points;
        const unsigned int first  = points.offsets[grid_cell],
                           stride = points.lame.size() == 1 ? 0 : 2;
        return {points.offsets[grid_cell + 1] - first,
                &points.xi[first][0],
                &points.states(growth)[first].A[0][0],
                &points.lame[stride == 0 ? 0 : first].lambda,
                stride,
                points.h,
                &field.coefficient[0][0],
                points.material->law()};
      }

      /** Tells @p system what a kernel found; false if a point is inverted. */
      bool
      admit(const KernelResult &found,
            const unsigned int  grid_cell,
            LocalSystem<dim>   &system) const
      {
        const auto &points = this->points;
        // Kernels fold det f into their smallest J: it is det f where that is
        // not positive. So 1 stands for det f here.
        return system.admits(1.,
                             found.smallest_J,
                             points.xi[points.offsets[grid_cell] + found.at]);
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
