// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_nox_group_h
#define morula_solver_nox_group_h

#include <morula/mechanics/equilibrium.h>
#include <morula/solver/linear_solver.h>
#include <morula/solver/newton.h>

#include <NOX_Abstract_Group.H>
#include <NOX_Abstract_Vector.H>
#include <Teuchos_ParameterList.hpp>

#include <algorithm>
#include <limits>

namespace Morula
{
  /**
   * The tangents of one solve. A tangent costs several residuals, and its
   * linear systems are solved loosely as long as the residual is large: so an
   * iteration goes on with the last tangent while that makes the residual five
   * times smaller (doc/theory.md, 5.1).
   */
  class Tangents
  {
  public:
    /** @param problem kept as a reference
     *  @param keep    whether one may serve several iterations */
    Tangents(Equilibrium &problem, const bool keep)
      : problem(problem)
      , keep(keep)
    {}

    /**
     * The tangent for an iteration from @p u on, the last one or a new one; the
     * first is taken at the growth of the step's beginning. Collective.
     * @param norm of the residual at u, kPa µm^(dim-1)
     * @param undisturbed whether the last iteration took its whole step, and
     *        no tangent has been indefinite so far
     */
    const Equilibrium::Matrix &
    at(const Equilibrium::Vector &u, const double norm, const bool undisturbed)
    {
      // A tangent is kept only if all signs are good. The first one has the
      // growth of the step's beginning, doc/theory.md (5.1).
      ++n_iterations;
      kept_ = keep && last != nullptr && undisturbed &&
              n_iterations <= last_kept_iteration &&
              norm <= sufficient_reduction * last_norm;
      if (!kept_)
        last = &problem.tangent(u,
                                last == nullptr ? GrowthAt::previous :
                                                  GrowthAt::current);
      last_norm = norm;
      return *last;
    }

    /** Residuals have grown by this factor, for a reason that tangents do not
     *  feel. */
    void
    rescale(const double factor)
    {
      last_norm *= factor;
    }

    /** Whether at() has returned the same matrix once more. */
    bool
    kept() const
    {
      return kept_;
    }

  private:
    /** A tangent is kept as long as each iteration reduces the residual to this
     *  part or less. In 3-D a tangent costs as much as many residuals, so a few
     *  iterations more pay: doc/theory.md, section 5.1. */
    static constexpr double sufficient_reduction = 0.2;
    /** A solve that takes more iterations than these is in trouble, and gets a
     *  tangent in each. */
    static constexpr unsigned int last_kept_iteration = 10;

    Equilibrium               &problem;
    const bool                 keep;
    const Equilibrium::Matrix *last         = nullptr;
    bool                       kept_        = false;
    double                     last_norm    = 0.;
    unsigned int               n_iterations = 0;
  };

  /** A sum's rounding error, relative to the sum of its magnitudes. For a
   *  residual it is the one that rounding alone can cause, r_0 in doc/theory.md
   *  (5.3). */
  constexpr double rounding_error =
    10. * std::numeric_limits<double>::epsilon();

  inline const Equilibrium::Vector &
  values_of(const NOX::Abstract::Vector &vector);

  /**
   * A distributed vector as NOX sees it.
   */
  class NoxVector : public NOX::Abstract::Vector
  {
  public:
    explicit NoxVector(const Equilibrium::Vector &vector)
      : values(vector)
    {}

    Equilibrium::Vector values;

    NOX::Abstract::Vector &
    init(const double gamma) override
    {
      values = gamma;
      return *this;
    }

    // Newton's method with a line search of its own asks for none of these.
    NOX::Abstract::Vector &
    random(const bool, const int) override
    {
      throw ExcNotImplemented();
    }
    NOX::Abstract::Vector &
    abs(const NOX::Abstract::Vector &) override
    {
      throw ExcNotImplemented();
    }
    NOX::Abstract::Vector &
    reciprocal(const NOX::Abstract::Vector &) override
    {
      throw ExcNotImplemented();
    }
    double
    norm(const NOX::Abstract::Vector &) const override
    {
      throw ExcNotImplemented();
    }

    NOX::Abstract::Vector &
    operator=(const NOX::Abstract::Vector &y) override
    {
      values = values_of(y);
      return *this;
    }

    NOX::Abstract::Vector &
    scale(const double gamma) override
    {
      values *= gamma;
      return *this;
    }

    NOX::Abstract::Vector &
    scale(const NOX::Abstract::Vector &a) override
    {
      values.scale(values_of(a));
      return *this;
    }

