// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/surface/following_pressure.h>

namespace Morula
{
  template <int dim>
  FollowingPressure<dim>::FollowingPressure(GroupedPoints<dim> points,
                                            std::vector<Load>  loads)
    : points(std::move(points))
    , loads(std::move(loads))
  {}

  template <int dim>
  void
  FollowingPressure<dim>::add(const unsigned int     cell,
                              const LocalField<dim> &field,
                              const GrowthAt,
                              LocalSystem<dim> &system) const
  {
    constexpr unsigned int n      = BSpline<dim>::n;
    constexpr unsigned int n_dofs = LocalSystem<dim>::n_dofs;
    for (unsigned int p = points.offsets[cell]; p < points.offsets[cell + 1];
         ++p)
      {
        const SplineValues<dim> splines(points.xi[p], points.h);
        const Tensor<2, dim>    f = field.step_deformation(splines);
        const double            J = determinant(f);
        if (J <= 0.)
          {
            system.inverted = true;
            return;
          }
        const Tensor<2, dim> f_inverse = invert(f);
        const Tensor<1, dim> force =
          loads[p].pressure * J * (loads[p].area * f_inverse);
        if (system.wanted != LocalSystem<dim>::tangent)
          {
            for (unsigned int i = 0; i < dim; ++i)
              for (unsigned int a = 0; a < n; ++a)
                system.add_force(i, a, force[i] * splines.value[a]);
            continue;
          }
        for (unsigned int b = 0; b < n; ++b)
          {
            Tensor<1, dim> g; // f⁻ᵀ ∇N_b
            for (unsigned int k = 0; k < dim; ++k)
              for (unsigned int j = 0; j < dim; ++j)
                g[j] += f_inverse[k][j] * splines.gradient[k][b];
            for (unsigned int i = 0; i < dim; ++i)
              for (unsigned int j = 0; j < dim; ++j)
                {
                  const double change = force[i] * g[j] - force[j] * g[i];
                  for (unsigned int a = 0; a < n; ++a)
                    system.matrix[(i * n + a) * n_dofs + j * n + b] +=
                      splines.value[a] * change;
                }
          }
      }
  }

  template <int dim>
  bool
  FollowingPressure<dim>::is_conservative() const
  {
    return false;
  }

  template class FollowingPressure<2>;
  template class FollowingPressure<3>;
} // namespace Morula
