// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_momentum_balance_h
#define morula_mechanics_momentum_balance_h

#include <morula/grid/spline_space.h>
#include <morula/mechanics/assembly.h>
#include <morula/mechanics/equilibrium.h>
#include <morula/mechanics/rigid_modes.h>
#include <morula/mechanics/term.h>

#include <deal.II/base/timer.h>

#include <memory>
#include <optional>
#include <vector>

namespace Morula
{
  /** Where a state of the tissue is at its worst. */
  template <int dim>
  struct Extremes
  {
    /** Smallest J_e of any point, or det f where the step inverts it. */
    double     smallest_J;
    Point<dim> place_of_J; // µm, in the configuration at t
    /** Largest distance of a held point from where it is held, µm; negative:
     *  none is held. */
    double     largest_gap;
    Point<dim> place_of_gap;
  };

  /**
   * The momentum balance of one step, that is the principle of virtual work,
   * equation (1) of the paper: the energy of doc/theory.md (2.1) and its
   * derivatives. It is the sum of the scene's terms over the active grid cells,
   * condensed to the unknown splines inside each grid cell.
   */
  template <int dim>
  class MomentumBalance : public Equilibrium
  {
  public:
    using TermList = std::vector<std::unique_ptr<Term<dim>>>;

    /**
     * Keeps references to the space and the terms.
     * @param youngs_modulus a typical one, kPa
     * @param null_space     orthonormal; forces along them are left out, and
     *                       u is sought orthogonal to them: as in
     *                       RigidModes::inertia()
     */
    MomentumBalance(const SplineSpace<dim> &space,
                    const TermList         &terms,
                    const double            youngs_modulus,
                    std::vector<Vector>     null_space,
                    TimerOutput            &timer,
                    const MPI_Comm          comm);

    void
    initialize(Vector &vector) const override;

    Evaluation
    residual(const Vector &u, Vector &R) const override;

    double
    rounding(const Vector &u) const override;

    /** Of the state that residual() was last called for. Collective. */
    Extremes<dim>
    extremes() const;

    std::string
    describe(const Vector &R) const override;

    /** The first tangent of a step, at the growth at t, is the exact one; later
     *  ones take volume changes from the linearisation at the one before. */
    const Matrix &
    tangent(const Vector &u, const GrowthAt growth) override;

    bool
    is_conservative() const override;

    const std::vector<Vector> &
    null_space() const override;

    double
    small_force() const override;

    /** Those of the extended splines in this rank's grid cells: the tangent
     *  couples these many times as much as others. */
    IndexSet
    coupled_dofs() const override;

    /** The grid spacing h. */
    double
    typical_length() const override;

    double
    stiffness_scale() const override;

  private:
    Evaluation
    sum_up(const Vector                           &u,
           const typename LocalSystem<dim>::Wanted wanted,
           Vector                                 &sum) const;

    /** Takes a grid cell's extremes into account. */
    void
    update_extremes(const LocalSystem<dim> &system,
                    const unsigned int      number) const;

    /** Near which place the largest entry of @p R acts. */
    Point<dim>
    place_of_largest(const Vector &R) const;

    const SplineSpace<dim>   &space;
    const TermList           &terms;
    const double              youngs_modulus;
    const std::vector<Vector> null_space_;
    TimerOutput              &timer;
    const MPI_Comm            comm;
    Assembly<dim>             assembly;
    mutable Extremes<dim>     extremes_of_rank; // last evaluation's

    // The last tangent's, by active grid cell; empty if no term has any.
    std::vector<std::optional<VolumeLinearisation<dim>>> linearisations;
  };
} // namespace Morula

#endif
