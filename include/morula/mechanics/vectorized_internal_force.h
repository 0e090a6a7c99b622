// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_vectorized_internal_force_h
#define morula_mechanics_vectorized_internal_force_h

#include <morula/mechanics/internal_force.h>
#include <morula/mechanics/vector_kernels.h>

namespace Morula
{
  /**
   * The pointwise InternalForce in 3-D, all particles of a grid cell at once
   * and some in a register: the same to rounding, several times faster.
   */
  class VectorizedInternalForce : public Term<3>
  {
  public:
    /** Keeps a reference to the points. */
    VectorizedInternalForce(const MaterialPoints<3> &points,
                            const VectorKernels     &kernels);

    void
    add(const unsigned int   cell,
        const LocalField<3> &field,
        const GrowthAt       growth,
        LocalSystem<3>      &system) const override;

  private:
    const MaterialPoints<3> &points;
    const VectorKernels      kernels;
  };

  /**
   * The internal force as a scene wants it.
   * @param kernel value of Solver/Kernel: "plain", one of
   *        available_vector_kernels(), or "automatic"
   */
  template <int dim>
  std::unique_ptr<Term<dim>>
  internal_force(const MaterialPoints<dim> &points,
                 const VolumetricStrain     form,
                 const std::string         &kernel);
} // namespace Morula

#endif
