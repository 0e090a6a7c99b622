// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_vectorized_internal_force_h
#define morula_mechanics_vectorized_internal_force_h

#include <morula/mechanics/internal_force.h>
#include <morula/mechanics/vector_kernels.h>

#include <memory>
#include <string>

namespace Morula
{
  /**
   * The InternalForce, all particles of a grid cell at once and some in a
   * register: the same to rounding, several times faster.
   */
  template <int dim>
  class VectorizedInternalForce : public InternalForce<dim>
  {
  public:
    /** Keeps a reference to the points, whose material the kernels are for. */
    VectorizedInternalForce(
      const MaterialPoints<dim> &points,
      const VectorKernels<dim>  &kernels,
      const VolumetricStrain     form = VolumetricStrain::pointwise);

  private:
    bool
    add_forces(const unsigned int     grid_cell,
               const LocalField<dim> &field,
               const GrowthAt         growth,
               VolumeMean<dim>       *mean,
               LocalSystem<dim>      &system) const override;

    bool
    add_tangent(const unsigned int      grid_cell,
                const LocalField<dim>  &field,
                const GrowthAt          growth,
                const StrainOfGridCell *strain,
                LocalSystem<dim>       &system) const override;

    /** The points of a grid cell, of which there must be some. */
    KernelInput
    input(const unsigned int     grid_cell,
          const LocalField<dim> &field,
          const GrowthAt         growth) const;

    /** Tells @p system what a kernel found; false if a point is inverted. */
    bool
    admit(const KernelResult &found,
          const unsigned int  grid_cell,
          LocalSystem<dim>   &system) const;

    const VectorKernels<dim> kernels;
  };

  /**
   * The internal force that a scene asks for.
   * @param kernel value of Solver/Kernel: "plain", the name of one of the
   *        material's vector_kernels(), or "automatic"
   */
  template <int dim>
  std::unique_ptr<InternalForce<dim>>
  internal_force(const MaterialPoints<dim> &points,
                 const VolumetricStrain     form,
                 const std::string         &kernel);
} // namespace Morula

#endif
