// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_equilibrium_h
#define morula_mechanics_equilibrium_h

#include <morula/mechanics/term.h>

#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_vector.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace Morula
{
  /**
   * The step cannot be done with this dt: no convergence, linear solver
   * failure, or inversion. It means "retry smaller" and is thrown on all ranks
   * together; every other exception ends the run.
   */
  class StepFailed : public std::runtime_error
  {
  public:
    using std::runtime_error::runtime_error;
  };

  /**
   * A nonlinear equilibrium problem as Newton's method sees it, in terms of
   * the increment u of one step (µm). All functions are collective.
   */
  class Equilibrium
  {
  public:
    using Vector = TrilinosWrappers::MPI::Vector;
    using Matrix = TrilinosWrappers::SparseMatrix;

    virtual ~Equilibrium() = default;

    /** What an evaluation of the residual gives besides. */
    struct Evaluation
    {
      /** Energy, kPa µm^dim; infinite where the body is inverted on any
       *  rank. */
      double energy;
      /** Σ|contributions| to the energy, for its rounding error. */
      double energy_magnitude;
    };

    /** Gives @p vector the layout of the unknowns, all zero. */
    virtual void
    initialize(Vector &vector) const = 0;

    /** Energy and residual R(u) = dΠ/du, kPa µm^(dim-1). */
    virtual Evaluation
    residual(const Vector &u, Vector &R) const = 0;

    /**
     * Size of the residual that rounding alone can cause:
     * 10 ε ‖Σ|contributions|‖.
     */
    virtual double
    rounding(const Vector &u) const = 0;

    /**
     * What a user should know of the last state that residual() was called
     * for, where Newton's method fails there: extreme values and their places.
     * The argument is its residual.
     */
    virtual std::string
    describe(const Vector & /*R*/) const
    {
      return "";
    }

    /** The tangent K(u). The matrix belongs to the problem. */
    virtual const Matrix &
    tangent(const Vector &u, const GrowthAt growth) = 0;

    /** Whether there is an energy and the tangent is symmetric. */
    virtual bool
    is_conservative() const = 0;

    /**
     * Orthonormal vectors along which forces are left out, as if inertia
     * balanced them, since nothing else does: the
     * solution is sought orthogonal to them.
     */
    virtual const std::vector<Vector> &
    null_space() const = 0;

    /** Unknowns, of this rank or others, that hang together so closely that a
     *  preconditioner must not part them: what couples them most is this rank's
     *  part of the problem. */
    virtual IndexSet
    coupled_dofs() const = 0;

    /** A force that counts as small in this scene, kPa µm^(dim-1). */
    virtual double
    small_force() const = 0;

    /** The length that errors of the increment are compared with, µm. */
    virtual double
    typical_length() const = 0;

    /** Typical entry of the tangent, kPa µm^(dim-2). */
    virtual double
    stiffness_scale() const = 0;
  };
} // namespace Morula

#endif
