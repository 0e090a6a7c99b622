// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fields_fields_h
#define morula_effects_fields_fields_h

#include <morula/effects/equation.h>
#include <morula/effects/fields/field.h>
#include <morula/effects/fields/field_solve.h>
#include <morula/particles/tissue.h>

#include <string>
#include <vector>

namespace Morula
{
  /** A field over all cells of the tissue, on all ranks. */
  struct FieldTotals
  {
    std::string name;
    double      min, mean, max; // mean over the volume
  };

  /**
   * The fields of a scene: what diffuses through the tissue, is made and used
   * up by cells, and moves with them: doc/theory.md (11.1). Cells keep the
   * values in columns.
   */
  template <int dim>
  class Fields : public Equation<dim>
  {
  public:
    using Parameters = FieldsParameters;

    /** Adds the columns of the fields. @throws InputError */
    Fields(const FieldsParameters   &parameters,
           const EffectSetting<dim> &setting);

    /** Their names and expressions. */
    const FieldsParameters &
    parameters() const
    {
      return parameters_;
    }

    std::unique_ptr<EquationInRun<dim>>
    in_run(const RunTools<dim> &tools) const override;

    bool
    is_steady() const override
    {
      return any(FieldKind::steady);
    }

    bool
    is_transient() const override
    {
      return any(FieldKind::transient);
    }

    /** Gives a founder the initial values. @throws InputError */
    void
    begin(const CellView<dim, double> &cell) const override;

    /** Refuses expressions that a founder has no values for. */
    void
    check_cell(const PresentCell<dim> &founder,
               const double            step) const override;

    /** Refuses values for the surface that it cannot have at t = 0, and
     *  conditions that hold nowhere. */
    void
    check_surface(const std::vector<Point<dim>> &X,
                  const MPI_Comm                 comm) const override;

    void
    review(const Preview<dim> &scene, Review &review) const override
    {
      review_fields(parameters_, scene, review);
    }

    /** The columns of the fields that growth dilutes, doc/theory.md, section
     *  11.4. */
    std::vector<Column<double>>
    densities() const override;

    /**
     * Finds the fields of one kind at the end @p t1 of a step that begins at @p
     * t0 with the tissue as the solver has it, in days; steady ones at t1 = t0.
     * Those on which others depend come first, so that their order in the scene
     * does not matter; those that depend on each other are found in turns until
     * they agree. Collective.
     * @throws InputError  for expressions without a value
     * @throws StepFailed where there is no solution
     */
    FieldsOfStep<dim>
    find(const FieldKind   kind,
         FieldSolver<dim> &solver,
         const double      t0,
         const double      t1) const;

    /** Gives cells the values that were found. */
    void
    set(Tissue<dim> &tissue, const FieldsOfStep<dim> &of_step) const;

    /** Least, mean and largest values in statistics.csv, and how many were
     *  clipped. */
    void
    declare(Tables<dim> &tables) const override;

    /** Whether some are of this kind. */
    bool
    any(const FieldKind kind) const;

    /** The totals of all fields, all 0 where there are no cells. Collective. */
    std::vector<FieldTotals>
    totals(const Tissue<dim> &tissue) const;

  private:
    /** Finds the order in which fields can be found. */
    void
    order();

    /** Fields that depend on each other, or one alone. */
    FieldsOfStep<dim>
    find_group(const std::vector<unsigned int> &group,
               FieldSolver<dim>                &solver,
               const double                     t0,
               const double                     t1) const;

    FieldsParameters parameters_;
    /** Numbers of fields that depend on each other, in the order in which they
     *  are found. */
    std::vector<std::vector<unsigned int>> groups;
    std::vector<Field<dim>>                fields;
    std::vector<Column<double>>            columns;
    std::vector<Column<Tensor<1, dim>>>    gradients;
  };
} // namespace Morula

#endif
