// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/surface/surface_energy.h>

#include <array>
#include <cmath>
#include <utility>

namespace Morula
{
  namespace
  {
    /**
     * @param force of the tension on the area, γ a, kPa µm^dim
     * @param stiffening what the smoothing adds for each pair s_a, s_b
     * @param n     unit normal
     * @param s     s_a, the surface gradients of the splines, per µm
     */
    template <int dim>
    void
    add_tangent(const double                                       force,
                const double                                       stiffening,
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
                  force * (s[a][i] * s[b][j] - s[b][i] * s[a][j] +
                           n[i] * n[j] * both) +
                  stiffening * s[a][i] * s[b][j];
          }
    }
  } // namespace


  template <int dim>
  SurfaceEnergy<dim>::SurfaceEnergy(
    GroupedPoints<dim>                        points,
    std::vector<typename AreaTerm<dim>::Load> loads,
    const double                              smoothing)
    : AreaTerm<dim>(std::move(points), std::move(loads))
    , smoothing(smoothing)
  {}


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
    const Tensor<1, dim> m    = point.J * (load.area * point.f_inverse);
    const double         size = m.norm();
    if (smoothing > 0. && size == 0.)
      return;
    // With smoothing, this is doc/theory.md (12.3): √(|m|² + ε²) for |m|.
    const double smooth = smoothing > 0. ? std::hypot(size, smoothing) : size;
    const double force =
      load.value * (smoothing > 0. ? size * size / smooth : size);
    const Tensor<1, dim>                        n = m / size;
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
        const double part = smoothing / smooth;
        add_tangent(force, force * part * part, n, s, system);
        return;
      }
    // The energy is relative to the start of the step: the difference of two
    // large constants would lose its digits.
    const double before =
      load.value * (smoothing > 0. ? std::hypot(load.area.norm(), smoothing) :
                                     load.area.norm());
    const double now = smoothing > 0. ? load.value * smooth : force;
    system.add_energy(now - before, now + before);
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        system.add_force(i, a, force * s[a][i]);
  }


  template class SurfaceEnergy<2>;
  template class SurfaceEnergy<3>;
} // namespace Morula
