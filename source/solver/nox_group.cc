// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/solver/nox_group.h>
#include <morula/solver/null_space.h>

#include <Teuchos_ParameterList.hpp>

#include <algorithm>
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


  double
  rounding_of_residual(const Equilibrium &problem, const Equilibrium::Vector &u)
  {
    return rounding_error * problem.residual_magnitude(u);
  }

  NoxGroup::NoxGroup(Equilibrium               &problem,
                     const LinearProblem       &linear_problem,
                     Tangents                  &tangents,
                     LinearSolver              &linear_solver,
                     NewtonReport              &report,
                     const Equilibrium::Vector &u)
    : problem(problem)
    , linear_problem(linear_problem)
    , tangents(tangents)
    , linear_solver(linear_solver)
    , report(report)
    , u(u)
    , R(u)
    , direction(u)
  {}

  void
  NoxGroup::invalidate()
  {
    has_residual = has_direction = false;
    K                            = nullptr;
  }

  NOX::Abstract::Group &
  NoxGroup::operator=(const NOX::Abstract::Group &source)
  {
    // NOX copies groups from iteration to iteration. The matrix belongs to the
    // problem and is shared.
    const auto &other = dynamic_cast<const NoxGroup &>(source);
    u.values          = other.u.values;
    R.values          = other.R.values;
    direction.values  = other.direction.values;
    evaluation_       = other.evaluation_;
    K                 = other.K;
    has_residual      = other.has_residual;
    has_direction     = other.has_direction;
    part              = other.part;
    return *this;
  }

  void
  NoxGroup::setX(const NOX::Abstract::Vector &y)
  {
    u = y;
    invalidate();
  }

  void
  NoxGroup::computeX(const NOX::Abstract::Group  &group,
                     const NOX::Abstract::Vector &d,
                     const double                 step)
  {
    u.update(1., group.getX(), step, d, 0.);
    part = step;
    invalidate();
  }

  NOX::Abstract::Group::ReturnType
  NoxGroup::computeF()
  {
    // An inverted state is no failure here, as NOX would stop then. It shows as
    // infinite energy, and the line search rejects it.
    if (!has_residual)
      {
        evaluation_ = problem.residual(u.values, R.values);
        // Nothing balances a force along an unsupported motion, and nothing
        // moves along it. So only the rest of the residual counts.
        remove_parts(R.values, linear_problem.null_space);
      }
    has_residual = true;
    return Ok;
  }

  double
  NoxGroup::compute_with_rounding()
  {
    double magnitude = 0.;
    evaluation_ = problem.residual_and_magnitude(u.values, R.values, magnitude);
    remove_parts(R.values, linear_problem.null_space);
    has_residual = true;
    return rounding_error * magnitude;
  }

  NOX::Abstract::Group::ReturnType
  NoxGroup::computeJacobian()
  {
    computeF();
    if (K == nullptr)
      // A tangent may serve again only if the last step was taken as a whole
      // and no tangent has been indefinite.
      K = &tangents.at(u.values,
                       getNormF(),
                       part == 1. && !linear_solver.has_shifted());
    return Ok;
  }

  NOX::Abstract::Group::ReturnType
  NoxGroup::computeGradient()
  {
    return computeF(); // the gradient of the energy is the residual
  }

  NOX::Abstract::Group::ReturnType
  NoxGroup::computeNewton(Teuchos::ParameterList &parameters)
  {
    if (has_direction)
      return Ok;
    computeF();
    computeJacobian();
    // NOX hands over the tolerance that its forcing term asks for.
    Equilibrium::Vector b(R.values);
    b *= -1.;
    ++report.newton_iterations;
    linear_solver.solve(*K,
                        direction.values,
                        b,
                        parameters.get("Tolerance", 1e-6),
                        report.linear_iterations,
                        tangents.kept(),
                        problem.rank_one());
    report.curvature = std::min(report.curvature, linear_solver.curvature());
    has_direction    = true;
    return Ok;
  }

  NOX::Abstract::Group::ReturnType
  NoxGroup::applyJacobian(const NOX::Abstract::Vector &input,
                          NOX::Abstract::Vector       &result) const
  {
    if (K == nullptr)
      return BadDependency;
    auto &values = dynamic_cast<NoxVector &>(result).values;
    K->vmult(values, values_of(input));
    // Where a lumen has a content, the matrix alone is not the whole tangent.
    add_rank_one(values, problem.rank_one(), values_of(input));
    return Ok;
  }

  Teuchos::RCP<NOX::Abstract::Group>
  NoxGroup::clone(const NOX::CopyType type) const
  {
    const auto copy = Teuchos::rcp(new NoxGroup(
      problem, linear_problem, tangents, linear_solver, report, u.values));
    if (type == NOX::DeepCopy)
      *copy = static_cast<const NOX::Abstract::Group &>(*this);
    return copy;
  }
} // namespace Morula
