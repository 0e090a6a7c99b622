// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fields_fields_h
#define morula_effects_fields_fields_h

#include <morula/effects/fields/field.h>
#include <morula/effects/fields/field_equation.h>
#include <morula/mechanics/assembly.h>
#include <morula/mechanics/equilibrium.h>
#include <morula/particles/tissue.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace Morula
{
  struct LinearAccuracy;

  /** What was found for one field at the cells of this rank, in their order. */
  template <int dim>
  struct FieldSolution
  {
    unsigned int        number; // of the field
    std::vector<double> values;
    /** The gradients at the cells, per µm; empty where cells have no column for
     *  it. */
    std::vector<Tensor<1, dim>> gradients;
    /** Cells, on all ranks, whose value came out negative and was set to 0. */
    std::uint64_t clipped = 0;
    /** Solutions of linear equations that it took. */
    unsigned int iterations = 0;
    /** The last change, relative to the largest value. */
    double change = 0.;
    /** What the penalty of fixed values had to be multiplied by. */
    double raised = 1.;
    /** Whether the changes have become small. */
    bool converged = true;
    /** By how much the largest value grew in iterations that did not converge.
     */
    double growth = 1.;
    /** Pieces of the tissue in which a steady field has neither source nor sink
     *  and is 0. */
    unsigned int pieces_of_nothing = 0;
  };

  /** What was found for the fields that were sought. */
  template <int dim>
  using FieldsOfStep = std::vector<FieldSolution<dim>>;

  /**
   * Solves for one field after the other in one configuration, on the splines
   * of the displacement: doc/theory.md, section 11. What the fields and their
   * iterations share is made once. Keeps references to the tissue, the splines
   * and what the reader refers to.
   */
  template <int dim>
  class FieldSolver
  {
  public:
    /** Collective. */
    FieldSolver(const Tissue<dim>      &tissue,
                const SplineSpace<dim> &space,
                const CellReader<dim>  &reader,
                const MakeLinearSolver &make_solver);

    /**
     * The field number @p number. Fields solved later see its values.
     * Collective.
     * @param t  of the cells' state, day
     * @param t1 of all expressions, day: t for the steady state, else the end
     *        of the step that begins at t
     * @throws InputError, StepFailed
     */
    FieldSolution<dim>
    field(const Field<dim>  &field,
          const unsigned int number,
          const double       t,
          const double       t1);

    /** The largest value of all ranks' cells. Collective. */
    double
    size(const std::vector<double> &of_cells) const;

    /** The largest change, relative to the largest value after it. Collective.
     */
    double
    relative_change(const std::vector<double> &before,
                    const std::vector<double> &after) const;

  private:
    using Vector = Equilibrium::Vector;

    /** The value of a field at a cell; fields not solved yet keep their former
     *  value. */
    double
    value(const unsigned int field, const unsigned int p) const
    {
      return values[field].empty() ?
               tissue.cells()[p].get(reader.columns.fields[field]) :
               values[field][p];
    }

    /** Cell number @p p with the values of now. */
    PresentCell<dim>
    present_cell(const unsigned int p) const
    {
      const Cells<dim> &cells = tissue.cells();
      PresentCell<dim>  cell(cells[p], cells.id(p), cells.position(p), reader);
      for (unsigned int k = 0; k < values.size(); ++k)
        if (!values[k].empty())
          cell.set_field(k, values[k][p]);
      return cell;
    }

    /** What cells do, before the first iteration: all but their uptake. @throws
     *  InputError */
    void
    begin_cells(const Field<dim> &field, const double t);

    /** Linearises at the values of now; load is all that comes. @throws
     *  InputError */
    void
    linearise_cells(const Field<dim>          &field,
                    const unsigned int         number,
                    const double               t,
                    const double               dt,
                    const std::vector<double> &before);

    /** The load of a steady field at the values of now, with the slopes of the
     *  last linearise_cells(). @throws InputError */
    void
    renew_loads(const Field<dim>  &field,
                const unsigned int number,
                const double       t);

    void
    evaluate_surface(const Field<dim> &field, const double t);

    /** Refuses a steady field whose level nothing determines, in all of the
     *  tissue or in a piece in which something makes it. Collective.
     *  @return how many pieces have neither source nor sink */
    unsigned int
    check_sink(const Field<dim> &field) const;

    /** The spline nearest to what cells would come to by themselves, in the
     *  metric of the equation: its projection. */
    Vector
    projection();

    /**
     * What cells keep of what they would come to by themselves:
     * doc/theory.md (11.7), (11.8). Loads become those of what is
     * sought.
     * @param known      what is not sought of the values
     * @param known_field what is not sought of the splines
     */
    void
    set_known(std::vector<double> &known, Vector &known_field);

    /**
     * Raises the penalty of fixed values where the matrix is not positive.
     * @param start where conjugate gradients begin
     * @param same_matrix whether only loads differ from the last equation's
     */
    Vector
    solve_equation(const Vector         &known,
                   const Vector         &start,
                   const LinearAccuracy &accuracy,
                   const bool            same_matrix = false);

    /** Gives fixed values a larger penalty, for a matrix that is not positive:
     *  doc/theory.md (11.3). Collective. @throws StepFailed if there is none,
     * or if it is large already */
    void
    raise_penalty();

    /**
     * Iterates from the values of now, with no grid cell lumped at first.
     * @param dt     0 for the steady state, day
     * @param result takes the values, and how they were found
     * @return the first change, as relative_change()
     */
    double
    iterate(const Field<dim>   &field,
            const double        t,
            const double        dt,
            FieldSolution<dim> &result);

    /** Calls action(p, value) for each cell: with its number and the value of a
     *  field of splines at its place. */
    template <typename Action>
    void
    at_cells(const Vector &field, const Action &action) const;

    /** Values at the cells from what was found.
     *  @param balanced whether what cells use up stays where values are set to
     *  zero */
    void
    take(const Vector              &sought,
         const std::vector<double> &known,
         const bool                 balanced,
         FieldSolution<dim>        &result) const;

    /** Gradients at the cells. */
    std::vector<Tensor<1, dim>>
    gradients(const Vector &field) const;

    const Tissue<dim>      &tissue;
    const SplineSpace<dim> &space;
    const CellReader<dim>   reader;
    const MakeLinearSolver  make_solver;
    Assembly<dim, 1>        assembly;
    FieldEquation<dim>      equation;
    /** What is known of one field's matrices: the preconditioner of one serves
     *  the next ones while they are much like it. */
    LinearProblem problem;
    SolveLinear   linear; // empty: none yet
    /** Production by cell, in the field's unit per day. */
    std::vector<double> productions;
    /** Values by field and cell as they are now; empty: as the cells have them.
     *  */
    std::vector<std::vector<double>> values;
    /** Boundary points where bodies touch and fields pass, so that they are no
     *  surface for fields; nothing before they are asked for, and without
     *  contact. */
    std::optional<std::vector<char>> touching;
  };

  /** Groups of fields, by their numbers, each after those on which it depends:
   *  fields that depend on each other, or one alone. */
  template <int dim>
  std::vector<std::vector<unsigned int>>
  groups_of(const std::vector<Field<dim>> &fields);

  /** Finds the fields of a group: those that depend on each other in turns,
   *  until they agree. Collective. @throws InputError, StepFailed */
  template <int dim>
  FieldsOfStep<dim>
  find_group(const std::vector<Field<dim>>   &fields,
             const std::vector<unsigned int> &group,
             FieldSolver<dim>                &solver,
             const double                     t0,
             const double                     t1);
} // namespace Morula

#endif
