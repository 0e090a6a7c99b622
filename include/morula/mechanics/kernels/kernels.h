// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// No guard: each file that includes this defines MORULA_KERNELS, the namespace,
// and MORULA_LANES, the doubles in a register of its instruction set. Debian's
// deal.II has a VectorizedArray of one lane, so these are the compiler's own
// vector types (GCC, Clang). No standard headers here: their inline functions,
// compiled for this instruction set, could end up in other files.

#include <morula/mechanics/kernels/lanes.h>
#include <morula/mechanics/kernels/rank_updates.h>
#include <morula/mechanics/vector_kernels.h>

namespace Morula
{
  namespace MORULA_KERNELS
  {
    /** Products of one-dimensional splines in all directions but x. */
    template <int dim>
    constexpr unsigned int n_yz = dim == 2 ? 3 : 9;

    /** As many points as there are lanes, one in each. */
    template <int dim>
    struct Points
    {
      Lanes N[dim][3], dN[dim][3]; // one-dimensional splines, by direction
      Lanes A[dim][dim], W, lambda, mu;
      Lanes F_e[dim][dim], f_inverse[dim][dim], det_f, J, log_J;
    };

    /** The lanes behind the last point repeat it with W = 0. */
    template <int dim>
    MORULA_INLINE void
    load(const KernelInput &input,
         const unsigned int first,
         Points<dim>       &points)
    {
      constexpr unsigned int n_state = dim * dim + 1;
      Numbers                xi[dim], A[dim][dim], W, lambda, mu;
      for (unsigned int l = 0; l < lanes; ++l)
        {
          const bool          exists = first + l < input.n;
          const unsigned int  p      = exists ? first + l : input.n - 1;
          const double *const state  = input.states + n_state * p;
          for (unsigned int d = 0; d < dim; ++d)
            {
              xi[d][l] = input.xi[dim * p + d];
              for (unsigned int e = 0; e < dim; ++e)
                A[d][e][l] = state[dim * d + e];
            }
          W[l]      = exists ? state[dim * dim] : 0.;
          lambda[l] = input.lame[input.lame_stride * p];
          mu[l]     = input.lame[input.lame_stride * p + 1];
        }
      points.W      = W;
      points.lambda = lambda;
      points.mu     = mu;
      for (unsigned int d = 0; d < dim; ++d)
        for (unsigned int e = 0; e < dim; ++e)
          points.A[d][e] = A[d][e];
      for (unsigned int d = 0; d < dim; ++d)
        {
          const Lanes s   = xi[d];
          points.N[d][0]  = 0.5 * (1. - s) * (1. - s);
          points.N[d][1]  = 0.5 + s - s * s;
          points.N[d][2]  = 0.5 * s * s;
          points.dN[d][0] = (s - 1.) / input.h;
          points.dN[d][1] = (1. - 2. * s) / input.h;
          points.dN[d][2] = s / input.h;
        }
    }

    /** Row i of I + grad u, direction by direction. */
    template <int dim>
    MORULA_INLINE void
    step_deformation(const Points<dim> &points,
                     const double      *coefficients,
                     const unsigned int i,
                     Lanes (&f)[dim])
    {
      for (unsigned int j = 0; j < dim; ++j)
        f[j] = all(i == j ? 1. : 0.);
      for (unsigned int z = 0; z < n_yz<dim> / 3; ++z)
        {
          Lanes x_part = {}, y_part = {}, value = {};
          for (unsigned int y = 0; y < 3; ++y)
            {
              const double *const c =
                coefficients + 3 * (n_yz<dim> * i + 3 * z + y);
              const auto &N = points.N[0], &dN = points.dN[0];
              const Lanes v = N[0] * c[0] + N[1] * c[1] + N[2] * c[2];
              x_part +=
                points.N[1][y] * (dN[0] * c[0] + dN[1] * c[1] + dN[2] * c[2]);
              y_part += points.dN[1][y] * v;
              value += points.N[1][y] * v;
            }
          if constexpr (dim == 2)
            {
              f[0] += x_part;
              f[1] += y_part;
            }
          else
            {
              f[0] += points.N[2][z] * x_part;
              f[1] += points.N[2][z] * y_part;
              f[2] += points.dN[2][z] * value;
            }
        }
    }

