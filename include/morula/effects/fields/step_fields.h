// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fields_step_fields_h
#define morula_effects_fields_step_fields_h

#include <morula/base/announce.h>
#include <morula/effects/development.h>
#include <morula/effects/fields/fields.h>
#include <morula/effects/tables.h>

#include <deal.II/base/timer.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace Morula
{
  /**
   * The fields of a scene in the steps of a run. The solver is made for the
   * first field of a configuration, shared by the others, and kept until the
   * tissue moves. Keeps references to what it is made from.
   */
  template <int dim>
  class StepFields
  {
  public:
    StepFields(const Fields<dim>          &fields,
               const FieldsParameters     &parameters,
               const CellDevelopment<dim> &development,
               const MakeLinearSolver     &make_solver,
               TimerOutput                &timer,
               const Announce             &announce);

    /** Resets the counts of clipped values for the next step. */
    void
    begin_step();

    /** Gives cells the steady fields of the configuration at @p t, day.
     *  @throws InputError, StepFailed on all ranks */
    void
    set_steady(Tissue<dim>            &tissue,
               const SplineSpace<dim> &space,
               const double            t);

    /** Finds the transient fields at the end of the step that begins at @p t.
     * The tissue is about to move, so the solver is forgotten. @throws
     * InputError, StepFailed on all ranks */
    FieldsOfStep<dim>
    transient(const Tissue<dim>      &tissue,
              const SplineSpace<dim> &space,
              const double            t,
              const double            t_next);

    /** Forgets the solver of this configuration: the splines of the next one
     * will stand elsewhere. */
    void
    forget_configuration();

    /** The fields' columns of statistics.csv. Collective. */
    void
    describe(const Tissue<dim> &tissue, NamedNumbers &columns) const;

  private:
    /** The fields of one kind at @p t1. */
    FieldsOfStep<dim>
    find(const FieldKind         kind,
         const Tissue<dim>      &tissue,
         const SplineSpace<dim> &space,
         const double            t,
         const double            t1);
    /** @throws InputError about a field that has no steady state */
    void
    warn_if_unsettled(const FieldSolution<dim> &field, const double t);
    void
    warn_if_raised(const FieldSolution<dim> &field, const double t);
    void
    warn_of_nothing(const FieldSolution<dim> &field, const double t);

    const Fields<dim>              &fields;
    const FieldsParameters         &parameters;
    const CellDevelopment<dim>     &development;
    const MakeLinearSolver          make_solver;
    TimerOutput                    &timer;
    const Announce                  announce;
    std::optional<FieldSolver<dim>> solver;         // of the configuration
    std::vector<std::uint64_t>      clipped;        // by field, in the step
    bool                            warned = false; // of one not converged
    bool                            warned_of_surface = false; // too rough
    bool                            warned_of_nothing = false; // in a piece
  };
} // namespace Morula

#endif
