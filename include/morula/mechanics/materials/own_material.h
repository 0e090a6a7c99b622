// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_materials_own_material_h
#define morula_mechanics_materials_own_material_h

#include <morula/mechanics/materials/material_of.h>

#include <memory>

// These kernels have a namespace of their own: compiled with a program's own
// flags, they must not take the place of the library's.
#define MORULA_KERNELS programs_kernels
#define MORULA_LANES 2
#include <morula/mechanics/kernels/kernels.h>
#undef MORULA_KERNELS
#undef MORULA_LANES

namespace Morula
{
  /**
   * The Material of a program's own law, for Materials::add(), with the plain
   * code and the kernels for any processor.
   * @tparam Law as MaterialOf<Law> requires
   */
  template <typename Law>
  std::shared_ptr<const Material>
  own_material(const Law &law = Law())
  {
    const std::vector<VectorKernels<2>> kernels_2d = {
      programs_kernels::kernels_of<2, Law>("baseline")};
    const std::vector<VectorKernels<3>> kernels_3d = {
      programs_kernels::kernels_of<3, Law>("baseline")};
    return std::make_shared<const MaterialOf<Law>>(law, kernels_2d, kernels_3d);
  }
} // namespace Morula

#endif
