// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// See kernels.h. Energy and residual of a grid cell.

namespace Morula
{
  namespace MORULA_KERNELS
  {
    /** What a law sees of the points. */
    template <int dim>
    MORULA_INLINE Strain<Lanes>
                  strain(const Points<dim> &points)
    {
      Lanes trace = {};
      for (unsigned int i = 0; i < dim; ++i)
        {
          Lanes b = {};
          for (unsigned int k = 0; k < dim; ++k)
            b += points.F_e[i][k] * points.F_e[i][k];
          trace += b;
        }
      return {trace - 1. * dim,
              trace + 1. * dim,
              points.J,
              points.log_J,
              points.log_J,
              points.lambda,
              points.mu};
    }

    /** W τ = W (α (b_e - I) + γ I) and W τ f⁻ᵀ. */
    template <int dim>
    MORULA_INLINE void
    stress(const Points<dim> &points,
           const Lanes       &alpha,
           const Lanes       &gamma,
           Lanes (&tau)[dim][dim],
           Lanes (&P)[dim][dim])
    {
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          {
            Lanes b = {};
            for (unsigned int k = 0; k < dim; ++k)
              b += points.F_e[i][k] * points.F_e[j][k];
            tau[i][j] = points.W * alpha * b;
            if (i == j)
              tau[i][j] += points.W * (gamma - alpha);
          }
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          {
            P[i][j] = tau[i][0] * points.f_inverse[j][0];
            for (unsigned int k = 1; k < dim; ++k)
              P[i][j] += tau[i][k] * points.f_inverse[j][k];
          }
    }

    /** One number for each component and spline. */
    template <int dim>
    using Sums = Lanes[dim][n_yz<dim>][3];

    /** Adds |W τ_ij| |g_a^j| summed over j, g = f⁻ᵀ ∇N. */
    template <int dim>
    MORULA_INLINE void
    add_magnitudes(const Points<dim> &points,
                   const Lanes (&tau)[dim][dim],
                   Sums<dim> &sums)
    {
      Lanes row[dim], first[n_yz<dim>], second[n_yz<dim>];
      for (unsigned int j = 0; j < dim; ++j)
        {
          column(points.f_inverse, j, all(1.), row);
          factors(points, row, first, second);
          for (unsigned int yz = 0; yz < n_yz<dim>; ++yz)
            for (unsigned int x = 0; x < 3; ++x)
              {
                const Lanes g = magnitude(points.N[0][x] * first[yz] +
                                          points.dN[0][x] * second[yz]);
                for (unsigned int i = 0; i < dim; ++i)
                  sums[i][yz][x] += magnitude(tau[i][j]) * g;
              }
        }
    }

    /** Adds M ∇N, row by row. */
    template <int dim>
    MORULA_INLINE void
    add_gradients(const Points<dim> &points,
                  const Lanes (&M)[dim][dim],
                  Sums<dim> &sums)
    {
      Lanes first[n_yz<dim>], second[n_yz<dim>];
      for (unsigned int i = 0; i < dim; ++i)
        {
          factors(points, M[i], first, second);
          for (unsigned int yz = 0; yz < n_yz<dim>; ++yz)
            for (unsigned int x = 0; x < 3; ++x)
              sums[i][yz][x] +=
                points.N[0][x] * first[yz] + points.dN[0][x] * second[yz];
        }
    }

    /** Adds the lanes' sums to the residual in @p target. */
    template <int dim>
    MORULA_INLINE void
    add_sums(const Sums<dim> &sums, double *target)
    {
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int yz = 0; yz < n_yz<dim>; ++yz)
          for (unsigned int x = 0; x < 3; ++x)
            target[3 * (n_yz<dim> * i + yz) + x] += sum(sums[i][yz][x]);
    }

    /** The volume of a pool's points, doc/theory.md (2.6), (2.8b). */
    template <int dim>
    struct VolumeSums
    {
      Lanes     v         = {};
      Sums<dim> gradients = {};

      /** Adds points. */
      MORULA_INLINE void
      add(const Points<dim> &points, const bool pressed)
      {
        const Lanes volume =
          pressed ? points.carried : points.carried * points.det_f;
        Lanes M[dim][dim];
        for (unsigned int i = 0; i < dim; ++i)
          column(points.f_inverse, i, volume, M[i]);
        v += pressed ? volume * logarithm(points.det_f) : volume;
        add_gradients(points, M, gradients);
      }

      /** Adds the sums over the lanes to a pool's. */
      MORULA_INLINE void
      add_to(KernelVolume &volume) const
      {
        volume.v += sum(v);
        add_sums<dim>(gradients, volume.gradients);
      }
    };

    /** Energy and residual of a grid cell, doc/theory.md (2.4), or of the
     *  distortional part alone of a pool, and its volume. */
    template <int dim, typename Law, bool pooled>
    MORULA_INLINE KernelResult
    residual(const KernelInput &input,
             double            *target,
             double            *magnitudes,
             KernelVolume      *volume)
    {
      KernelResult result;
      result.smallest_J    = __builtin_inf();
      Sums<dim>       sums = {}, sizes = {};
      Lanes           energies[2] = {};
      VolumeSums<dim> volumes;
      const Law      &law = *static_cast<const Law *>(input.law);
      for (unsigned int p = 0; p < input.n; p += lanes)
        {
          Points<dim> points;
          load(input, p, points);
          deform(input.coefficients, points);
          if (!admit(points, p, result))
            return result;
          const auto  r = law.response(strain(points));
          const auto &k = r.volumetric.modulus;
          Lanes       tau[dim][dim], P[dim][dim];
          Lanes       energy = r.energy, size = r.magnitude;
          if constexpr (pooled)
            volumes.add(points, volume->pressed);
          else
            {
              energy += k * r.volumetric.energy;
              size += k * r.volumetric.magnitude;
            }
          stress(points, r.alpha, pooled ? r.gamma : r.total_gamma(), tau, P);
          energies[0] += points.W * energy;
          energies[1] += points.W * size;
          if (magnitudes != nullptr)
            add_magnitudes<dim>(points, tau, sizes);
          add_gradients(points, P, sums);
        }
      add_sums<dim>(sums, target);
      if (magnitudes != nullptr)
        add_sums<dim>(sizes, magnitudes);
      if constexpr (pooled)
        volumes.add_to(*volume);
      result.energy           = sum(energies[0]);
      result.energy_magnitude = sum(energies[1]);
      return result;
    }

    /** See VectorKernels. */
    template <int dim, typename Law>
    inline KernelResult
    residual_of(const KernelInput &input,
                double            *target,
                double            *magnitudes,
                KernelVolume      *volume)
    {
      return volume == nullptr ?
               residual<dim, Law, false>(input, target, magnitudes, volume) :
               residual<dim, Law, true>(input, target, magnitudes, volume);
    }
  } // namespace MORULA_KERNELS
} // namespace Morula
