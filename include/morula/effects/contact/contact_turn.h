// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_contact_contact_turn_h
#define morula_effects_contact_contact_turn_h

#include <morula/effects/contact/contact_forces.h>
#include <morula/effects/contact/contact_pairs.h>
#include <morula/mechanics/drag.h>
#include <morula/mechanics/momentum_balance.h>
#include <morula/mechanics/turn_participant.h>

#include <deal.II/base/timer.h>

#include <string>

namespace Morula
{
  /**
   * Whether boundary points that were too far apart at t to be candidates have
   * passed through another body, or into one. Collective.
   * @param h grid spacing, µm
   */
  template <int dim>
  bool
  has_crossed_from_afar(const Tissue<dim>            &tissue,
                        const ContactPoints<dim>     &points,
                        const DisplacementField<dim> &displacement,
                        const double                  h);

  /**
   * The contact of a step: its pairs hold positions, normals and areas fixed in
   * a turn, and take them anew after it. Keeps references to all that it is
   * given.
   */
  template <int dim>
  class ContactTurn : public TurnParticipant
  {
  public:
    /** @param drag the drag of the step
     *  @param recentres whether in each turn it acts from where the cells are
     *         then: the weak one does */
    ContactTurn(const Tissue<dim>        &tissue,
                const SplineSpace<dim>   &space,
                const ContactPoints<dim> &points,
                const ContactLaw         &law,
                ContactPairs<dim>        &pairs,
                Drag<dim>                &drag,
                const bool                recentres,
                MomentumBalance<dim>     &balance,
                TimerOutput              &timer,
                const MPI_Comm            comm);

    /** @throws StepFailed where bodies pass through each other, or slide by
     *          more than a grid spacing */
    bool
    renew(const Equilibrium::Vector &u) override;

    std::string
    unfinished() const override;

    /** The forces in the equilibrium that was found. Collective. */
    std::vector<ContactForce<dim>>
    forces(const Equilibrium::Vector &u) const;

  private:
    const Tissue<dim>        &tissue;
    const SplineSpace<dim>   &space;
    const ContactPoints<dim> &points;
    const ContactLaw          law;
    ContactPairs<dim>        &pairs;
    Drag<dim>                &drag;
    MomentumBalance<dim>     &balance;
    TimerOutput              &timer;
    const MPI_Comm            comm;
    const bool                recentres; // the drag
    /** The relevant unknowns at which the geometry is frozen; empty at t. */
    std::vector<double> frozen;
    double              part      = 1.; // of the way that the geometry follows
    double              drag_part = 1.; // of the pairs' drag
    double              left_over = std::numeric_limits<double>::max();
  };
} // namespace Morula

#endif
