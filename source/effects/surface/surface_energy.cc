// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/surface/surface_energy.h>

#include <array>

namespace Morula
{
  namespace
  {
    /**
     * @param force of the tension on the area, γ a, kPa µm^dim
     * @param n     unit normal
     * @param s     s_a, the surface gradients of the splines, per µm
     */
    template <int dim>
    void
    add_tangent(const double                                       force,
                const Tensor<1, dim>                              &n,
                const std::array<Tensor<1, dim>, BSpline<dim>::n> &s,
                LocalSystem<dim>                                  &system)
    {
      constexpr unsigned int n_splines = BSpline<dim>::n;
      constexpr unsigned int n_dofs    = LocalSystem<dim>::n_dofs;
      // These are the blocks of doc/theory.md (4.8b).
      for (unsigned int a = 0; a < n_splines; ++a)
        for (unsigned int b = 0; b < n_splines; ++b)
          {
            const double both = s[a] * s[b];
            for (unsigned int i = 0; i < dim; ++i)
              for (unsigned int j = 0; j < dim; ++j)
                system
                  .matrix[(i * n_splines + a) * n_dofs + j * n_splines + b] +=
                  force *
                  (s[a][i] * s[b][j] - s[b][i] * s[a][j] + n[i] * n[j] * both);
          }
    }
  } // namespace


  template <int dim>
  void
  SurfaceEnergy<dim>::add_load(const typename AreaTerm<dim>::Load     &load,
                               const typename AreaTerm<dim>::Deformed &point,
                               LocalSystem<dim> &system) const
  {
    // A point without tension has nothing to add, and may have no area.
    if (load.value == 0.)
      return;
    // This is doc/theory.md (4.8a) with m = a n.
    const Tensor<1, dim> m     = point.J * (load.area * point.f_inverse);
    const double         force = load.value * m.norm();
    const Tensor<1, dim> n     = m / m.norm();
    std::array<Tensor<1, dim>, BSpline<dim>::n> s;
    for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
      {
        const Tensor<1, dim> g = point.gradient(a);
        // This is s_a: what a displacement along the surface changes of the
        // area.
        s[a] = g - (g * n) * n;
      }
    if (system.wanted == LocalSystem<dim>::tangent)
      {
        add_tangent(force, n, s, system);
        return;
      }
    // The energy is relative to the start of the step: the difference of two
    // large constants would lose its digits.
    const double before = load.value * load.area.norm();
    system.add_energy(force - before, force + before);
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        system.add_force(i, a, force * s[a][i]);
  }


  template class SurfaceEnergy<2>;
  template class SurfaceEnergy<3>;
} // namespace Morula
