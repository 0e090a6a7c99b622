// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// See kernels.h. Energy and residual of a grid cell.

namespace Morula
{
  namespace MORULA_KERNELS
  {
    /** What a law sees of the points. @param theta ϑ, if the grid cell has one
     */
    template <int dim>
    MORULA_INLINE Strain<Lanes>
    strain(const Points<dim> &points, const double *theta = nullptr)
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
              theta != nullptr ? all(*theta) : points.log_J,
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

    /** What (2.6) sums over points, W k, W k ln J_e and W k g, or (2.8): W k,
     *  W, V = W J_e and V g, or (2.9b): W k, V_t ln det f, V_t and V_t g. */
    template <int dim, VolumetricStrain form>
    struct VolumeSums
    {
      Lanes     modulus = {}, weights = {}, total = {};
      Sums<dim> gradients = {};

      /** Adds points with the moduli @p k. */
      MORULA_INLINE void
      add(const Points<dim> &points, const Lanes &k, const bool pressed)
      {
        constexpr bool pooled = form == VolumetricStrain::pooled;
        Lanes          weight = points.W * (pooled ? points.J : k);
        if (pooled && pressed)
          weight = weight / points.det_f;
        Lanes M[dim][dim];
        for (unsigned int i = 0; i < dim; ++i)
          column(points.f_inverse, i, weight, M[i]);
        weights += weight;
        if constexpr (pooled)
          {
            modulus += points.W * k;
            total += pressed ? weight * logarithm(points.det_f) : points.W;
          }
        else
          total += weight * points.log_J;
        add_gradients(points, M, gradients);
      }

      /** Adds the sums over the lanes to a grid cell's. */
      MORULA_INLINE void
      add_to(KernelVolume &volume) const
      {
        const double weight = sum(weights);
        volume.weight += weight;
        volume.modulus +=
          form == VolumetricStrain::pooled ? sum(modulus) : weight;
        volume.sum += sum(total);
        add_sums<dim>(gradients, volume.gradients);
      }
    };

    /** Energy and residual of a grid cell, doc/theory.md (2.4), or of the
     *  distortional part alone, and its VolumeSums. */
    template <int dim, typename Law, VolumetricStrain form>
    MORULA_INLINE KernelResult
    residual(const KernelInput &input,
             double            *target,
             double            *magnitudes,
             KernelVolume      *volume)
    {
      KernelResult result;
      result.smallest_J          = __builtin_inf();
      Sums<dim>             sums = {}, sizes = {};
      Lanes                 energies[2] = {};
      VolumeSums<dim, form> volumes;
      constexpr bool        of_grid_cell = form != VolumetricStrain::pointwise;
      const Law            &law          = *static_cast<const Law *>(input.law);
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
          if constexpr (of_grid_cell)
            volumes.add(points, k, volume->pressed);
          else
            {
              energy += k * r.volumetric.energy;
              size += k * r.volumetric.magnitude;
            }
          stress(
            points, r.alpha, of_grid_cell ? r.gamma : r.total_gamma(), tau, P);
          energies[0] += points.W * energy;
          energies[1] += points.W * size;
          if (magnitudes != nullptr)
            add_magnitudes<dim>(points, tau, sizes);
          add_gradients(points, P, sums);
        }
      add_sums<dim>(sums, target);
      if (magnitudes != nullptr)
        add_sums<dim>(sizes, magnitudes);
      if constexpr (of_grid_cell)
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
      constexpr auto pointwise = VolumetricStrain::pointwise,
                     projected = VolumetricStrain::projected,
                     pooled    = VolumetricStrain::pooled;
      if (volume == nullptr)
        return residual<dim, Law, pointwise>(input, target, magnitudes, volume);
      return volume->form == pooled ?
               residual<dim, Law, pooled>(input, target, magnitudes, volume) :
               residual<dim, Law, projected>(input, target, magnitudes, volume);
    }
  } // namespace MORULA_KERNELS
} // namespace Morula
