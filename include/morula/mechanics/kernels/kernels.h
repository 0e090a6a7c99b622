// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// No guard: each file that includes this defines MORULA_KERNELS, the namespace,
// and MORULA_LANES, the doubles in a register of its instruction set. Debian's
// deal.II has a VectorizedArray of one lane, so these are the compiler's own
// vector types (GCC, Clang). No standard headers here: their inline functions,
// compiled for this instruction set, could end up in other files.

#include <morula/mechanics/materials/laws.h>
#include <morula/mechanics/vector_kernels.h>

// After those, and in this order: each uses the ones before it.
#include <morula/mechanics/kernels/points.h>
#include <morula/mechanics/kernels/rank_updates.h>
#include <morula/mechanics/kernels/residual.h>
#include <morula/mechanics/kernels/tangent.h>

namespace Morula
{
  namespace MORULA_KERNELS
  {
    /** The kernels of a law. */
    template <int dim, typename Law>
    VectorKernels<dim>
    kernels_of(const char *name)
    {
      return {name,
              &residual_of<dim, Law>,
              &tangent_of<dim, Law, double>,
              &tangent_of<dim, Law, float>,
              &add_products<dim>,
              &find_motions<dim>};
    }

    /** The kernels of law number @p i in a list. */
    template <int dim, typename... Law>
    VectorKernels<dim>
    kernels_of(const Laws<Law...> &, const unsigned int i, const char *name)
    {
      const VectorKernels<dim> all[] = {kernels_of<dim, Law>(name)...};
      return all[i];
    }
  } // namespace MORULA_KERNELS
} // namespace Morula
