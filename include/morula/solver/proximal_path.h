// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_proximal_path_h
#define morula_solver_proximal_path_h

#include <morula/solver/newton.h>
#include <morula/solver/preconditioner.h>

#include <cmath>

namespace Morula
{
  /**
   * A problem with a friction that exists only inside a step,
   * R(u) + c D (u - u_k), where D is the magnitude of the diagonal of its first
   * tangent: doc/theory.md (5.7). With an energy Π it has the energy
   * Π + c/2 (u - u_k)·D (u - u_k).
   */
  class ProximalEquilibrium : public Equilibrium
  {
  public:
    /** @param problem kept as a reference */
    explicit ProximalEquilibrium(Equilibrium &problem)
      : problem(problem)
      , proximity(0.)
    {}

    /** Sets the centre u_k (µm) and c. */
    void
    set(const Vector &centre, const double proximity)
    {
      this->centre    = centre;
      this->proximity = proximity;
    }

    Evaluation
    residual(const Vector &u, Vector &R) const override
    {
      Evaluation evaluation = problem.residual(u, R);
      // The diagonal D comes with the first tangent. Before that nothing has
      // moved from the centre, so the friction has no force.
      if (!std::isfinite(evaluation.energy) || diagonal.size() == 0)
        return evaluation;
      Vector moved(u), force(u);
      moved -= centre;
      force = moved;
      force.scale(diagonal);
      // These are the force c D (u - u_k) and its energy, doc/theory.md (5.7).
      force *= proximity;
      const double energy = 0.5 * (moved * force);
      evaluation.energy += energy;
      evaluation.energy_magnitude += energy;
      R += force;
      return evaluation;
    }

    double
    residual_magnitude(const Vector &u) const override
    {
      return problem.residual_magnitude(u);
    }
    const Matrix &
    tangent(const Vector &u, const GrowthAt growth) override
    {
      const Matrix &K = problem.tangent(u, growth);
      // D is that of the first tangent, and stays: else the friction would
      // change within the path, and its energy with it.
      if (diagonal.size() == 0)
        diagonal = diagonal_magnitude(K, u);
      if (proximity == 0.)
        return K;
      sum = K;
      sum.add_to_diagonal(proximity, diagonal);
      return sum;
    }

    void
    use_growth_at_end() override
    {
      problem.use_growth_at_end();
    }

    const RankOnes &
    rank_ones() const override
    {
      return problem.rank_ones();
    }

  private:
    Equilibrium &problem;
    Vector       centre;    // u_k
    Vector       diagonal;  // D; empty before the first tangent
    double       proximity; // c
    Matrix       sum;       // K + c D
  };

  /**
   * Finds an equilibrium where Newton's method alone does not: a sequence of
   * equilibria u_k of the proximal problem, each from the one before, while c
   * falls to 0, so that its end is a true equilibrium. It goes down in energy
   * from its start, as tissue with a friction would: doc/theory.md (5.7). A
   * last resort, as it takes many iterations. Collective.
   * @param u      in: where to start from; out: the increment, or where the
   * path has ended
   * @param report in/out: the work is added
   * @throws StepFailed on all ranks together
   */
  Equilibrium::Evaluation
  follow_proximal_path(Equilibrium            &problem,
                       const LinearProblem    &linear_problem,
                       const NewtonScales     &scales,
                       const SolverParameters &parameters,
                       TimerOutput            &timer,
                       Equilibrium::Vector    &u,
                       NewtonReport           &report);
} // namespace Morula

#endif
