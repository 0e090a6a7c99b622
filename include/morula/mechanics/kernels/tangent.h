// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// See kernels.h. The tangent of a grid cell, by rank_updates.h.

namespace Morula
{
  namespace MORULA_KERNELS
  {
    /** The rows of matrices M, times the gradients of the splines. */
    template <int dim, typename Real, unsigned int n_rows>
    struct Rows
    {
      Numbers N[3], dN[3], first[n_rows][n_yz<dim>], second[n_rows][n_yz<dim>];

      MORULA_INLINE
      Rows(const Points<dim> &points, const Lanes (&M)[n_rows][dim])
      {
        for (unsigned int x = 0; x < 3; ++x)
          {
            N[x]  = points.N[0][x];
            dN[x] = points.dN[0][x];
          }
        for (unsigned int i = 0; i < n_rows; ++i)
          {
            Lanes one[n_yz<dim>], other[n_yz<dim>];
            factors(points, M[i], one, other);
            for (unsigned int yz = 0; yz < n_yz<dim>; ++yz)
              {
                first[i][yz]  = one[yz];
                second[i][yz] = other[yz];
              }
          }
      }

      /** Writes row i of the point in a lane, and a zero behind it. */
      MORULA_INLINE void
      write(const unsigned int i, const unsigned int lane, Real *row) const
      {
        using Quad         = typename Register<Real>::Quad;
        using QuadInMemory = typename Register<Real>::QuadInMemory;
        const auto single = [](const double x) { return static_cast<Real>(x); };
        const Quad Nx     = {single(N[0][lane]),
                             single(N[1][lane]),
                             single(N[2][lane]),
                             0};
        const Quad dNx    = {single(dN[0][lane]),
                             single(dN[1][lane]),
                             single(dN[2][lane]),
                             0};
        for (unsigned int yz = 0; yz < n_yz<dim>; ++yz)
          // The zero is overwritten by the next three.
          *reinterpret_cast<QuadInMemory *>(row + 3 * yz) =
            single(first[i][yz][lane]) * Nx + single(second[i][yz][lane]) * dNx;
      }
    };

    /** g = f⁻ᵀ ∇N, and m = √(W α) Aᵀ ∇N with m_a · m_b = W α g_a · b_e g_b, as
     *  the first and the next rows of matrices. */
    template <int dim, unsigned int n_rows>
    MORULA_INLINE void
    gradient_matrices(const Points<dim> &points,
                      const Lanes       &alpha,
                      Lanes (&M)[n_rows][dim])
    {
      const Lanes root = square_root(points.W * alpha);
      for (unsigned int i = 0; i < dim; ++i)
        {
          column(points.f_inverse, i, all(1.), M[i]);
          column(points.A, i, root, M[dim + i]);
        }
    }

    /** The rows of the rank updates of these points. @param of_A is added to
     *  W A, and @p of_gamma to W γ. A law with B and C has b_e g = F_e Aᵀ ∇N as
     *  well. */
    template <int dim, typename LawsResponse, typename Point>
    MORULA_INLINE void
    make_rows(const Points<dim>  &points,
              const LawsResponse &r,
              const Lanes        &A,
              const Lanes        &gamma,
              const Lanes        &of_A,
              const Lanes        &of_gamma,
              const unsigned int  n,
              Point              *rows)
    {
      constexpr unsigned int n_rows = (Point::coupled ? 3 : 2) * dim;
      Lanes                  M[n_rows][dim];
      gradient_matrices(points, r.alpha, M);
      if constexpr (Point::coupled)
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int k = 0; k < dim; ++k)
            {
              M[2 * dim + i][k] = points.F_e[i][0] * points.A[k][0];
              for (unsigned int l = 1; l < dim; ++l)
                M[2 * dim + i][k] += points.F_e[i][l] * points.A[k][l];
            }
      const Rows<dim, typename Point::Real, n_rows> all_rows(points, M);
      for (unsigned int l = 0; l < n; ++l)
        for (unsigned int i = 0; i < dim; ++i)
          {
            all_rows.write(i, l, rows[l].g[i]);
            all_rows.write(dim + i, l, rows[l].m[i]);
            if constexpr (Point::coupled)
              all_rows.write(2 * dim + i, l, rows[l].b_g[i]);
          }
      const Numbers W_A = points.W * A + of_A,
                    W_c = points.W * (r.alpha - gamma) - of_gamma;
      if constexpr (Point::coupled)
        {
          const Numbers W_B = points.W * r.B, W_C = points.W * r.C;
          for (unsigned int l = 0; l < n; ++l)
            rows[l].scale(W_A[l], W_c[l], W_B[l], W_C[l]);
        }
      else
        for (unsigned int l = 0; l < n; ++l)
          rows[l].scale(W_A[l], W_c[l]);
    }

    /** Type of the numbers that a law's tangent needs of a point. */
    template <int dim, typename Real, bool coupled>
    struct RowsOfLaw
    {
      using Type = PointRows<dim, Real>;
    };
    /** A coupled law needs the rows with b_e g, too. */
    template <int dim, typename Real>
    struct RowsOfLaw<dim, Real, true>
    {
      using Type = CoupledPointRows<dim, Real>;
    };

    /** Tangent of a grid cell: doc/theory.md (2.5); of a pool without the first
     *  term of (2.8). Deformations and the law are in double precision, the
     * sums of products of type Real. */
    template <int dim, typename Law, bool pooled, typename Real>
    MORULA_INLINE KernelResult
    tangent(const KernelInput    &input,
            const PressureOfPool *pressure,
            double               *matrix)
    {
      KernelResult result;
      result.smallest_J = __builtin_inf();
      Blocks<dim, Real> blocks;
      // Zeros stand behind the last entry, too, where registers read past it.
      typename RowsOfLaw<dim, Real, is_coupled<Law>>::Type rows[lanes] = {};
      const Law &law = *static_cast<const Law *>(input.law);
      for (unsigned int p = 0; p < input.n; p += lanes)
        {
          Points<dim> points;
          load(input, p, points);
          deform(input.coefficients, points);
          if (!admit(points, p, result))
            return result;
          const auto         r = law.response(strain(points));
          const unsigned int n = input.n - p < lanes ? input.n - p : lanes;
          if constexpr (pooled)
            {
              const Lanes pull = pressure->mean_stress * points.carried;
              if (pressure->pressed)
                make_rows(points, r, r.A, r.gamma, Lanes{}, pull, n, rows);
              else
                make_rows(points,
                          r,
                          r.A,
                          r.gamma,
                          pull * points.det_f,
                          pull * points.det_f,
                          n,
                          rows);
            }
          else
            make_rows(points,
                      r,
                      r.total_A(),
                      r.total_gamma(),
                      Lanes{},
                      Lanes{},
                      n,
                      rows);
          blocks.update(rows, n);
        }
      blocks.add_to(matrix);
      return result;
    }

    /** See VectorKernels. */
    template <int dim, typename Law, typename Real>
    inline KernelResult
    tangent_of(const KernelInput    &input,
               const PressureOfPool *pressure,
               double               *matrix)
    {
      return pressure != nullptr ?
               tangent<dim, Law, true, Real>(input, pressure, matrix) :
               tangent<dim, Law, false, Real>(input, pressure, matrix);
    }
  } // namespace MORULA_KERNELS
} // namespace Morula
