// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_own_law_h
#define morula_tests_own_law_h

#include <morula/mechanics/materials/material.h>
#include <morula/mechanics/materials/own_material.h>

#include <string>
#include <string_view>

namespace Morula
{
  /**
   * A program's own law, with a number of its own: it stiffens exponentially
   * with I' = J_e^(-2/3) tr b_e (Demiray 1972), and no coefficient of Response
   * is zero.
   *
   *   Ψ = μ/2c (e^(c (I' - 3)) - 1) + κ/2 (ln J_e)², κ = λ + 2μ/3.
   */
  struct StiffeningLaw
  {
    double c = 0.7;

    template <typename Number>
    CoupledResponse<Number>
    response(const Strain<Number> &s) const
    {
      CoupledResponse<Number> r;
      const Number            p = exponential<Number>(-2. / 3. * s.log_J);
      const Number            I = p * (s.trace + 3.);
      const Number            e = exponential<Number>(c * (I - 3.));
      r.energy                  = 0.5 / c * s.mu * (e - 1.);
      r.magnitude               = 0.5 / c * s.mu * (e + 1.);
      r.alpha                   = s.mu * p * e;
      r.gamma                   = r.alpha - 1. / 3. * s.mu * I * e;
      r.A                       = 2. / 9. * s.mu * I * e * (1. + c * I);
      r.B                       = -2. / 3. * r.alpha * (1. + c * I);
      r.C                       = 2. * c * p * r.alpha;

      r.volumetric.modulus   = s.lambda + 2. / 3. * s.mu;
      r.volumetric.energy    = 0.5 * s.theta * s.theta;
      r.volumetric.magnitude = r.volumetric.energy;
      r.volumetric.slope     = s.theta;
      r.volumetric.curvature += 1.;
      return r;
    }
  };

  /** The library's materials and one of a program. */
  inline Materials
  all_materials()
  {
    Materials materials;
    materials.add("stiffening", own_material(StiffeningLaw()));
    return materials;
  }

  /** One of them. By std::string_view, as GCC 13 warns of a reference that is
   *  returned by a function of a temporary string. */
  inline const Material &
  material_of_test(const std::string_view name)
  {
    static const Materials materials = all_materials();
    return *materials.find(std::string(name));
  }
} // namespace Morula

#endif
