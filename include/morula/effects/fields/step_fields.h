// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fields_step_fields_h
#define morula_effects_fields_step_fields_h

#include <morula/effects/fields/fields.h>

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
  class StepFields : public EquationInRun<dim>
  {
  public:
    StepFields(const Fields<dim> &fields, const RunTools<dim> &tools);

    /** Resets the counts of clipped values. */
    void
    begin_step() override;

    /** Gives cells the steady fields. */
    void
    settle(Tissue<dim>            &tissue,
           const SplineSpace<dim> &space,
           const double            t) override;

    /** Gives cells the transient fields. The tissue is about to move, so the
     *  solver is forgotten. */
    void
    advance(Tissue<dim>            &tissue,
            const SplineSpace<dim> &space,
            const double            t,
            const double            t_next) override;

    /** Forgets the solver. */
    void
    forget_configuration() override;

    /** The fields' columns of statistics.csv. */
    void
    describe(const Tissue<dim> &tissue, NamedNumbers &columns) const override;

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
    const RunTools<dim>             tools;
    std::optional<FieldSolver<dim>> solver;         // of the configuration
    std::vector<std::uint64_t>      clipped;        // by field, in the step
    bool                            warned = false; // of one not converged
    bool                            warned_of_surface = false; // too rough
    bool                            warned_of_nothing = false; // in a piece
  };
} // namespace Morula

#endif