    NOX::Abstract::Vector &
    update(const double                 alpha,
           const NOX::Abstract::Vector &a,
           const double                 gamma) override
    {
      // NOX's update is gamma x + alpha a.
      values.sadd(gamma, alpha, values_of(a));
      return *this;
    }

    NOX::Abstract::Vector &
    update(const double                 alpha,
           const NOX::Abstract::Vector &a,
           const double                 beta,
           const NOX::Abstract::Vector &b,
           const double                 gamma) override
    {
      values.sadd(gamma, alpha, values_of(a));
      values.add(beta, values_of(b));
      return *this;
    }

    Teuchos::RCP<NOX::Abstract::Vector>
    clone(const NOX::CopyType type) const override
    {
      const auto copy = Teuchos::rcp(new NoxVector(values));
      if (type == NOX::ShapeCopy)
        copy->values = 0.;
      return copy;
    }

    double
    norm(const NOX::Abstract::Vector::NormType type) const override
    {
      return type == NOX::Abstract::Vector::MaxNorm ? values.linfty_norm() :
                                                      values.l2_norm();
    }

    double
    innerProduct(const NOX::Abstract::Vector &y) const override
    {
      return values * values_of(y);
    }

    NOX::size_type
    length() const override
    {
      return values.size();
    }
  };

  /** The vector behind NOX's base class. */
  inline const Equilibrium::Vector &
  values_of(const NOX::Abstract::Vector &vector)
  {
    return dynamic_cast<const NoxVector &>(vector).values;
  }

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

    /** Energy and extremes at u. computeF() must have been called. */
    const Equilibrium::Evaluation &
    evaluation() const
    {
      return evaluation_;
    }

    NOX::Abstract::Group &
    operator=(const NOX::Abstract::Group &source) override
    {
      // NOX copies groups from iteration to iteration. The matrix belongs to
      // the problem and is shared.
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
    setX(const NOX::Abstract::Vector &y) override
    {
      u = y;
      invalidate();
    }

    void
    computeX(const NOX::Abstract::Group  &group,
             const NOX::Abstract::Vector &d,
             const double                 step) override
    {
      u.update(1., group.getX(), step, d, 0.);
      part = step;
      invalidate();
    }

    ReturnType
    computeF() override
    {
      // An inverted state is no failure here, as NOX would stop then. It shows
      // as infinite energy, and the line search rejects it.
      if (!has_residual)
        {
          evaluation_ = problem.residual(u.values, R.values);
          // Unsupported motions move nothing: only the rest counts.
          remove_parts(R.values, linear_problem.null_space);
        }
      has_residual = true;
      return Ok;
    }

    ReturnType
    computeJacobian() override
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

    ReturnType
    computeNewton(Teuchos::ParameterList &parameters) override
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
                          problem.rank_ones());
      report.curvature = std::min(report.curvature, linear_solver.curvature());
      has_direction    = true;
      return Ok;
    }

    bool
    isF() const override
    {
      return has_residual;
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
    clone(const NOX::CopyType type) const override
    {
      const auto copy = Teuchos::rcp(new NoxGroup(
        problem, linear_problem, tangents, linear_solver, report, u.values));
      if (type == NOX::DeepCopy)
        *copy = static_cast<const NOX::Abstract::Group &>(*this);
      return copy;
    }

    /** computeF(), and the residual that rounding alone can cause, in one pass.
     */
    double
    compute_with_rounding()
    {
      double magnitude = 0.;
      evaluation_ =
        problem.residual_and_magnitude(u.values, R.values, magnitude);
      remove_parts(R.values, linear_problem.null_space);
      has_residual = true;
      return rounding_error * magnitude;
    }

    /** Finds the residual anew, which is another one at the same u. */
    void
    renew()
    {
      const double before = getNormF();
      invalidate();
      computeF();
      tangents.rescale(getNormF() / before);
    }

    /** Whether the direction is that of a kept tangent. */
    bool
    has_kept_tangent() const
    {
      return tangents.kept();
    }

    /** Whether |R| is a small part of the first one here and hardly anything
     *  resists the direction d: d·Kd / d·|diag K|d is below a tenth of the
     * least c of a proximal path (5.7), whose friction decides where d goes.
     * Noted in the report. Collective. */
    bool
    is_unresisted() const
    {
      Equilibrium::Vector d(direction.values);
      d.scale(diagonal_magnitude(*K, d));
      return report.ends_at_leap =
               getNormF() <= 1e-4 * report.first_residual &&
               -(R.values * direction.values) < 1e-7 * (d * direction.values);
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
    invalidate()
    {
      has_residual = has_direction = false;
      K                            = nullptr;
    }

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
} // namespace Morula

#endif
