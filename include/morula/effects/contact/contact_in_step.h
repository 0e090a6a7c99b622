// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_contact_contact_in_step_h
#define morula_effects_contact_contact_in_step_h

#include <morula/effects/contact/contact_pairs.h>
#include <morula/effects/interaction.h>

#include <limits>
#include <string>
#include <vector>

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
   * The contact in an attempt at a step: its pairs hold positions, normals and
   * areas fixed in a turn, and take them anew after it. Keeps references to all
   * that it is given.
   */
  template <int dim>
  class ContactInStep : public InteractionInStep<dim>
  {
  public:
    ContactInStep(const AttemptAtStep<dim> &attempt,
                  const ContactPoints<dim> &points,
                  const ContactLaw         &law);

    PairTerm &
    pairs() override
    {
      return pairs_;
    }

    /** A weak drag acts from where the cells are in each turn. */
    void
    take_drag(Drag<dim> &drag, const bool is_weak) override;

    void
    begin(MomentumBalance<dim> &balance, const Equilibrium::Vector &u) override;

    /** @throws StepFailed where bodies pass through each other, or slide by
     *          more than a grid spacing */
    bool
    renew(const Equilibrium::Vector &u) override;

    std::string
    unfinished() const override;

    std::vector<ForceBetween<dim>>
    forces(const Equilibrium::Vector &u) const override;

  private:
    const AttemptAtStep<dim> &attempt;
    const ContactPoints<dim> &points;
    const ContactLaw          law;
    ContactPairs<dim>         pairs_;
    Drag<dim>                *drag      = nullptr;
    MomentumBalance<dim>     *balance   = nullptr;
    bool                      recentres = false; // the drag
    /** The relevant unknowns at which the geometry is frozen; empty at t. */
    std::vector<double> frozen;
    double              part      = 1.; // of the way that the geometry follows
    double              drag_part = 1.; // of the pairs' drag
    double              left_over = std::numeric_limits<double>::max();
  };
} // namespace Morula

#endif
