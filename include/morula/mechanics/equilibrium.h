// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_equilibrium_h
#define morula_mechanics_equilibrium_h

#include <morula/base/block_matrix.h>
#include <morula/base/step_failed.h>
#include <morula/mechanics/term.h>

#include <deal.II/base/index_set.h>
#include <deal.II/base/point.h>

#include <functional>
#include <string>
#include <vector>

namespace Morula
{
  /**
   * A nonlinear equilibrium problem as Newton's method sees it, in terms of
   * the increment u of one step (µm): energy, residual and tangent. All
   * functions are collective.
   */
  class Equilibrium
  {
  public:
    using Vector = BlockMatrix::Vector;
    using Matrix = BlockMatrix;

    virtual ~Equilibrium() = default;

    /** With the place in µm, in the configuration at t; z = 0 in 2-D. */
    using Extreme = Morula::Extreme<3>;

    /** What an evaluation of the residual returns besides R. */
    struct Evaluation
    {
      /** Energy, kPa µm^dim; infinite where the body is inverted on any
       *  rank. */
      double energy = 0.;
      /** Σ|contributions| to the energy, for its rounding error. */
      double energy_magnitude = 0.;

      /** The smallest J_e of this rank's points, or det f where the step
       *  inverts the tissue. */
      Extreme smallest_J = {0., {}};
      /** The largest distance of this rank's held points from where they are
       *  held, µm; negative: none is held. */
      Extreme largest_gap = {-1., {}};
    };

    /** Energy and residual R(u) = dΠ/du, kPa µm^(dim-1). R is left alone where
     *  the energy is infinite. */
    virtual Evaluation
    residual(const Vector &u, Vector &R) const = 0;

    /** ‖Σ|contributions|‖ to the residual at u, kPa µm^(dim-1), for its
     *  rounding error; 0 where the body is inverted. */
    virtual double
    residual_magnitude(const Vector &u) const = 0;

    /** residual() and residual_magnitude(), which may cost less together.
     *  @param magnitude set to the latter */
    virtual Evaluation
    residual_and_magnitude(const Vector &u, Vector &R, double &magnitude) const
    {
      magnitude = residual_magnitude(u);
      return residual(u, R);
    }

    /** From now on all tangents are taken at the growth at t + dt: the step has
     *  been solved once, with something else held fixed. */
    virtual void
    use_growth_at_end()
    {}

    /** A part σ b bᵀ of a tangent, σ >= 0, which would fill a sparse matrix. */
    struct RankOne
    {
      Vector b;
      double factor; // σ
    };
    using RankOnes = std::vector<RankOne>;

    /** The tangent K(u), but for rank_ones(). The matrix belongs to the
     * problem, and is overwritten by the next call. */
    virtual const Matrix &
    tangent(const Vector &u, const GrowthAt growth) = 0;

    /** What the last tangent() lacks. */
    virtual const RankOnes &
    rank_ones() const
    {
      static const RankOnes none;
      return none;
    }
  };

  /** What a linear solver should know of the matrices of a problem. */
  struct LinearProblem
  {
    /** Whether they are symmetric, i.e., whether there is an energy. */
    bool symmetric = true;
    /**
     * Orthonormal vectors along which forces are left out, as if inertia
     * balanced them, since nothing else does: the solution is sought orthogonal
     * to them.
     */
    std::vector<Equilibrium::Vector> null_space;
    /** Typical entry of a matrix; of a tangent in kPa µm^(dim-2). */
    double typical_entry = 1.;
    /** Whether making a matrix costs more than an iteration or two of Newton's
     *  method: then one serves several of them. */
    bool costly = true;
    /** More unknowns than these take so long to factorise that a shorter step
     *  is the better answer to a system that cannot be solved otherwise. */
    types::global_dof_index most_to_factorise = numbers::invalid_dof_index;
  };

  /** Solves A x = b for a positive A, to a residual of @p tolerance |b|; may
   *  keep a preconditioner for the next call. Collective. @return whether A
   *  turned out to be positive; if not, x is of no use. @throws StepFailed */
  using SolveLinear = std::function<bool(const Equilibrium::Matrix &A,
                                         Equilibrium::Vector       &x,
                                         const Equilibrium::Vector &b,
                                         const double               tolerance)>;

  /** Makes a solver for the matrices of a problem, which outlives it. */
  using MakeLinearSolver = std::function<SolveLinear(const LinearProblem &)>;

  /** The scales with which Newton's method compares. */
  struct NewtonScales
  {
    /** A force that counts as small in this scene, kPa µm^(dim-1). */
    double small_force = 0.;
    /** The length that errors of the increment are compared with, µm. */
    double length = 1.;
  };

  /** Removes the parts of @p x along orthonormal @p directions. */
  inline void
  remove_parts(Equilibrium::Vector                    &x,
               const std::vector<Equilibrium::Vector> &directions)
  {
    for (const Equilibrium::Vector &direction : directions)
      x.add(-(x * direction), direction);
  }

  /** Adds what the rank-one parts of a tangent make of @p x. */
  inline void
  add_rank_ones(Equilibrium::Vector         &y,
                const Equilibrium::RankOnes &parts,
                const Equilibrium::Vector   &x)
  {
    for (const Equilibrium::RankOne &part : parts)
      y.add(part.factor * (part.b * x), part.b);
  }

  /**
   * Something that an equilibrium holds fixed while it is found, and that is
   * renewed after it, such as the pressure of a lumen that keeps its volume:
   * doc/theory.md (5.6).
   */
  class TurnParticipant
  {
  public:
    virtual ~TurnParticipant() = default;

    /**
     * Renews what was held fixed. Collective.
     * @param u the equilibrium that was found, µm
     * @return whether another turn is needed
     * @throws StepFailed where it cannot be renewed
     */
    virtual bool
    renew(const Equilibrium::Vector &u) = 0;

    /** Whether it may be renewed on the way to an equilibrium, too. */
    virtual bool
    renews_early() const
    {
      return false;
    }

    /** What is still wrong after the last turn, for the message of a step that
     *  fails by it. */
    virtual std::string
    unfinished() const = 0;
  };
} // namespace Morula

#endif
