// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_materials_functions_h
#define morula_mechanics_materials_functions_h

// The functions that a material's law may call, on any type of numbers: double,
// a vector of the compiler (the kernels' registers) and numbers that bring
// exp(), log() and fabs() of their own, such as Sacado's. Included by files
// that are compiled for one instruction set: no standard headers, see
// kernels.h.

namespace Morula
{
  // Registers stay registers only where everything is inlined.
#define MORULA_INLINE inline __attribute__((always_inline))

  namespace NumberTypes
  {
    /** Whether two types are the same. */
    template <typename A, typename B>
    constexpr bool same = false;
    template <typename A>
    constexpr bool same<A, A> = true;

    /** The compiler's vector of n doubles. */
    template <unsigned int n>
    struct VectorOf;
    /** The vector of two doubles. */
    template <>
    struct VectorOf<2>
    {
      using Type = double __attribute__((vector_size(16)));
    };
    /** The vector of four doubles. */
    template <>
    struct VectorOf<4>
    {
      using Type = double __attribute__((vector_size(32)));
    };
    /** The vector of eight doubles. */
    template <>
    struct VectorOf<8>
    {
      using Type = double __attribute__((vector_size(64)));
    };

    template <typename Number>
    constexpr bool is_vector =
      same<Number, VectorOf<2>::Type> || same<Number, VectorOf<4>::Type> ||
      same<Number, VectorOf<8>::Type>;
  } // namespace NumberTypes

  /** The absolute value. */
  template <typename Number>
  MORULA_INLINE Number
  magnitude(const Number &x)
  {
    if constexpr (NumberTypes::same<Number, double>)
      return __builtin_fabs(x);
    else if constexpr (NumberTypes::is_vector<Number>)
      return x < 0. ? -x : x;
    else
      return fabs(x);
  }

  /**
   * ln x. For vectors, of positive normal numbers, to 2 units in the last
   * place; libm's is for one number at a time and costs more than all the rest
   * of a residual. x = 2^k m with √½ <= m < √2, and ln m = 2 artanh s, s =
   * (m-1)/(m+1).
   */
  template <typename Number>
  MORULA_INLINE Number
  logarithm(const Number &x)
  {
    if constexpr (NumberTypes::same<Number, double>)
      return __builtin_log(x);
    else if constexpr (NumberTypes::is_vector<Number>)
      {
        using Bits                    = decltype(x < x); // as many integers
        constexpr long long root_half = 0x3fe6a09e667f3bcdll; // √½
        const Bits          bits      = reinterpret_cast<Bits>(x);
        const Bits          exponent  = (bits - root_half) >> 52;
        const Bits          scaled    = bits - (exponent << 52);
        const Number        m         = reinterpret_cast<Number>(scaled);
        const Number        k = __builtin_convertvector(exponent, Number);
        const Number        s = (m - 1.) / (m + 1.), s2 = s * s;
        Number              series = 1. / 23. - Number{};
        for (int n = 21; n >= 3; n -= 2)
          series = series * s2 + 1. / n;
        return k * 0x1.62e42fefa38p-1 +
               (2. * s + (2. * s * s2 * series + k * 0x1.ef35793c7673p-45));
      }
    else
      return log(x);
  }

  namespace NumberTypes
  {
    /** e^x = power (1 + small). */
    template <typename Vector>
    struct Exponential
    {
      Vector power, small;
    };

    /** The exponential of |x| < 700, to 2 units in the last place: x is k ln 2
     *  + r with |r| <= ln 2 / 2, and e^r - 1 follows from its Taylor series. */
    template <typename Vector>
    MORULA_INLINE Exponential<Vector>
                  exponential_of(const Vector &x)
    {
      using Bits = decltype(x < x); // as many integers
      // Adding 1.5 2^52 rounds to an integer, in the last bits.
      constexpr double round   = 0x1.8p52;
      const Vector     shifted = x * 0x1.71547652b82fep0 + round;
      const Vector     k       = shifted - round;
      const Vector r = (x - k * 0x1.62e42fefa38p-1) - k * 0x1.ef35793c7673p-45;
      double       factorial = 87178291200.; // 14!
      Vector       series    = 1. / factorial - Vector{};
      for (int n = 14; n >= 3; --n)
        {
          factorial /= n;
          series = series * r + 1. / factorial;
        }
      const Bits power =
        (reinterpret_cast<Bits>(shifted) << 52) + 0x3ff0000000000000ll;
      return {reinterpret_cast<Vector>(power), r + r * r * series};
    }
  } // namespace NumberTypes

  /** e^x. */
  template <typename Number>
  MORULA_INLINE Number
  exponential(const Number &x)
  {
    if constexpr (NumberTypes::same<Number, double>)
      return __builtin_exp(x);
    else if constexpr (NumberTypes::is_vector<Number>)
      {
        const auto e = NumberTypes::exponential_of(x);
        return e.power * e.small + e.power;
      }
    else
      return exp(x);
  }

  /** e^x - 1, accurate also near 0. */
  template <typename Number>
  MORULA_INLINE Number
  exponential_minus_1(const Number &x)
  {
    if constexpr (NumberTypes::same<Number, double>)
      return __builtin_expm1(x);
    else if constexpr (NumberTypes::is_vector<Number>)
      {
        const auto e = NumberTypes::exponential_of(x);
        return e.power * e.small + (e.power - 1.);
      }
    else
      return exp(x) - 1.;
  }
} // namespace Morula

#endif
