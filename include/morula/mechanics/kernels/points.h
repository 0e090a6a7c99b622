// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// See kernels.h. Registers of numbers; points of a grid cell, their splines and
// deformations; and how they move in a step.

namespace Morula
{
  namespace MORULA_KERNELS
  {
    constexpr unsigned int lanes = MORULA_LANES;

    /** A register of numbers, one for each of as many points. */
    using Lanes = double __attribute__((vector_size(sizeof(double) * lanes)));

    /** Such a register where it stands among single numbers in memory. */
    using LanesInMemory =
      double __attribute__((vector_size(sizeof(double) * lanes), may_alias));

    /** A register of doubles, or of twice as many singles. */
    template <typename Real>
    struct Register
    {
      /** Numbers in it. */
      static constexpr unsigned int n = lanes * sizeof(double) / sizeof(Real);

      using Type __attribute__((vector_size(n * sizeof(Real)))) = Real;

      /** Such a register where it stands among single numbers in memory. */
      using InMemory __attribute__((vector_size(n * sizeof(Real)), may_alias)) =
        Real;

      /** Three numbers and a zero: a quarter more work, but no remainder. */
      using Quad __attribute__((vector_size(4 * sizeof(Real)))) = Real;

      /** A Quad at any address. */
      using QuadInMemory __attribute__((vector_size(4 * sizeof(Real)),
                                        aligned(sizeof(Real)),
                                        may_alias)) = Real;
    };

    /** A register that has one number in all places. */
    template <typename Real>
    MORULA_INLINE typename Register<Real>::Type
    all(const Real x)
    {
      // x - 0 is exactly x, also for x = -0, so the compiler leaves it out; x +
      // 0 would stay.
      return x - typename Register<Real>::Type{};
    }

    /** A register in memory, where its numbers are read and written singly. */
    struct Numbers
    {
      alignas(64) double value[lanes];

      Numbers() = default;

      MORULA_INLINE
      Numbers(const Lanes &x)
      {
        *reinterpret_cast<LanesInMemory *>(value) = x;
      }

      MORULA_INLINE
      operator Lanes() const
      {
        return *reinterpret_cast<const LanesInMemory *>(value);
      }

      MORULA_INLINE double &
      operator[](const unsigned int l)
      {
        return value[l];
      }

      MORULA_INLINE double
      operator[](const unsigned int l) const
      {
        return value[l];
      }
    };

    /** The square roots. */
    MORULA_INLINE Lanes
    square_root(const Lanes &x)
    {
      Numbers y = x;
      for (unsigned int l = 0; l < lanes; ++l)
        y[l] = __builtin_sqrt(y[l]);
      return y;
    }

    /** The sum of all lanes. */
    MORULA_INLINE double
    sum(const Lanes &numbers)
    {
      const Numbers x      = numbers;
      double        result = 0.;
      for (unsigned int l = 0; l < lanes; ++l)
        result += x[l];
      return result;
    }

    /** The determinant of M, and its inverse. */
    MORULA_INLINE Lanes
    invert(const Lanes (&M)[3][3], Lanes (&inverse)[3][3])
    {
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          {
            const unsigned int i1 = (j + 1) % 3, i2 = (j + 2) % 3;
            const unsigned int j1 = (i + 1) % 3, j2 = (i + 2) % 3;
            inverse[i][j] = M[i1][j1] * M[i2][j2] - M[i1][j2] * M[i2][j1];
          }
      const Lanes determinant = M[0][0] * inverse[0][0] +
                                M[0][1] * inverse[1][0] +
                                M[0][2] * inverse[2][0];
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          inverse[i][j] /= determinant;
      return determinant;
    }

    /** Inverts matrices of the plane, and returns their determinants. */
    MORULA_INLINE Lanes
    invert(const Lanes (&M)[2][2], Lanes (&inverse)[2][2])
    {
      const Lanes determinant = M[0][0] * M[1][1] - M[0][1] * M[1][0];
      inverse[0][0]           = M[1][1] / determinant;
      inverse[0][1]           = -M[0][1] / determinant;
      inverse[1][0]           = -M[1][0] / determinant;
      inverse[1][1]           = M[0][0] / determinant;
      return determinant;
    }

    /** Products of one-dimensional splines in all directions but x. */
    template <int dim>
    constexpr unsigned int n_yz = dim == 2 ? 3 : 9;

