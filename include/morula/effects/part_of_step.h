// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_part_of_step_h
#define morula_effects_part_of_step_h

#include <morula/effects/development.h>
#include <morula/effects/tables.h>
#include <morula/mechanics/enclosure.h>
#include <morula/mechanics/equilibrium.h>
#include <morula/mechanics/material.h>
#include <morula/mechanics/material_points.h>
#include <morula/mechanics/momentum_balance.h>
#include <morula/mechanics/term.h>
#include <morula/particles/tissue.h>

#include <deal.II/base/timer.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace Morula
{
  /** An attempt at a step, as effects see it that have a part in it. */
  template <int dim>
  struct AttemptAtStep
  {
    /** The tissue at the beginning of the step, and its splines. */
    const Tissue<dim>            &tissue;
    const SplineSpace<dim>       &space;
    const TissueMaterial         &material;
    const DevelopmentOfStep<dim> &growth;
    const MaterialPoints<dim>    &points;
    /** Beginning and end, day. */
    double t, t_next;
    /** Young's modulus of the stiffest cell, kPa. */
    double typical_stiffness;
    /** Whether something may jump in the step: what is renewed then changes by
     *  parts. */
    bool jumps;
    /** Value of Solver/Kernel. */
    const std::string &kernel;
    /** Value of Solver/Newton tolerance. */
    double newton_tolerance;
    /** What outlives a step, as it was before. */
    const NamedNumbers &kept;
    TimerOutput        &timer;
    MPI_Comm            comm;
  };

  /** A force on boundary points: a row of forces.csv. */
  template <int dim>
  struct ForceOnPoints
  {
    std::string kind, name;
    /** The points for which the term is made. */
    std::function<bool(const BoundaryView<dim> &)> acts_on;
    /** Its forces times the factor are those on the points. */
    const Term<dim> *term;
    double           factor;
  };

  /**
   * The part of an effect in the equilibrium of an attempt. It lives as long as
   * the attempt does, and may hold something fixed while an equilibrium is
   * found. All members are collective.
   */
  template <int dim>
  class PartOfStep : public TurnParticipant
  {
  public:
    /** Its term, if it has one. Asked once. */
    virtual std::unique_ptr<Term<dim>>
    term()
    {
      return nullptr;
    }

    /** A space whose content has a part in the energy; null: none. Its content
     *  may change from turn to turn. */
    virtual Enclosure<dim> *
    enclosure()
    {
      return nullptr;
    }

    /** The first equilibrium of @p balance is sought from @p u on, µm. A
     *  reference to @p balance may be kept. */
    virtual void
    begin(MomentumBalance<dim> &, const Equilibrium::Vector &)
    {}

    /** Whether later turns are balanced as exactly as the first one, by forces
     *  that are small in comparison with those left in their own beginning. */
    virtual bool
    is_exact() const
    {
      return false;
    }

    /** The force at the last equilibrium, if forces.csv has a row for it. */
    virtual std::optional<ForceOnPoints<dim>>
    force() const
    {
      return {};
    }

    /** Writes what outlives the step into @p numbers. */
    virtual void
    keep(NamedNumbers &) const
    {}
  };
} // namespace Morula

#endif
