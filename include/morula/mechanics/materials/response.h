// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_materials_response_h
#define morula_mechanics_materials_response_h

#include <morula/mechanics/materials/functions.h>

// See functions.h: no standard headers.

namespace Morula
{
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
    /** ϑ, the volumetric part's ln J_e: the point's own or, projected, its
     *  mean over the grid cell. */
    Number theta;
    /** Lamé's first constant, kPa. */
    Number lambda;
    /** The shear modulus, kPa. */
    Number mu;
  };

  /**
   * The volumetric part of an energy, k U(ϑ) with U(0) = U'(0) = 0 and U''(0) =
   * 1. U must depend on ϑ alone, and k on λ and μ: the mean over a grid cell
   * takes the place of ϑ where the volumetric strain is projected.
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
