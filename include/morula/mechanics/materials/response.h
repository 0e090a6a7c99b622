// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_materials_response_h
#define morula_mechanics_materials_response_h

// What a material's law gets and returns, and the functions that it may call,
// on any type of numbers: double, a vector of the compiler (the kernels'
// registers) and numbers that bring exp(), log() and fabs() of their own, such
// as Sacado's. Included by files that are compiled for one instruction set: no
// standard headers, see kernels.h.



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

    // Two, four and eight doubles: the compiler's vectors.
    using Two   = double __attribute__((vector_size(16)));
    using Four  = double __attribute__((vector_size(32)));
    using Eight = double __attribute__((vector_size(64)));

    template <typename Number>
    constexpr bool is_vector =
      same<Number, Two> || same<Number, Four> || same<Number, Eight>;
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

  /**
   * A law's input at one point or, in the kernels, at as many points as a
   * Number holds: an isotropic material's energy is a function of tr b_e and
   * J_e (doc/theory.md, section 1.4). In plane strain too, b_e is the 3-D
   * tensor, with b_e,zz = 1.
   */
  template <typename Number>
  struct Strain
  {
    /** tr b_e - 3. */
    Number trace;
    /** Size of the numbers whose difference is the trace, for its rounding
     *  error. */
    Number trace_magnitude;
    /** J_e. */
    Number J;
    /** ln J_e. */
    Number log_J;
    /** ϑ, the volumetric part's ln J_e: the point's own or, pooled, that of its
     *  pool. */
    Number theta;
    /** Lamé's first constant, kPa. */
    Number lambda;
    /** The shear modulus, kPa. */
    Number mu;
  };

  /**
   * The volumetric part of an energy, k U(ϑ) with U(0) = U'(0) = 0 and U''(0) =
   * 1. U must depend on ϑ alone, and k on λ and μ: ln J_e of a pool takes the
   * place of ϑ where volumes are pooled.
   */
  template <typename Number>
  struct Volumetric
  {
    /** k, kPa. */
    Number modulus = {};
    /** U. */
    Number energy = {};
    /** Size of the numbers whose difference is U, for its rounding error. */
    Number magnitude = {};
    /** U'. */
    Number slope = {};
    /** U''. */
    Number curvature = {};
  };

  /**
   * Energy, stress and tangent of a law Ψ(I, ϑ) = Ψ_d(I, ln J_e) + k U(ϑ) with
   * I = tr b_e: doc/theory.md (1.8), (2.5), (2.5b). All numbers but the
   * volumetric part are those of the distortional part Ψ_d:
   *
   *   τ = α (b_e - I) + γ I, α = 2 ∂Ψ/∂I, γ = α + ∂Ψ/∂ϑ, A = ∂²Ψ/∂ϑ².
   *
   * What a law does not set is zero.
   */
  template <typename Number>
  struct Response
  {
    /** Ψ_d, kPa. */
    Number energy = {};
    /** Size of the numbers whose difference is Ψ_d, for its rounding error,
     *  kPa. */
    Number magnitude = {};
    /** α > 0, kPa. */
    Number alpha = {};
    /** γ, kPa. */
    Number gamma = {};
    /** A, kPa. */
    Number A = {};
    /** k U. */
    Volumetric<Number> volumetric;

    /** γ of the whole law, kPa. */
    MORULA_INLINE Number
    total_gamma() const
    {
      return gamma + volumetric.modulus * volumetric.slope;
    }

    /** A of the whole law, kPa. */
    MORULA_INLINE Number
    total_A() const
    {
      return A + volumetric.modulus * volumetric.curvature;
    }
  };

  /** The response of a law in which α depends on the strain. */
  template <typename Number>
  struct CoupledResponse : public Response<Number>
  {
    /** B = 2 ∂²Ψ/∂I ∂ϑ, kPa. */
    Number B = {};
    /** C = 4 ∂²Ψ/∂I², kPa. */
    Number C = {};
  };

  /** Whether α of a law depends on the strain: it returns a CoupledResponse. */
  template <typename Law>
  constexpr bool is_coupled =
    NumberTypes::same<decltype(static_cast<const Law *>(nullptr)->response(
                        Strain<double>())),
                      CoupledResponse<double>>;
} // namespace Morula

#endif
