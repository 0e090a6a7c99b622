// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/surface/following_pressure.h>

namespace Morula
{
  template <int dim>
  void
  FollowingPressure<dim>::add_load(
    const typename AreaTerm<dim>::Load     &load,
    const typename AreaTerm<dim>::Deformed &point,
    LocalSystem<dim>                       &system) const
  {
    constexpr unsigned int n      = BSpline<dim>::n;
    constexpr unsigned int n_dofs = LocalSystem<dim>::n_dofs;
    // This is q of doc/theory.md (4.8), by Nanson's formula. There is no
    // energy. The tangent is the change of q by each gradient, times N_a.
    const Tensor<1, dim> force =
      load.value * point.J * (load.area * point.f_inverse);
    if (system.wanted != LocalSystem<dim>::tangent)
      {
        add_force_at(point.splines, force, system);
        return;
      }
    // force[i] g[j] - force[j] g[i] is the derivative of det f f⁻ᵀ.
    for (unsigned int b = 0; b < n; ++b)
      {
        const Tensor<1, dim> g = point.gradient(b);
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            {
              const double change = force[i] * g[j] - force[j] * g[i];
              for (unsigned int a = 0; a < n; ++a)
                system.matrix[(i * n + a) * n_dofs + j * n + b] +=
                  point.splines.value[a] * change;
            }
      }
  }


  template class FollowingPressure<2>;
  template class FollowingPressure<3>;
} // namespace Morula
