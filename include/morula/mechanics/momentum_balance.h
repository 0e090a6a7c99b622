// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_momentum_balance_h
#define morula_mechanics_momentum_balance_h

#include <morula/grid/spline_space.h>
#include <morula/mechanics/equilibrium.h>
#include <morula/mechanics/matrix_scatter.h>
#include <morula/mechanics/rigid_modes.h>
#include <morula/mechanics/term.h>

#include <deal.II/base/timer.h>

#include <memory>
#include <optional>
#include <vector>

namespace Morula
{
  /**
   * The momentum balance of one step: the sum of the scene's terms over the
   * active grid cells, condensed to the unknown splines inside each grid cell
   * (doc/theory.md, sections 2 and 3).
   */
  template <int dim>
  class MomentumBalance : public Equilibrium
  {
  public:
    using TermList = std::vector<std::unique_ptr<Term<dim>>>;

    /**
     * Keeps references to the space and the terms.
     * @param youngs_modulus a typical one, kPa
     * @param rigid_modes    unsupported rigid motions: the null space
     */
    MomentumBalance(const SplineSpace<dim> &space,
                    const TermList         &terms,
                    const double            youngs_modulus,
                    const RigidModes<dim>  &rigid_modes,
                    TimerOutput            &timer,
                    const MPI_Comm          comm);

    void
    initialize(Vector &vector) const override;

    Evaluation
    residual(const Vector &u, Vector &R) const override;

    double
    rounding(const Vector &u) const override;

    const Matrix &
    tangent(const Vector &u, const GrowthAt growth) override;

    bool
    is_conservative() const override;

    const std::vector<Vector> &
    null_space() const override;

    double
    small_force() const override;

    double
    stiffness_scale() const override;

  private:
    Evaluation
    assemble_residual(const Vector                           &u,
                      const typename LocalSystem<dim>::Wanted wanted,
                      Vector                                 &sum) const;

    const SplineSpace<dim>           &space;
    const TermList                   &terms;
    const double                      youngs_modulus;
    const std::vector<Vector>         null_space_;
    TimerOutput                      &timer;
    const MPI_Comm                    comm;
    Matrix                            matrix;
    std::optional<MatrixScatter<dim>> scatter; // made with the first tangent
  };
} // namespace Morula

#endif
