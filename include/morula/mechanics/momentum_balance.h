// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_momentum_balance_h
#define morula_mechanics_momentum_balance_h

#include <morula/grid/spline_space.h>
#include <morula/mechanics/assembly.h>
#include <morula/mechanics/enclosure.h>
#include <morula/mechanics/equilibrium.h>
#include <morula/mechanics/rigid_modes.h>
#include <morula/mechanics/term.h>

#include <deal.II/base/timer.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace Morula
{
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
    using TermList      = std::vector<std::unique_ptr<Term<dim>>>;
    using EnclosureList = std::vector<const Enclosure<dim> *>;

    /** Keeps references to the space, the terms and the timer.
     *  @param enclosures that the tissue surrounds; they stay where they are
     *         as long as this object, their contents may change
     *  @param pairs a term that couples grid cells, or null */
    MomentumBalance(const SplineSpace<dim> &space,
                    const TermList         &terms,
                    TimerOutput            &timer,
                    const MPI_Comm          comm,
                    EnclosureList           enclosures = {},
                    const PairTerm         *pairs      = nullptr)
      : space(space)
      , terms(terms)
      , timer(timer)
      , comm(comm)
      , assembly(space, comm)
      , enclosures(std::move(enclosures))
      , pairs(pairs)
    {}

    /** To be called where the pair term has new links. */
    void
    renew_links()
    {
      has_new_links = true;
    }

    /** The values of @p u at the relevant unknowns, as a pair term wants them.
     *  Collective. */
    std::vector<double>
    relevant_values(const Vector &u) const
    {
      return assembly.unknowns().fetch(u);
    }

    /** u = 0. Collective. */
    Vector
    rest() const
    {
      return assembly.unknowns().zero();
    }

    Evaluation
    residual(const Vector &u, Vector &R) const override
    {
      return evaluate(u, R, nullptr);
    }

    double
    residual_magnitude(const Vector &u) const override
    {
      Vector R(u);
      double magnitude;
      residual_and_magnitude(u, R, magnitude);
      return magnitude;
    }

    Evaluation
    residual_and_magnitude(const Vector &u,
                           Vector       &R,
                           double       &magnitude) const override
    {
      Vector           magnitudes;
      const Evaluation evaluation = evaluate(u, R, &magnitudes);
      magnitude = magnitudes.size() == 0 ? 0. : magnitudes.l2_norm();
      return evaluation;
    }

    /** The smallest J_e of an evaluation over all ranks. Collective. */
    Extreme
    smallest_J(const Evaluation &evaluation) const;

    /** The largest gap of an evaluation over all ranks. Collective. */
    Morula::Extreme<dim>
    largest_gap(const Evaluation &evaluation) const;

    /** Whether the state @p u is so far from the @p begin of the step that the
     *  step is plainly too long: it moves the tissue by more than a grid
     * spacing, or squeezes some of it below 0.3 of its volume. Collective. */
    bool
    is_far_from(const Vector &begin, const Vector &u) const
    {
      // Tissue that is squeezed to less than this part of its volume within a
      // step has left the range in which Newton's method converges from the old
      // state.
      constexpr double least_J = 0.3;
      Vector           moved(u), R(u);
      moved -= begin;
      return moved.linfty_norm() > space.box().spacing() ||
             smallest_J(residual(u, R)).value < least_J;
    }

    /** Describes the state u to the user if Newton's method fails there:
     *  extreme values and their places. Collective. */
    std::string
    describe(const Vector &u) const;

    /** The first tangent of a step, at the growth at t, is the exact one; later
     *  ones take volume changes from the linearisation at the one before. */
    const Matrix &
    tangent(const Vector &u, const GrowthAt growth) override;

    const RankOnes &
    rank_ones() const override
    {
      return of_contents;
    }

    /** Volume of an enclosure at u, µm^dim. Collective. */
    double
    enclosed_volume(const Enclosure<dim> &enclosure, const Vector &u) const
    {
      Vector ignored;
      return enclosure.volume + gain(enclosure, u, ignored).first;
    }

    void
    use_growth_at_end() override
    {
      goes_on = true;
    }

    /**
     * What a linear solver should know of the tangents. Collective.
     * @param youngs_modulus a typical one, kPa
     * @param null_space     as from RigidModes::inertia()
     * @param n_cells        on this rank
     */
    LinearProblem
    linear_problem(const double        youngs_modulus,
                   std::vector<Vector> null_space,
                   const unsigned int  n_cells) const;

    /** The scales with which Newton's method compares; @p youngs_modulus is a
     *  typical one (kPa): doc/theory.md (5.3). */
    NewtonScales
    scales(const double youngs_modulus) const
    {
      const double h = space.box().spacing();
      // A force on the face of a grid cell counts as small at a millionth of
      // Young's modulus: doc/theory.md (5.3).
      return {1e-6 * youngs_modulus * std::pow(h, dim - 1), h};
    }

  private:
    /** The functions below that get @p magnitudes also find the magnitudes of
     *  what is added up, if the pointer is not null. */
    Evaluation
    evaluate(const Vector &u, Vector &R, Vector *magnitudes) const
    {
      // The content of a lumen follows from the volume at u, which an inverted
      // state does not have.
      Evaluation evaluation = sum_up(u, R, magnitudes);
      for (const Enclosure<dim> *const enclosure : enclosures)
        if (std::isfinite(evaluation.energy))
          add_content(*enclosure, u, evaluation, R, magnitudes);
      return evaluation;
    }

    /** The terms' part of evaluate(). */
    Evaluation
    sum_up(const Vector &u, Vector &R, Vector *magnitudes) const;

    /** The volume that an enclosure gains, Σ|contributions| to it, and its
     *  derivative. */
    std::pair<double, double>
    gain(const Enclosure<dim> &enclosure,
         const Vector         &u,
         Vector               &derivative,
         Vector               *magnitudes = nullptr) const;

    /** Adds energy and forces of an enclosure's content. */
    void
    add_content(const Enclosure<dim> &enclosure,
                const Vector         &u,
                Evaluation           &evaluation,
                Vector               &R,
                Vector               *magnitudes) const;

    /** Whether all terms have an energy, so that tangents are symmetric. */
    bool
    has_energy() const
    {
      return std::all_of(terms.begin(), terms.end(), [](const auto &term) {
        return term->is_conservative();
      });
    }

    static typename LocalSystem<dim>::Wanted
    wanted(const Vector *magnitudes)
    {
      return magnitudes != nullptr ? LocalSystem<dim>::rounding :
                                     LocalSystem<dim>::energy_and_residual;
    }

    /** Takes a grid cell's extremes into account. */
    void
    update_extremes(const LocalSystem<dim> &system,
                    const unsigned int      number,
                    Evaluation             &evaluation) const;

    /** A place near which the largest entry of @p R acts. */
    Point<dim>
    place_of_largest(const Vector &R) const;

    const SplineSpace<dim> &space;
    const TermList         &terms;
    TimerOutput            &timer;
    const MPI_Comm          comm;
    Assembly<dim>           assembly;
    const EnclosureList     enclosures;
    const PairTerm         *pairs;
    bool                    has_new_links = false;
    bool                    goes_on       = false;
    RankOnes                of_contents; // of the last tangent

    // Linearisations at the last tangent, by active grid cell; empty if no term
    // has any.
    std::vector<std::vector<VolumeLinearisation<dim>>> linearisations;
  };
} // namespace Morula

#endif
