// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// See kernels.h.

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
  } // namespace MORULA_KERNELS
} // namespace Morula
