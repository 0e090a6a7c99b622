// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_division_directions_h
#define morula_effects_division_directions_h

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <cmath>
#include <optional>

/**
 * Directions that the state of a cell singles out, for division rules: pure
 * functions. All are unit vectors in the present configuration. An eigenvector
 * has no sign of its own; it gets that of a given direction, since daughters
 * may differ.
 */
namespace Morula::Directions
{
  using namespace dealii;

  /** @p direction or its opposite, whichever is nearer to @p sign. */
  template <int dim>
  Tensor<1, dim>
  with_sign_of(const Tensor<1, dim> &direction, const Tensor<1, dim> &sign)
  {
    return direction * sign < 0. ? -direction : direction;
  }

  /**
   * The part of @p direction perpendicular to the unit vector @p axis, made a
   * unit vector: uniform in the perpendicular plane (2-D: on the line) if
   * @p direction is uniform on the sphere. If the direction is along the axis,
   * any perpendicular one.
   */
  template <int dim>
  Tensor<1, dim>
  across(const Tensor<1, dim> &axis, const Tensor<1, dim> &direction)
  {
    // What is left without the part along the axis is perpendicular to it, m of
    // doc/theory.md (6.3c).
    const Tensor<1, dim> part   = direction - (direction * axis) * axis;
    const double         length = part.norm();
    if (length > 0.)
      return part / length;
    // A direction along the axis leaves nothing. Then the coordinate direction
    // that is least along the axis is taken instead: its perpendicular part is
    // at least sqrt(1 - 1/dim) long, so the second call always ends.
    unsigned int smallest = 0;
    for (unsigned int d = 1; d < dim; ++d)
      if (std::abs(axis[d]) < std::abs(axis[smallest]))
        smallest = d;
    Tensor<1, dim> other;
    other[smallest] = 1.;
    return across(axis, other);
  }

  /**
   * The direction of the largest principal stretch: the eigenvector of the left
   * stretch V_e with the largest eigenvalue, doc/theory.md (6.3a).
   * @param F_e   elastic deformation gradient
   * @param least ratio of the two largest stretches, >= 1, below which the cell
   *        counts as equally stretched: no direction
   * @param sign  the result makes no obtuse angle with it
   */
  template <int dim>
  std::optional<Tensor<1, dim>>
  of_largest_stretch(const Tensor<2, dim> &F_e,
                     const double          least,
                     const Tensor<1, dim> &sign)
  {
    // b_e = V_e^2; the largest eigenvalue comes first.
    const auto   squares = eigenvectors(symmetrize(F_e * transpose(F_e)));
    const double ratio   = std::sqrt(squares[0].first / squares[1].first);
    // The comparison is written so that it is also true for a ratio that is not
    // a number.
    if (!(ratio > 1. && ratio >= least))
      return {};
    return with_sign_of(squares[0].second, sign);
  }

  /**
   * The direction of the most tensile principal stress, doc/theory.md (6.3b).
   * In 2-D, of the stresses in the plane.
   * @param stress Cauchy stress, kPa
   * @param mu     Lamé's shear modulus, kPa
   * @param least  no direction if 1 + (σ_1 - σ_2)/(2 μ) is below it, which at
   *        small strains is the ratio of the stretches
   * @param sign   the result makes no obtuse angle with it
   */
  template <int dim>
  std::optional<Tensor<1, dim>>
  of_largest_stress(const SymmetricTensor<2, 3> &stress,
                    const double                 mu,
                    const double                 least,
                    const Tensor<1, dim>        &sign)
  {
    // In 2-D the stress across the plane may be the largest of the three, but
    // no cell divides out of the plane.
    SymmetricTensor<2, dim> in_space;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j <= i; ++j)
        in_space[i][j] = stress[i][j];
    const auto principal = eigenvectors(in_space);
    // At small strains this is the difference of the two strains, so the
    // threshold has the meaning that it has for stretches: doc/theory.md
    // (6.3b).
    const double difference =
      (principal[0].first - principal[1].first) / (2. * mu);
    if (!(difference > 0. && 1. + difference >= least))
      return {};
    return with_sign_of(principal[0].second, sign);
  }

  /** The normal of a surface that moves with the cell, F^{-T} N normalised,
   *  doc/theory.md (6.3c).
   *  @param normal N, in the reference configuration */
  template <int dim>
  Tensor<1, dim>
  carried_normal(const Tensor<2, dim> &F, const Tensor<1, dim> &normal)
  {
    // The surface's normal is carried by F^-T, not by F: vectors along the
    // surface must stay perpendicular to it.
    const Tensor<1, dim> carried = transpose(invert(F)) * normal;
    return carried / carried.norm();
  }
} // namespace Morula::Directions

#endif
