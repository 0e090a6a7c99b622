// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_division_directions_h
#define morula_effects_division_directions_h

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

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

  /**
   * The part of @p direction perpendicular to the unit vector @p axis, made a
   * unit vector: uniform in the perpendicular plane (2-D: on the line) if
   * @p direction is uniform on the sphere. If the direction is along the axis,
   * any perpendicular one.
   */
  template <int dim>
  Tensor<1, dim>
  across(const Tensor<1, dim> &axis, const Tensor<1, dim> &direction);

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
                     const Tensor<1, dim> &sign);

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
                    const Tensor<1, dim>        &sign);

  /** The normal of a surface that moves with the cell, F^{-T} N normalised,
   *  doc/theory.md (6.3c).
   *  @param normal N, in the reference configuration */
  template <int dim>
  Tensor<1, dim>
  carried_normal(const Tensor<2, dim> &F, const Tensor<1, dim> &normal);
} // namespace Morula::Directions

#endif
