// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_materials_laws_h
#define morula_mechanics_materials_laws_h

#include <morula/mechanics/materials/response.h>

namespace Morula
{
  /**
   * The compressible neo-Hookean material of equation (14) of the paper,
   * doc/theory.md (1.4), (1.5):
   *
   *   Ψ = λ/2 (ln J_e)² + μ/2 (tr b_e - 3 - 2 ln J_e),
   *   τ = μ (b_e - I) + λ ln J_e I.
   */
  struct NeoHookean
  {
    /** Value of Material/Law. */
    static constexpr const char *name = "neo-Hookean";

    /** The law: see Response. */
    template <typename Number>
    MORULA_INLINE Response<Number>
                  response(const Strain<Number> &s) const
    {
      Response<Number> r;
      r.energy    = 0.5 * s.mu * (s.trace - 2. * s.log_J);
      r.magnitude = 0.5 * s.mu * (s.trace_magnitude + 2. * magnitude(s.log_J));
      r.alpha     = s.mu;

      auto &volumetric     = r.volumetric; // λ/2 ϑ²
      volumetric.modulus   = s.lambda;
      volumetric.energy    = 0.5 * s.theta * s.theta;
      volumetric.magnitude = volumetric.energy;
      volumetric.slope     = s.theta;
      volumetric.curvature += 1.;
      return r;
    }
  };

  /**
   * A neo-Hookean material whose shear and volume do not mix, doc/theory.md
   * (1.6), (1.7):
   *
   *   Ψ = μ/2 (J_e^(-2/3) tr b_e - 3) + κ/2 (J_e²/2 - 1/2 - ln J_e),
   *   τ = μ J_e^(-2/3) dev b_e + κ/2 (J_e² - 1) I, κ = λ + 2μ/3.
   *
   * Its exponents and its deviator are those of three dimensions also in plane
   * strain.
   */
  struct IsochoricNeoHookean
  {
    /** Value of Material/Law. */
    static constexpr const char *name = "isochoric neo-Hookean";

    /** The law: see Response. */
    template <typename Number>
    MORULA_INLINE CoupledResponse<Number>
                  response(const Strain<Number> &s) const
    {
      CoupledResponse<Number> r;
      const Number            power_minus_1 =
        exponential_minus_1<Number>(-2. / 3. * s.log_J);
      const Number power = power_minus_1 + 1.; // J_e^(-2/3)
      r.energy           = 0.5 * s.mu * (power * s.trace + 3. * power_minus_1);
      r.magnitude        = 0.5 * s.mu * (power * s.trace_magnitude + 3.);
      r.alpha            = s.mu * power;
      r.gamma            = -1. / 3. * r.alpha * s.trace;
      r.A                = 2. / 9. * r.alpha * (s.trace + 3.);
      r.B                = -2. / 3. * r.alpha;

      auto        &volumetric     = r.volumetric; // κ/4 (e^2ϑ - 1 - 2ϑ)
      const Number twice          = 2. * s.theta;
      const Number square_minus_1 = exponential_minus_1(twice);
      volumetric.modulus          = s.lambda + 2. / 3. * s.mu;
      volumetric.energy           = 0.25 * (square_minus_1 - twice);
      volumetric.magnitude =
        0.25 * (magnitude(square_minus_1) + magnitude(twice));
      volumetric.slope     = 0.5 * square_minus_1;
      volumetric.curvature = square_minus_1 + 1.;
      return r;
    }
  };

  /** A list of laws of materials. */
  template <typename... Law>
  struct Laws
  {};

  /**
   * The library's own laws, the default first. A new one is its struct above
   * and its name here. Programs add theirs with Materials::add().
   */
  using OwnLaws = Laws<NeoHookean, IsochoricNeoHookean>;
} // namespace Morula

#endif
