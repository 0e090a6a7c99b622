// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_nox_group_h
#define morula_solver_nox_group_h

#include <morula/mechanics/equilibrium.h>
#include <morula/solver/linear_solver.h>
#include <morula/solver/newton.h>
#include <morula/solver/tangents.h>

#include <NOX_Abstract_Group.H>
#include <NOX_Abstract_Vector.H>

#include <limits>

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

  /**
   * An increment u together with what has been computed for it, as NOX sees
   * it. Copies share the problem, what is known of its matrices, the tangents,
   * the linear solver and the report, which must outlive them.
   */
  class NoxGroup : public NOX::Abstract::Group
  {
  public:
    NoxGroup(Equilibrium               &problem,
             const LinearProblem       &linear_problem,
             Tangents                  &tangents,
             LinearSolver              &linear_solver,
             NewtonReport              &report,
             const Equilibrium::Vector &u);

    /** Energy and extremes at u. computeF() must have been called. */
    const Equilibrium::Evaluation &
    evaluation() const
    {
      return evaluation_;
    }

    NOX::Abstract::Group &
    operator=(const NOX::Abstract::Group &source) override;
    void
    setX(const NOX::Abstract::Vector &y) override;
    void
    computeX(const NOX::Abstract::Group  &group,
             const NOX::Abstract::Vector &direction,
             double                       step) override;
    ReturnType
    computeF() override;
    ReturnType
    computeJacobian() override;
    ReturnType
    computeGradient() override;
    ReturnType
    computeNewton(Teuchos::ParameterList &parameters) override;
    ReturnType
    applyJacobian(const NOX::Abstract::Vector &input,
                  NOX::Abstract::Vector       &result) const override;
    bool
    isF() const override
    {
      return has_residual;
    }
    bool
    isJacobian() const override
    {
      return K != nullptr;
    }
    bool
    isGradient() const override
    {
      return has_residual;
    }
    bool
    isNewton() const override
    {
      return has_direction;
    }
    const NOX::Abstract::Vector &
    getX() const override
    {
      return u;
    }
    const NOX::Abstract::Vector &
    getF() const override
    {
      return R;
    }
    double
    getNormF() const override
    {
      return R.values.l2_norm();
    }
    const NOX::Abstract::Vector &
    getGradient() const override
    {
      return R;
    }
    const NOX::Abstract::Vector &
    getNewton() const override
    {
      return direction;
    }
    Teuchos::RCP<const NOX::Abstract::Vector>
    getXPtr() const override
    {
      return Teuchos::rcpFromRef(u);
    }
    Teuchos::RCP<const NOX::Abstract::Vector>
    getFPtr() const override
    {
      return Teuchos::rcpFromRef(R);
    }
    Teuchos::RCP<const NOX::Abstract::Vector>
    getGradientPtr() const override
    {
      return Teuchos::rcpFromRef(R);
    }
    Teuchos::RCP<const NOX::Abstract::Vector>
    getNewtonPtr() const override
    {
      return Teuchos::rcpFromRef(direction);
    }
    Teuchos::RCP<NOX::Abstract::Group>
    clone(NOX::CopyType type) const override;

    /** computeF() and rounding_of_residual(), in one pass. */
    double
    compute_with_rounding();

    /** Whether the direction is that of a kept tangent. */
    bool
    has_kept_tangent() const
    {
      return tangents.kept();
    }

    /** The part of the last direction that has led here. */
    double
    part_taken() const
    {
      return part;
    }

    /** The most negative curvature that the linear solver has met, as in
     *  NewtonIteration. */
    double
    curvature() const
    {
      return linear_solver.curvature();
    }

  private:
    void
    invalidate();

    Equilibrium               &problem;
    const LinearProblem       &linear_problem;
    Tangents                  &tangents;
    LinearSolver              &linear_solver;
    NewtonReport              &report;
    NoxVector                  u, R, direction;
    Equilibrium::Evaluation    evaluation_;
    const Equilibrium::Matrix *K            = nullptr;
    bool                       has_residual = false, has_direction = false;
    double                     part = 1.; // of the direction that led here
  };

  /** A sum's rounding error, relative to the sum of its magnitudes. */
  constexpr double rounding_error =
    10. * std::numeric_limits<double>::epsilon();

  /** Size of the residual that rounding alone can cause, r_0 in doc/theory.md
   *  (5.3). Collective. */
  double
  rounding_of_residual(const Equilibrium         &problem,
                       const Equilibrium::Vector &u);
} // namespace Morula

#endif
