// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fields_field_solve_h
#define morula_effects_fields_field_solve_h

#include <morula/effects/fields/field.h>
#include <morula/mechanics/assembly.h>
#include <morula/mechanics/equilibrium.h>
#include <morula/particles/tissue.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace Morula
{
  /** Solves A x = b for a positive A, to a residual of @p tolerance |b|.
   *  Collective. @throws StepFailed */
  using SolveLinear = std::function<void(const LinearProblem       &problem,
                                         const Equilibrium::Matrix &A,
                                         Equilibrium::Vector       &x,
                                         const Equilibrium::Vector &b,
                                         const double               tolerance)>;

  /** What was found for one field at the cells of this rank, in their order. */
  template <int dim>
  struct FieldSolution
  {
    unsigned int                number; // of the field
    std::vector<double>         values;
    std::vector<Tensor<1, dim>> gradients; // per µm
    /** Cells, on all ranks, whose value came out negative and was set to 0. */
    std::uint64_t clipped = 0;
    /** Solutions of linear equations that it took. */
    unsigned int iterations = 0;
    /** The last change, relative to the largest value. */
    double change = 0.;
    /** Whether the changes have become small. */
    bool converged = true;
  };

  /** What was found for the fields that were sought. */
  template <int dim>
  using FieldsOfStep = std::vector<FieldSolution<dim>>;

  /**
   * Solves for one field after the other in one configuration, on the splines
   * of the displacement: doc/theory.md, section 11. Keeps references to all
   * that it is given.
   */
  template <int dim>
  class FieldSolver
  {
  public:
    /** Collective. */
    FieldSolver(const Tissue<dim>      &tissue,
                const SplineSpace<dim> &space,
                const CellReader<dim>  &reader,
                const SolveLinear      &solve);

    /**
     * The field number @p number. Later fields see it. Collective.
     * @param t  of the expressions of cells, day
     * @param t1 of the values at the surface, day
     * @param dt 0 for the steady state, day
     * @throws InputError, StepFailed
     */
    FieldSolution<dim>
    field(const Field<dim>  &field,
          const unsigned int number,
          const double       t,
          const double       t1,
          const double       dt);

  private:
    using Vector = Equilibrium::Vector;

    /** The values of the fields that were not sought yet, too. */
    double
    value(const unsigned int field, const unsigned int p) const;

    /** Cells with the values of now. @throws InputError */
    void
    evaluate_cells(const Field<dim>          &field,
                   const unsigned int         number,
                   const double               t,
                   const std::vector<double> &known);

    /** Does something with cell number @p p that has the values of now. */
    template <typename Action>
    void
    with_cell(const unsigned int p, const Action &action) const;

    void
    evaluate_surface(const Field<dim> &field, const double t, const double t1);

    /** Refuses a steady field that nothing holds. */
    void
    check_sink(const Field<dim> &field) const;

    /** The L² projection of cells' values. */
    Vector
    projection(const std::vector<double> &values);

    Vector
    solve_equation(const Vector &known, const double tolerance);

    /** Evaluates what was found at the cells. */
    void
    take(const Vector              &known_field,
         const Vector              &sought,
         const std::vector<double> &known,
         FieldSolution<dim>        &result) const;

    const Tissue<dim>      &tissue;
    const SplineSpace<dim> &space;
    const CellReader<dim>  &reader;
    const SolveLinear      &solve;
    Assembly<dim, 1>        assembly;
    IndexSet                strongly_coupled;
    PointGroups             groups;
    FieldEquation<dim>      equation;
    /** By field and cell: those of now; empty: as the cells have them. */
    std::vector<std::vector<double>> values;
    bool has_found = false; // then some differ from those that cells have
  };
} // namespace Morula

#endif