    /** As many points as there are lanes, one in each. */
    template <int dim>
    struct Points
    {
      Lanes N[dim][3], dN[dim][3]; // one-dimensional splines, by direction
      Lanes A[dim][dim], W, lambda, mu, carried;
      Lanes F_e[dim][dim], f_inverse[dim][dim], det_f, J, log_J;
    };

    /** The one-dimensional splines at places in the grid cell. */
    template <int dim>
    MORULA_INLINE void
    find_splines(const Lanes (&xi)[dim], const double h, Points<dim> &points)
    {
      for (unsigned int d = 0; d < dim; ++d)
        {
          const Lanes s   = xi[d];
          points.N[d][0]  = 0.5 * (1. - s) * (1. - s);
          points.N[d][1]  = 0.5 + s - s * s;
          points.N[d][2]  = 0.5 * s * s;
          points.dN[d][0] = (s - 1.) / h;
          points.dN[d][1] = (1. - 2. * s) / h;
          points.dN[d][2] = s / h;
        }
    }

    /** The lanes behind the last point repeat it with W = 0, c = 0. */
    template <int dim>
    MORULA_INLINE void
    load(const KernelInput &input,
         const unsigned int first,
         Points<dim>       &points)
    {
      constexpr unsigned int n_state = dim * dim + 1;
      Numbers                xi[dim], A[dim][dim], W, lambda, mu, carried;
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
          W[l] = exists ? state[dim * dim] : 0.;
          carried[l] =
            exists && input.carried != nullptr ? input.carried[p] : 0.;
          lambda[l] = input.lame[input.lame_stride * p];
          mu[l]     = input.lame[input.lame_stride * p + 1];
        }
      points.W       = W;
      points.lambda  = lambda;
      points.mu      = mu;
      points.carried = carried;
      for (unsigned int d = 0; d < dim; ++d)
        for (unsigned int e = 0; e < dim; ++e)
          points.A[d][e] = A[d][e];
      Lanes places[dim];
      for (unsigned int d = 0; d < dim; ++d)
        places[d] = xi[d];
      find_splines(places, input.h, points);
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

    /** Component i of the displacement. */
    template <int dim>
    MORULA_INLINE Lanes
    displacement(const Points<dim> &points,
                 const double      *coefficients,
                 const unsigned int i)
    {
      Lanes u = {};
      for (unsigned int z = 0; z < n_yz<dim> / 3; ++z)
        {
          Lanes value = {};
          for (unsigned int y = 0; y < 3; ++y)
            {
              const double *const c =
                coefficients + 3 * (n_yz<dim> * i + 3 * z + y);
              const auto &N = points.N[0];
              value +=
                points.N[1][y] * (N[0] * c[0] + N[1] * c[1] + N[2] * c[2]);
            }
          if constexpr (dim == 2)
            u += value;
          else
            u += points.N[2][z] * value;
        }
      return u;
    }

    /** See FindMotions. */
    template <int dim>
    inline void
    find_motions(const KernelInput &input, double *motions)
    {
      constexpr unsigned int n_numbers = dim + dim * dim;
      for (unsigned int first = 0; first < input.n; first += lanes)
        {
          const unsigned int n =
            input.n - first < lanes ? input.n - first : lanes;
          Numbers xi[dim];
          for (unsigned int l = 0; l < lanes; ++l)
            for (unsigned int d = 0; d < dim; ++d)
              xi[d][l] = input.xi[dim * (first + (l < n ? l : 0)) + d];
          Lanes places[dim];
          for (unsigned int d = 0; d < dim; ++d)
            places[d] = xi[d];
          Points<dim> points;
          find_splines(places, input.h, points);
          Numbers numbers[n_numbers];
          for (unsigned int i = 0; i < dim; ++i)
            {
              numbers[i] = displacement(points, input.coefficients, i);
              Lanes f[dim];
              step_deformation(points, input.coefficients, i, f);
              for (unsigned int j = 0; j < dim; ++j)
                numbers[dim + dim * i + j] = f[j];
            }
          for (unsigned int l = 0; l < n; ++l)
            for (unsigned int k = 0; k < n_numbers; ++k)
              motions[n_numbers * (first + l) + k] = numbers[k][l];
        }
    }
  } // namespace MORULA_KERNELS
} // namespace Morula
