// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/surface/surface_energy.h>

#include <array>

namespace Morula
{
  namespace
  {
    /** A boundary point as the step deforms it. */
    template <int dim>
    struct DeformedPoint
    {
      /** Force of the tension on the area, γ a, kPa µm^dim. */
      double force;
      /** Unit normal. */
      Tensor<1, dim> n;
      /** s_a, the surface gradients of the splines, per µm. */
      std::array<Tensor<1, dim>, BSpline<dim>::n> s;
    };

    template <int dim>
    DeformedPoint<dim>
    deformed_point(const Tensor<2, dim>    &f,
                   const double             J,
                   const SplineValues<dim> &splines,
                   const double             tension,
                   const Tensor<1, dim>    &area)
    {
      const Tensor<2, dim> f_inverse = invert(f);
      const Tensor<1, dim> m         = J * (area * f_inverse);
      DeformedPoint<dim>   point;
      point.force = tension * m.norm();
      point.n     = m / m.norm();
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        {
          Tensor<1, dim> gradient;
          for (unsigned int k = 0; k < dim; ++k)
            gradient[k] = splines.gradient[k][a];
          const Tensor<1, dim> g = gradient * f_inverse;
          point.s[a]             = g - (g * point.n) * point.n;
        }
      return point;
    }

    template <int dim>
    void
    add_tangent(const DeformedPoint<dim> &point, LocalSystem<dim> &system)
    {
      constexpr unsigned int n      = BSpline<dim>::n;
      constexpr unsigned int n_dofs = LocalSystem<dim>::n_dofs;
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int b = 0; b < n; ++b)
          {
            const Tensor<1, dim> &s_a = point.s[a], &s_b = point.s[b];
            const double          both = s_a * s_b;
            for (unsigned int i = 0; i < dim; ++i)
              for (unsigned int j = 0; j < dim; ++j)
                system.matrix[(i * n + a) * n_dofs + j * n + b] +=
                  point.force * (s_a[i] * s_b[j] - s_b[i] * s_a[j] +
                                 point.n[i] * point.n[j] * both);
          }
    }
  } // namespace


  template <int dim>
  SurfaceEnergy<dim>::SurfaceEnergy(GroupedPoints<dim> points,
                                    std::vector<Load>  loads)
    : points(std::move(points))
    , loads(std::move(loads))
  {}


  template <int dim>
  void
  SurfaceEnergy<dim>::add(const unsigned int     cell,
                          const LocalField<dim> &field,
                          const GrowthAt,
                          LocalSystem<dim> &system) const
  {
    for (unsigned int p = points.offsets[cell]; p < points.offsets[cell + 1];
         ++p)
      {
        if (loads[p].tension == 0.)
          continue;
        const SplineValues<dim> splines(points.xi[p], points.h);
        const Tensor<2, dim>    f = field.step_deformation(splines);
        const double            J = determinant(f);
        if (J <= 0.)
          {
            system.inverted = true;
            return;
          }
        const DeformedPoint<dim> point =
          deformed_point(f, J, splines, loads[p].tension, loads[p].area);
        if (system.wanted == LocalSystem<dim>::tangent)
          {
            add_tangent(point, system);
            continue;
          }
        // Of the step, so that the large constant spoils no difference.
        const double before = loads[p].tension * loads[p].area.norm();
        system.add_energy(point.force - before, point.force + before);
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
            system.add_force(i, a, point.force * point.s[a][i]);
      }
  }


  template class SurfaceEnergy<2>;
  template class SurfaceEnergy<3>;
} // namespace Morula