    /** det f and f⁻¹ of the points from the splines' coefficients. */
    template <int dim>
    MORULA_INLINE void
    deform(const double *coefficients, Points<dim> &points)
    {
      Lanes f[dim][dim];
      for (unsigned int i = 0; i < dim; ++i)
        step_deformation(points, coefficients, i, f[i]);
      points.det_f = invert(f, points.f_inverse);
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          {
            points.F_e[i][j] = f[i][0] * points.A[0][j];
            for (unsigned int k = 1; k < dim; ++k)
              points.F_e[i][j] += f[i][k] * points.A[k][j];
          }
      Lanes unused[dim][dim];
      points.J     = invert(points.F_e, unused);
      points.log_J = logarithm(points.J);
    }

    /** False if a point is inverted. */
    template <int dim>
    MORULA_INLINE bool
    admit(const Points<dim> &points,
          const unsigned int first,
          KernelResult      &result)
    {
      const Numbers det_f = points.det_f, J_e = points.J;
      for (unsigned int l = 0; l < lanes; ++l)
        {
          const double J =
            det_f[l] > 0. || J_e[l] < det_f[l] ? J_e[l] : det_f[l];
          if (!(J >= result.smallest_J))
            {
              result.smallest_J = J;
              result.at         = first + l;
            }
        }
      return result.smallest_J > 0.;
    }

    /**
     * The gradients of the splines, times a row M of a matrix from the left,
     * are Nx[x] first[yz] + dNx[x] second[yz]: sum factorisation.
     */
    template <int dim>
    MORULA_INLINE void
    factors(const Points<dim> &points,
            const Lanes (&M)[dim],
            Lanes (&first)[n_yz<dim>],
            Lanes (&second)[n_yz<dim>])
    {
      for (unsigned int yz = 0; yz < n_yz<dim>; ++yz)
        {
          const Lanes &N = points.N[1][yz % 3], &dN = points.dN[1][yz % 3];
          if constexpr (dim == 2)
            {
              first[yz]  = M[1] * dN;
              second[yz] = M[0] * N;
            }
          else
            {
              const Lanes &Nz = points.N[2][yz / 3];
              first[yz]  = M[1] * (dN * Nz) + M[2] * (N * points.dN[2][yz / 3]);
              second[yz] = M[0] * (N * Nz);
            }
        }
    }

    /** Column j of M, by @p scale. */
    template <int dim>
    MORULA_INLINE void
    column(const Lanes (&M)[dim][dim],
           const unsigned int j,
           const Lanes       &scale,
           Lanes (&result)[dim])
    {
      for (unsigned int i = 0; i < dim; ++i)
        result[i] = scale * M[i][j];
    }

