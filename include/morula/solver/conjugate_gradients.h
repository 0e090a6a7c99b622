// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_conjugate_gradients_h
#define morula_solver_conjugate_gradients_h

#include <morula/solver/one_reduction.h>
#include <morula/solver/shifted_system.h>

namespace Morula
{
  /** The plain form of conjugate_gradients(). */
  template <typename Preconditioner>
  CgOutcome
  plain_conjugate_gradients(const ShiftedSystem       &system,
                            const Preconditioner      &P,
                            Equilibrium::Vector       &x,
                            const Equilibrium::Vector &b,
                            const double               tolerance,
                            const unsigned int         max_iterations,
                            unsigned int              &iterations,
                            double                    &needed)
  {
    using Vector = Equilibrium::Vector;
    Vector r(b), z(b), p(b), Kp(b), shifted(b), diagonal;
    // Hardly any system is shifted, and the search for the entries takes time.
    if (system.shift > 0.)
      diagonal = diagonal_magnitude(system.K.matrix(), b);
    x = 0.;
    remove_parts(r, system.null_space);
    P.vmult(z, r);
    remove_parts(z, system.null_space);
    p                   = z;
    double       rz     = r * z;
    const double target = tolerance * r.l2_norm();
    for (unsigned int i = 0; i < max_iterations; ++i)
      {
        if (!(rz > 0.))
          return CgOutcome::indefinite_preconditioner;
        system.K.vmult(Kp, p);
        add_rank_one(Kp, system.rank_one, p);
        if (system.shift > 0.)
          {
            shifted = p;
            shifted.scale(diagonal);
            Kp.add(system.shift, shifted);
          }
        remove_parts(Kp, system.null_space);
        ++iterations;
        const double curvature = p * Kp;
        if (!(curvature > 0.))
          {
            shifted = p;
            shifted.scale(diagonal_magnitude(system.K.matrix(), b));
            needed = system.shift - curvature / (p * shifted);
            return CgOutcome::negative_curvature;
          }
        const double alpha = rz / curvature;
        x.add(alpha, p);
        r.add(-alpha, Kp);
        if (r.l2_norm() <= target)
          return CgOutcome::converged;
        P.vmult(z, r);
        remove_parts(z, system.null_space);
        const double rz_new = r * z;
        p.sadd(rz_new / rz, z);
        rz = rz_new;
      }
    return CgOutcome::stalled;
  }

  /**
   * Preconditioned conjugate gradients that stop when they meet negative
   * curvature. deal.II's SolverCG and Trilinos' AztecOO and Belos do not look
   * at the curvature: they iterate on for thousands of steps on an indefinite
   * tangent, or return one along which the energy rises.
   *
   * On one rank, where a reduction costs nothing, this is the plain form: the
   * curvature is that of the product with p itself.
   * @param tolerance of the residual, relative to |b|
   * @param iterations in/out: this solve's are added
   * @param needed out: on negative curvature the σ with which that direction
   *        would have had none
   */
  template <typename Preconditioner>
  CgOutcome
  conjugate_gradients(const ShiftedSystem       &system,
                      const Preconditioner      &P,
                      Equilibrium::Vector       &x,
                      const Equilibrium::Vector &b,
                      const double               tolerance,
                      const unsigned int         max_iterations,
                      unsigned int              &iterations,
                      double                    &needed)
  {
    const bool alone =
      Utilities::MPI::n_mpi_processes(b.get_mpi_communicator()) == 1;
    return (alone ? plain_conjugate_gradients<Preconditioner> :
                    one_reduction_an_iteration<Preconditioner>)(system,
                                                                P,
                                                                x,
                                                                b,
                                                                tolerance,
                                                                max_iterations,
                                                                iterations,
                                                                needed);
  }
} // namespace Morula

#endif
