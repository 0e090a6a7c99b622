// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/division/directions.h>

#include <cmath>

namespace Morula::Directions
{
  namespace
  {
    /** @p direction or its opposite, whichever is nearer to @p sign. */
    template <int dim>
    Tensor<1, dim>
    with_sign_of(const Tensor<1, dim> &direction, const Tensor<1, dim> &sign)
    {
      return direction * sign < 0. ? -direction : direction;
    }
  } // namespace


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


  template <int dim>
  Tensor<1, dim>
  carried_normal(const Tensor<2, dim> &F, const Tensor<1, dim> &normal)
  {
    // The surface's normal is carried by F^-T, not by F: vectors along the
    // surface must stay perpendicular to it.
    const Tensor<1, dim> carried = transpose(invert(F)) * normal;
    return carried / carried.norm();
  }


  MORULA_INSTANTIATE(across);
  MORULA_INSTANTIATE(of_largest_stretch);
  MORULA_INSTANTIATE(of_largest_stress);
  MORULA_INSTANTIATE(carried_normal);
} // namespace Morula::Directions
