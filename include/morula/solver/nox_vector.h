// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_nox_vector_h
#define morula_solver_nox_vector_h

#include <morula/mechanics/equilibrium.h>

#include <NOX_Abstract_Vector.H>

namespace Morula
{
  /**
   * A Trilinos vector as NOX sees it. Written against NOX::Abstract, so that it
   * outlives NOX's Epetra interface.
   */
  class NoxVector : public NOX::Abstract::Vector
  {
  public:
    explicit NoxVector(const Equilibrium::Vector &vector);

    Equilibrium::Vector values;

    NOX::Abstract::Vector &
    init(double gamma) override;
    NOX::Abstract::Vector &
    random(bool use_seed, int seed) override;
    NOX::Abstract::Vector &
    abs(const NOX::Abstract::Vector &y) override;
    NOX::Abstract::Vector &
    operator=(const NOX::Abstract::Vector &y) override;
    NOX::Abstract::Vector &
    reciprocal(const NOX::Abstract::Vector &y) override;
    NOX::Abstract::Vector &
    scale(double gamma) override;
    NOX::Abstract::Vector &
    scale(const NOX::Abstract::Vector &a) override;
    NOX::Abstract::Vector &
    update(double alpha, const NOX::Abstract::Vector &a, double gamma) override;
    NOX::Abstract::Vector &
    update(double                       alpha,
           const NOX::Abstract::Vector &a,
           double                       beta,
           const NOX::Abstract::Vector &b,
           double                       gamma) override;
    Teuchos::RCP<NOX::Abstract::Vector>
    clone(NOX::CopyType type) const override;
    double
    norm(NOX::Abstract::Vector::NormType type) const override;
    double
    norm(const NOX::Abstract::Vector &weights) const override;
    double
    innerProduct(const NOX::Abstract::Vector &y) const override;
    NOX::size_type
    length() const override
    {
      return values.size();
    }
  };

  /** The vector behind NOX's base class. */
  const Equilibrium::Vector &
  values_of(const NOX::Abstract::Vector &vector);
} // namespace Morula

#endif
