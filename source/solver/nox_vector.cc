// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/solver/nox_vector.h>

#include <cmath>

namespace Morula
{
  const Equilibrium::Vector &
  values_of(const NOX::Abstract::Vector &vector)
  {
    return dynamic_cast<const NoxVector &>(vector).values;
  }

  NoxVector::NoxVector(const Equilibrium::Vector &vector)
    : values(vector)
  {}

  NOX::Abstract::Vector &
  NoxVector::init(const double gamma)
  {
    values = gamma;
    return *this;
  }

  NOX::Abstract::Vector &
  NoxVector::random(const bool, const int)
  {
    values.trilinos_vector().Random();
    return *this;
  }

  NOX::Abstract::Vector &
  NoxVector::abs(const NOX::Abstract::Vector &y)
  {
    values.trilinos_vector().Abs(values_of(y).trilinos_vector());
    return *this;
  }

  NOX::Abstract::Vector &
  NoxVector::operator=(const NOX::Abstract::Vector &y)
  {
    values = values_of(y);
    return *this;
  }

  NOX::Abstract::Vector &
  NoxVector::reciprocal(const NOX::Abstract::Vector &y)
  {
    values.trilinos_vector().Reciprocal(values_of(y).trilinos_vector());
    return *this;
  }

  NOX::Abstract::Vector &
  NoxVector::scale(const double gamma)
  {
    values *= gamma;
    return *this;
  }

  NOX::Abstract::Vector &
  NoxVector::scale(const NOX::Abstract::Vector &a)
  {
    values.scale(values_of(a));
    return *this;
  }

  NOX::Abstract::Vector &
  // NOX's update is gamma x + alpha a.
  NoxVector::update(const double                 alpha,
                    const NOX::Abstract::Vector &a,
                    const double                 gamma)
  {
    values.sadd(gamma, alpha, values_of(a));
    return *this;
  }

  NOX::Abstract::Vector &
  NoxVector::update(const double                 alpha,
                    const NOX::Abstract::Vector &a,
                    const double                 beta,
                    const NOX::Abstract::Vector &b,
                    const double                 gamma)
  {
    values.sadd(gamma, alpha, values_of(a));
    values.add(beta, values_of(b));
    return *this;
  }

  Teuchos::RCP<NOX::Abstract::Vector>
  NoxVector::clone(const NOX::CopyType type) const
  {
    const auto copy = Teuchos::rcp(new NoxVector(values));
    if (type == NOX::ShapeCopy)
      copy->values = 0.;
    return copy;
  }

  double
  NoxVector::norm(const NOX::Abstract::Vector::NormType type) const
  {
    switch (type)
      {
        case NOX::Abstract::Vector::OneNorm:
          return values.l1_norm();
        case NOX::Abstract::Vector::MaxNorm:
          return values.linfty_norm();
        default:
          return values.l2_norm();
      }
  }

  double
  NoxVector::norm(const NOX::Abstract::Vector &weights) const
  {
    Equilibrium::Vector weighted(values);
    weighted.scale(values);
    return std::sqrt(weighted * values_of(weights));
  }

  double
  NoxVector::innerProduct(const NOX::Abstract::Vector &y) const
  {
    return values * values_of(y);
  }
} // namespace Morula
