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
    /** As many points as there are lanes, one in each. */
    struct Points
    {
      Lanes N[3][3], dN[3][3]; // one-dimensional splines, by direction
      Lanes A[3][3], W, lambda, mu;
      Lanes F_e[3][3], f_inverse[3][3], det_f, J, log_J;
    };

    /** The lanes behind the last point repeat it with W = 0. */
    MORULA_INLINE void
    load(const KernelInput &input, const unsigned int first, Points &points)
    {
      Numbers xi[3], A[3][3], W, lambda, mu;
      for (unsigned int l = 0; l < lanes; ++l)
        {
          const bool          exists = first + l < input.n;
          const unsigned int  p      = exists ? first + l : input.n - 1;
          const double *const state  = input.states + 10 * p;
          for (unsigned int d = 0; d < 3; ++d)
            {
              xi[d][l] = input.xi[3 * p + d];
              for (unsigned int e = 0; e < 3; ++e)
                A[d][e][l] = state[3 * d + e];
            }
          W[l]      = exists ? state[9] : 0.;
          lambda[l] = input.lame[input.lame_stride * p];
          mu[l]     = input.lame[input.lame_stride * p + 1];
        }
      points.W      = W;
      points.lambda = lambda;
      points.mu     = mu;
      for (unsigned int d = 0; d < 3; ++d)
        for (unsigned int e = 0; e < 3; ++e)
          points.A[d][e] = A[d][e];
      for (unsigned int d = 0; d < 3; ++d)
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
    MORULA_INLINE void
    step_deformation(const Points      &points,
                     const double      *coefficients,
                     const unsigned int i,
                     Lanes (&f)[3])
    {
      const auto &[Nx, Ny, Nz] = points.N;
      for (unsigned int j = 0; j < 3; ++j)
        f[j] = all(i == j ? 1. : 0.);
      for (unsigned int z = 0; z < 3; ++z)
        {
          Lanes x_part = {}, y_part = {}, value = {};
          for (unsigned int y = 0; y < 3; ++y)
            {
              const double *const c = coefficients + 27 * i + 9 * z + 3 * y;
              const Lanes v = Nx[0] * c[0] + Nx[1] * c[1] + Nx[2] * c[2];
              x_part +=
                Ny[y] * (points.dN[0][0] * c[0] + points.dN[0][1] * c[1] +
                         points.dN[0][2] * c[2]);
              y_part += points.dN[1][y] * v;
              value += Ny[y] * v;
            }
          f[0] += Nz[z] * x_part;
          f[1] += Nz[z] * y_part;
          f[2] += points.dN[2][z] * value;
        }
    }

    /** det f and f⁻¹ of the points from the splines' coefficients. */
    MORULA_INLINE void
    deform(const double *coefficients, Points &points)
    {
      Lanes f[3][3];
      for (unsigned int i = 0; i < 3; ++i)
        step_deformation(points, coefficients, i, f[i]);
      points.det_f = invert(f, points.f_inverse);
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          points.F_e[i][j] = f[i][0] * points.A[0][j] +
                             f[i][1] * points.A[1][j] +
                             f[i][2] * points.A[2][j];
      Lanes unused[3][3];
      points.J     = invert(points.F_e, unused);
      points.log_J = logarithm(points.J);
    }

    /** False if a point is inverted. */
    MORULA_INLINE bool
    admit(const Points &points, const unsigned int first, KernelResult &result)
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
     * The gradients of the 27 splines, times a matrix M from the left, are
     * Nx[x] first[yz] + dNx[x] second[yz] in component i: sum factorisation.
     */
    MORULA_INLINE void
    factors(const Points &points,
            const Lanes  &Mx,
            const Lanes  &My,
            const Lanes  &Mz,
            Lanes (&first)[9],
            Lanes (&second)[9])
    {
      for (unsigned int z = 0, yz = 0; z < 3; ++z)
        for (unsigned int y = 0; y < 3; ++y, ++yz)
          {
            first[yz] = My * (points.dN[1][y] * points.N[2][z]) +
                        Mz * (points.N[1][y] * points.dN[2][z]);
            second[yz] = Mx * (points.N[1][y] * points.N[2][z]);
          }
    }

    /** W τ, W τ f⁻ᵀ, and the energies. */
    MORULA_INLINE void
    stress(const Points &points,
           Lanes (&tau)[3][3],
           Lanes (&P)[3][3],
           Lanes (&energies)[2])
    {
      Lanes trace = {};
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          {
            Lanes b = {};
            for (unsigned int k = 0; k < 3; ++k)
              b += points.F_e[i][k] * points.F_e[j][k];
            tau[i][j] = points.W * points.mu * b;
            if (i == j)
              {
                trace += b;
                tau[i][j] +=
                  points.W * (points.lambda * points.log_J - points.mu);
              }
          }
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          P[i][j] = tau[i][0] * points.f_inverse[j][0] +
                    tau[i][1] * points.f_inverse[j][1] +
                    tau[i][2] * points.f_inverse[j][2];
      const Lanes size       = magnitude(points.log_J);
      const Lanes volumetric = points.lambda * size * size;
      energies[0] +=
        0.5 * points.W *
        (volumetric + points.mu * (trace - 3. - 2. * points.log_J));
      energies[1] +=
        0.5 * points.W * (volumetric + points.mu * (trace + 3. + 2. * size));
    }

    /** Adds |W τ_ij| |g_a^j| summed over j, g = f⁻ᵀ ∇N, to 81 sums. */
    MORULA_INLINE void
    add_magnitudes(const Points &points,
                   const Lanes (&tau)[3][3],
                   Lanes (&sums)[3][9][3])
    {
      Lanes first[9], second[9];
      for (unsigned int j = 0; j < 3; ++j)
        {
          const auto &F = points.f_inverse;
          factors(points, F[0][j], F[1][j], F[2][j], first, second);
          for (unsigned int yz = 0; yz < 9; ++yz)
            for (unsigned int x = 0; x < 3; ++x)
              {
                const Lanes g = magnitude(points.N[0][x] * first[yz] +
                                          points.dN[0][x] * second[yz]);
                for (unsigned int i = 0; i < 3; ++i)
                  sums[i][yz][x] += magnitude(tau[i][j]) * g;
              }
        }
    }

    /** Adds the lanes' sums to the residual in @p target. */
    MORULA_INLINE void
    add_sums(const Lanes (&sums)[3][9][3], double *target)
    {
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int yz = 0; yz < 9; ++yz)
          for (unsigned int x = 0; x < 3; ++x)
            target[27 * i + 3 * yz + x] += sum(sums[i][yz][x]);
    }

    /** Energy and residual of a grid cell: doc/theory.md (2.4). */
    inline KernelResult
    residual(const KernelInput &input, double *target, double *magnitudes)
    {
      KernelResult result;
      result.smallest_J   = __builtin_inf();
      Lanes sums[3][9][3] = {}, sizes[3][9][3] = {}, energies[2] = {};
      for (unsigned int p = 0; p < input.n; p += lanes)
        {
          Points points;
          load(input, p, points);
          deform(input.coefficients, points);
          if (!admit(points, p, result))
            return result;
          Lanes tau[3][3], P[3][3], first[9], second[9];
          stress(points, tau, P, energies);
          if (magnitudes != nullptr)
            add_magnitudes(points, tau, sizes);
          for (unsigned int i = 0; i < 3; ++i)
            {
              factors(points, P[i][0], P[i][1], P[i][2], first, second);
              for (unsigned int yz = 0; yz < 9; ++yz)
                for (unsigned int x = 0; x < 3; ++x)
                  sums[i][yz][x] +=
                    points.N[0][x] * first[yz] + points.dN[0][x] * second[yz];
            }
        }
      add_sums(sums, target);
      if (magnitudes != nullptr)
        add_sums(sizes, magnitudes);
      result.energy           = sum(energies[0]);
      result.energy_magnitude = sum(energies[1]);
      return result;
    }

    /** The rows of the rank updates of these points. */
    MORULA_INLINE void
    make_rows(const Points &points, const unsigned int n, PointRows *rows)
    {
      // g = f⁻ᵀ ∇N, and m = √(W μ) Aᵀ ∇N with m_a · m_b = W μ g_a · b_e g_b.
      const Lanes root = square_root(points.W * points.mu);
      Lanes       first[6][9], second[6][9];
      for (unsigned int i = 0; i < 3; ++i)
        {
          const auto &F = points.f_inverse, &A = points.A;
          factors(points, F[0][i], F[1][i], F[2][i], first[i], second[i]);
          factors(points,
                  root * A[0][i],
                  root * A[1][i],
                  root * A[2][i],
                  first[3 + i],
                  second[3 + i]);
        }
      const Numbers c1 = points.W * points.lambda;
      const Numbers c2 = points.W * (points.mu - points.lambda * points.log_J);
      Numbers       N[3], dN[3], one[6][9], other[6][9];
      for (unsigned int x = 0; x < 3; ++x)
        {
          N[x]  = points.N[0][x];
          dN[x] = points.dN[0][x];
        }
      for (unsigned int i = 0; i < 6; ++i)
        for (unsigned int yz = 0; yz < 9; ++yz)
          {
            one[i][yz]   = first[i][yz];
            other[i][yz] = second[i][yz];
          }
      for (unsigned int l = 0; l < n; ++l)
        {
          const Quad Nx  = {N[0][l], N[1][l], N[2][l], 0.};
          const Quad dNx = {dN[0][l], dN[1][l], dN[2][l], 0.};
          for (unsigned int i = 0; i < 3; ++i)
            for (unsigned int yz = 0; yz < 9; ++yz)
              {
                // The zero is overwritten by the next three.
                *reinterpret_cast<QuadInMemory *>(&rows[l].g[i][3 * yz]) =
                  one[i][yz][l] * Nx + other[i][yz][l] * dNx;
                *reinterpret_cast<QuadInMemory *>(&rows[l].m[i][3 * yz]) =
                  one[3 + i][yz][l] * Nx + other[3 + i][yz][l] * dNx;
              }
        }
      for (unsigned int l = 0; l < n; ++l)
        rows[l].scale(c1[l], c2[l]);
    }

    /** Tangent of a grid cell: doc/theory.md (2.5). */
    inline KernelResult
    tangent(const KernelInput &input, double *matrix)
    {
      KernelResult result;
      result.smallest_J = __builtin_inf();
      Blocks    blocks;
      PointRows rows[lanes] = {}; // also what stands behind the 27 entries
      for (unsigned int p = 0; p < input.n; p += lanes)
        {
          Points points;
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
