// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_materials_neo_hookean_h
#define morula_mechanics_materials_neo_hookean_h

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
} // namespace Morula

#endif
