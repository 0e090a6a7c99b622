// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/surface/loads.h>

#include <array>
#include <cmath>

namespace Morula
{
  namespace
  {
    /** A term of boundary points that depends on their current area and normal,
     *  a n = det f f⁻ᵀ a_t n_t (Nanson). */
    template <int dim>
    class AreaTerm : public PointTerm<dim>
    {
    public:
      AreaTerm(GroupedPoints<dim> points, std::vector<AreaLoad<dim>> loads)
        : PointTerm<dim>(std::move(points))
        , loads(std::move(loads))
      {}

    protected:
      /** The step at a boundary point. */
      struct Deformed
      {
        const SplineValues<dim> &splines;
        /** det f > 0. */
        double J;
        /** f⁻¹. */
        Tensor<2, dim> f_inverse;

        /** f⁻ᵀ ∇N of a spline, per µm. */
        Tensor<1, dim>
        gradient(const unsigned int a) const
        {
          // This is g_a = f⁻ᵀ ∇N_a, in the trial configuration.
          Tensor<1, dim> g;
          for (unsigned int k = 0; k < dim; ++k)
            for (unsigned int j = 0; j < dim; ++j)
              g[j] += f_inverse[k][j] * splines.gradient[k][a];
          return g;
        }
      };

      /** Adds the energy, residual and tangent that @p system asks for at a
       *  boundary point. */
      virtual void
      add_load(const AreaLoad<dim> &load,
               const Deformed      &point,
               LocalSystem<dim>    &system) const = 0;

    private:
      void
      add_point(const unsigned int       p,
                const SplineValues<dim> &splines,
                const LocalField<dim>   &field,
                LocalSystem<dim>        &system) const override
      {
        // A point whose step turns it inside out has no area, so the state has
        // no energy.
        const Tensor<2, dim> f = field.step_deformation(splines);
        const double         J = determinant(f);
        if (J <= 0.)
          system.inverted = true;
        else
          add_load(loads[p], {splines, J, invert(f)}, system);
      }

      const std::vector<AreaLoad<dim>> loads;
    };

    template <int dim>
    class FollowingPressure : public AreaTerm<dim>
    {
    public:
      using AreaTerm<dim>::AreaTerm;

      bool
      is_conservative() const override
      {
        return false;
      }

    private:
      /** p > 0 pushes inward. */
      void
      add_load(const AreaLoad<dim>                    &load,
               const typename AreaTerm<dim>::Deformed &point,
               LocalSystem<dim>                       &system) const override
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
    };

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


    template <int dim>
    class SurfaceEnergy : public AreaTerm<dim>
    {
    public:
      /** @param smoothing ε, in the unit of the loads' areas; 0: none */
      SurfaceEnergy(GroupedPoints<dim>         points,
                    std::vector<AreaLoad<dim>> loads,
                    const double               smoothing = 0.)
        : AreaTerm<dim>(std::move(points), std::move(loads))
        , smoothing(smoothing)
      {}

    private:
      void
      add_load(const AreaLoad<dim>                    &load,
               const typename AreaTerm<dim>::Deformed &point,
               LocalSystem<dim>                       &system) const override
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
        const double smooth =
          smoothing > 0. ? std::hypot(size, smoothing) : size;
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
        // The energy is relative to the start of the step: the difference of
        // two large constants would lose its digits.
        const double before =
          load.value * (smoothing > 0. ?
                          std::hypot(load.area.norm(), smoothing) :
                          load.area.norm());
        const double now = smoothing > 0. ? load.value * smooth : force;
        system.add_energy(now - before, now + before);
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
            system.add_force(i, a, force * s[a][i]);
      }

      const double smoothing;
    };
  } // namespace


  template <int dim>
  std::unique_ptr<Term<dim>>
  following_pressure(GroupedPoints<dim>         points,
                     std::vector<AreaLoad<dim>> loads)
  {
    return std::make_unique<FollowingPressure<dim>>(std::move(points),
                                                    std::move(loads));
  }


  template <int dim>
  std::unique_ptr<Term<dim>>
  surface_energy(GroupedPoints<dim>         points,
                 std::vector<AreaLoad<dim>> loads,
                 const double               smoothing)
  {
    return std::make_unique<SurfaceEnergy<dim>>(std::move(points),
                                                std::move(loads),
                                                smoothing);
  }


  MORULA_INSTANTIATE(following_pressure);
  MORULA_INSTANTIATE(surface_energy);
} // namespace Morula