    /** W τ, W τ f⁻ᵀ, and the energies. */
    template <int dim>
    MORULA_INLINE void
    stress(const Points<dim> &points,
           Lanes (&tau)[dim][dim],
           Lanes (&P)[dim][dim],
           Lanes (&energies)[2])
    {
      Lanes trace = {};
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          {
            Lanes b = {};
            for (unsigned int k = 0; k < dim; ++k)
              b += points.F_e[i][k] * points.F_e[j][k];
            tau[i][j] = points.W * points.mu * b;
            if (i == j)
              {
                trace += b;
                tau[i][j] +=
                  points.W * (points.lambda * points.log_J - points.mu);
              }
          }
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          {
            P[i][j] = tau[i][0] * points.f_inverse[j][0];
            for (unsigned int k = 1; k < dim; ++k)
              P[i][j] += tau[i][k] * points.f_inverse[j][k];
          }
      const Lanes size       = magnitude(points.log_J);
      const Lanes volumetric = points.lambda * size * size;
      energies[0] +=
        0.5 * points.W *
        (volumetric + points.mu * (trace - 1. * dim - 2. * points.log_J));
      energies[1] += 0.5 * points.W *
                     (volumetric + points.mu * (trace + 1. * dim + 2. * size));
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

    /** Energy and residual of a grid cell: doc/theory.md (2.4). */
    template <int dim>
    inline KernelResult
    residual(const KernelInput &input, double *target, double *magnitudes)
    {
      KernelResult result;
      result.smallest_J = __builtin_inf();
      Sums<dim> sums = {}, sizes = {};
      Lanes     energies[2] = {};
      for (unsigned int p = 0; p < input.n; p += lanes)
        {
          Points<dim> points;
          load(input, p, points);
          deform(input.coefficients, points);
          if (!admit(points, p, result))
            return result;
          Lanes tau[dim][dim], P[dim][dim], first[n_yz<dim>], second[n_yz<dim>];
          stress(points, tau, P, energies);
          if (magnitudes != nullptr)
            add_magnitudes<dim>(points, tau, sizes);
          for (unsigned int i = 0; i < dim; ++i)
            {
              factors(points, P[i], first, second);
              for (unsigned int yz = 0; yz < n_yz<dim>; ++yz)
                for (unsigned int x = 0; x < 3; ++x)
                  sums[i][yz][x] +=
                    points.N[0][x] * first[yz] + points.dN[0][x] * second[yz];
            }
        }
      add_sums<dim>(sums, target);
      if (magnitudes != nullptr)
        add_sums<dim>(sizes, magnitudes);
      result.energy           = sum(energies[0]);
      result.energy_magnitude = sum(energies[1]);
      return result;
    }

    /** The rows of the rank updates of these points. */
    template <int dim>
    MORULA_INLINE void
    make_rows(const Points<dim> &points,
              const unsigned int n,
              PointRows<dim>    *rows)
    {
      // g = f⁻ᵀ ∇N, and m = √(W μ) Aᵀ ∇N with m_a · m_b = W μ g_a · b_e g_b.
      const Lanes root = square_root(points.W * points.mu);
      Lanes first[2 * dim][n_yz<dim>], second[2 * dim][n_yz<dim>], row[dim];
      for (unsigned int i = 0; i < dim; ++i)
        {
          column(points.f_inverse, i, all(1.), row);
          factors(points, row, first[i], second[i]);
          column(points.A, i, root, row);
          factors(points, row, first[dim + i], second[dim + i]);
        }
      const Numbers c1 = points.W * points.lambda;
      const Numbers c2 = points.W * (points.mu - points.lambda * points.log_J);
      Numbers N[3], dN[3], one[2 * dim][n_yz<dim>], other[2 * dim][n_yz<dim>];
      for (unsigned int x = 0; x < 3; ++x)
        {
          N[x]  = points.N[0][x];
          dN[x] = points.dN[0][x];
        }
      for (unsigned int i = 0; i < 2 * dim; ++i)
        for (unsigned int yz = 0; yz < n_yz<dim>; ++yz)
          {
            one[i][yz]   = first[i][yz];
            other[i][yz] = second[i][yz];
          }
      for (unsigned int l = 0; l < n; ++l)
        {
          const Quad Nx  = {N[0][l], N[1][l], N[2][l], 0.};
          const Quad dNx = {dN[0][l], dN[1][l], dN[2][l], 0.};
          for (unsigned int i = 0; i < dim; ++i)
            for (unsigned int yz = 0; yz < n_yz<dim>; ++yz)
              {
                // The zero is overwritten by the next three.
                *reinterpret_cast<QuadInMemory *>(&rows[l].g[i][3 * yz]) =
                  one[i][yz][l] * Nx + other[i][yz][l] * dNx;
                *reinterpret_cast<QuadInMemory *>(&rows[l].m[i][3 * yz]) =
                  one[dim + i][yz][l] * Nx + other[dim + i][yz][l] * dNx;
              }
        }
      for (unsigned int l = 0; l < n; ++l)
        rows[l].scale(c1[l], c2[l]);
    }

    /** Tangent of a grid cell: doc/theory.md (2.5). */
    template <int dim>
    inline KernelResult
    tangent(const KernelInput &input, double *matrix)
    {
      KernelResult result;
      result.smallest_J = __builtin_inf();
      Blocks<dim>    blocks;
      PointRows<dim> rows[lanes] = {}; // also what stands behind the last entry
      for (unsigned int p = 0; p < input.n; p += lanes)
        {
          Points<dim> points;
          load(input, p, points);
          deform(input.coefficients, points);
          if (!admit(points, p, result))
            return result;
          const unsigned int n = input.n - p < lanes ? input.n - p : lanes;
          make_rows(points, n, rows);
          blocks.update(rows, n);
        }
      blocks.add_to(matrix);
      return result;
    }
  } // namespace MORULA_KERNELS
} // namespace Morula
