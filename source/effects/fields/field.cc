// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/instantiate.h>
#include <morula/base/key.h>
#include <morula/effects/fields/fields.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <sstream>
#include <vector>

namespace Morula
{
  namespace
  {
    /** k c is differentiated by such differences of c, relative to c and to the
     *  field's scale. They are so small that k does not change its kind, as at
     *  a threshold, and so large that k is told from rounding. */
    constexpr double difference = 1e-6, smallest_difference = 1e-9;

    /** The value at a place, as the expression's rule wants it. */
    template <int dim>
    double
    at_place(const Expression &expression, const Point<dim> &X, const double t)
    {
      // In 2-D Z is 0.
      VariableValues values;
      for (unsigned int d = 0; d < 3; ++d)
        values[d] = d < dim ? X[d] : 0.;
      values[static_cast<unsigned int>(Variable::t)] = t;
      return expression.value(values);
    }
  } // namespace


  template <int dim>
  Field<dim>::Field(const FieldKeys          &keys,
                    const unsigned int        number,
                    const EffectSetting<dim> &setting)
    : name_(keys.name)
    , number(number)
    , kind_(keys.is_steady() ? FieldKind::steady : FieldKind::transient)
    , diluted(keys.dilution)
    , diffusion_(setting.state.use(keys.diffusion))
    , production_(setting.state.use(keys.production))
    , consumption(setting.state.use(keys.consumption))
    , initial_(keys.initial.expression(dim))
    , value_(keys.value.expression(dim))
    , fixed_where(keys.fixed_where.optional(dim))
    , transfer_(keys.transfer.optional(dim))
    , flux_(keys.flux.optional(dim))
    , flux_where(keys.flux_where.optional(dim))
  {}


  template <int dim>
  double
  Field<dim>::initial(const Point<dim> &X) const
  {
    return at_place(initial_, X, 0.);
  }


  template <int dim>
  Uptake
  Field<dim>::uptake(PresentCell<dim> &cell,
                     const double      t,
                     const double      c,
                     const double      scale) const
  {
    // A rate that does not read the field has itself as its slope.
    if (!consumption.uses(field_variable(number)))
      {
        const double k = cell.value(consumption, t);
        return {k * c, k};
      }
    // The difference goes upwards, so that c stays in the range that the
    // expression was written for. A negative slope would make the matrix
    // indefinite, so it counts as 0: doc/theory.md (11.4).
    const double more =
      c + std::max(difference * c, smallest_difference * scale);
    const double used_more = used(cell, t, more), used_now = used(cell, t, c);
    return {used_now, std::max(0., (used_more - used_now) / (more - c))};
  }


  template <int dim>
  bool
  Field<dim>::is_fixed(const Point<dim> &X) const
  {
    return fixed_where && at_place(*fixed_where, X, 0.) > 0.;
  }


  template <int dim>
  double
  Field<dim>::value(const Point<dim> &X, const double t) const
  {
    return at_place(value_, X, t);
  }


  template <int dim>
  double
  Field<dim>::transfer(const Point<dim> &X, const double t) const
  {
    return transfer_ ? at_place(*transfer_, X, t) : 0.;
  }


  template <int dim>
  bool
  Field<dim>::takes_flux(const Point<dim> &X) const
  {
    // A point that has the Value takes no flux.
    return flux_where && at_place(*flux_where, X, 0.) > 0. && !is_fixed(X);
  }


  template <int dim>
  double
  Field<dim>::flux(const Point<dim> &X, const double t) const
  {
    return takes_flux(X) ? at_place(*flux_, X, t) : 0.;
  }


  template class Field<2>;
  template class Field<3>;


  template <int dim>
  unsigned int
  FieldSolver<dim>::check_sink(const Field<dim> &field) const
  {
    // Nothing diffuses from piece to piece, so each needs a sink of its own.
    // The sums of all ranks are added up, as a piece may run through several:
    // what takes from the field, what gives to it, and the number of cells.
    const unsigned int  n = space.n_pieces();
    std::vector<double> sums(3 * n, 0.);
    for (unsigned int c = 0; c < space.grid_cells().size(); ++c)
      {
        const auto   &grid_cell = space.grid_cells()[c];
        double *const of =
          &sums[3 * space.piece(grid_cell.number, grid_cell.part)];
        for (unsigned int k = equation.cell_places.offsets[c];
             k < equation.cell_places.offsets[c + 1];
             ++k)
          {
            of[0] += equation.cells[k].volume * equation.cells[k].rate;
            of[1] += equation.cells[k].volume * equation.cells[k].load;
            of[2] += 1.;
          }
        if (equation.surface.empty())
          continue;
        for (unsigned int k = equation.surface_places.offsets[c];
             k < equation.surface_places.offsets[c + 1];
             ++k)
          {
            const FieldAtSurface<dim> &point = equation.surface[k];
            of[0] += point.weight + point.fixed;
            of[1] += point.inflow;
          }
      }
    Utilities::MPI::sum(sums, tissue.communicator(), sums);
    unsigned int n_nothing = 0, n_determined = 0;
    bool         grows = false;
    for (unsigned int p = 0; p < n; ++p)
      {
        const bool has_cells = sums[3 * p + 2] > 0., sinks = sums[3 * p] > 0.;
        n_determined += sinks;
        n_nothing += has_cells && !sinks;
        grows = grows || (has_cells && !sinks && sums[3 * p + 1] > 0.);
      }
    if (n_determined == 0 || grows)
      throw InputError(
        "Fields/" + field.name() + "/Consumption",
        "",
        "a rate > 0 1/day at some cell, or a value or a transfer > 0 at some "
        "boundary point, of each separate piece of the tissue in which "
        "something makes the field",
        "Without a sink a steady field has no level: any constant could be "
        "added to it. Dead cells take nothing.");
    return n_nothing;
  }

  template class FieldSolver<2>;
  template class FieldSolver<3>;


  namespace
  {
    /** A field that has grown by more in iterations that did not converge has
     *  no steady state. */
    constexpr double most_growth = 1e4;

    /**
     * The fields of a scene in the steps of a run. The solver is made for the
     * first field of a configuration, shared by the others, and kept until the
     * tissue moves. Keeps references to what it is made from.
     */
    template <int dim>
    class StepFields : public EquationInRun<dim>
    {
    public:
      StepFields(const Fields<dim> &fields, const RunTools<dim> &tools)
        : fields(fields)
        , parameters(fields.parameters())
        , tools(tools)
      {}

      /** Resets the counts of clipped values. */
      void
      begin_step() override
      {
        clipped.clear();
      }

      /** Gives cells the steady fields. */
      void
      settle(Tissue<dim>            &tissue,
             const SplineSpace<dim> &space,
             const double            t) override
      {
        fields.set(tissue, find(FieldKind::steady, tissue, space, t, t));
        // The transient fields of this step use the same configuration, and
        // then the same solver. Without any nothing else will ask for it.
        if (!fields.any(FieldKind::transient))
          forget_configuration();
      }

      /** Gives cells the transient fields. The tissue is about to move, so the
       *  solver is forgotten. */
      void
      advance(Tissue<dim>            &tissue,
              const SplineSpace<dim> &space,
              const double            t,
              const double            t_next) override
      {
        // The tissue moves after this call. What the solver has summed belongs
        // to the places before.
        const FieldsOfStep<dim> found =
          find(FieldKind::transient, tissue, space, t, t_next);
        forget_configuration();
        fields.set(tissue, found);
      }

      /** Forgets the solver. */
      void
      forget_configuration() override
      {
        solver.reset();
      }

      /** The fields' columns of statistics.csv. */
      void
      describe(const Tissue<dim> &tissue, NamedNumbers &columns) const override
      {
        // Before the first call of find() nothing was clipped.
        fields.describe(tissue, columns);
        for (std::size_t k = 0; k < parameters.fields.size(); ++k)
          columns[parameters.fields[k].name + "_clipped"] =
            k < clipped.size() ? double(clipped[k]) : 0.;
      }

    private:
      /** The fields of one kind at @p t1. */
      FieldsOfStep<dim>
      find(const FieldKind         kind,
           const Tissue<dim>      &tissue,
           const SplineSpace<dim> &space,
           const double            t,
           const double            t1)
      {
        // The first call in a configuration makes the solver, with the sums
        // over cells and the surface that all fields share. Each solution is
        // then looked at for what the user should know: negative values that
        // were cut off (doc/theory.md, section 11.3), and fields that are
        // inexact. Collective; the solution is equal on all ranks as far as
        // these warnings ask.
        if (!fields.any(kind))
          return {};
        const TimerOutput::Scope section(tools.timer, "fields");
        if (!solver)
          solver.emplace(tissue, space, tools.reader(t), tools.make_solver);
        FieldsOfStep<dim> found;
        try
          {
            found = fields.find(kind, *solver, t, t1);
          }
        catch (const StepFailed &failure)
          {
            throw StepFailed("the equation of a field could not be solved: " +
                             std::string(failure.what()));
          }
        clipped.resize(parameters.fields.size(), 0);
        for (const FieldSolution<dim> &field : found)
          {
            clipped[field.number] += field.clipped;
            warn_if_unsettled(field, t);
            warn_if_raised(field, t);
            warn_of_nothing(field, t);
          }
        return found;
      }
      /** @throws InputError about a field that has no steady state */
      void
      warn_if_unsettled(const FieldSolution<dim> &field, const double t)
      {
        if (field.converged)
          return;
        const std::string &name = parameters.fields[field.number].name;
        // Iterations that fail to settle stay within bounds; here each makes
        // more of the field than the one before.
        if (field.growth > most_growth)
          throw InputError(
            "Fields/" + name + "/Production",
            parameters.fields[field.number].production.text(),
            "less than what cells use up, also where it depends on "
            "the field itself or on fields that depend on it",
            "The field grows with every iteration, by " +
              as_text(field.growth) +
              " so far, and has no steady state: lower Production, "
              "raise Consumption, let Production saturate, or set "
              "Time = transient with a shorter step.");
        if (warned)
          return;
        warned = true;
        std::ostringstream text;
        text
          << "Warning: at t = " << t << " day the field '"
          << parameters.fields[field.number].name << "' still changed by "
          << field.change << " of its largest value after " << field.iterations
          << " iterations, as what cells do to it depends on itself. The next "
             "step goes on from there; expressions without jumps converge "
             "better. Later ones are not told of.";
        tools.announce(text.str());
      }
      void
      warn_if_raised(const FieldSolution<dim> &field, const double t)
      {
        if (!(field.raised > 1.) || warned_of_surface)
          return;
        warned_of_surface = true;
        std::ostringstream text;
        text
          << "Warning: at t = " << t << " day the fixed value of the field '"
          << parameters.fields[field.number].name << "' was enforced "
          << field.raised
          << " times as strongly as usual: the surface is rough, or the tissue "
             "thin, within a grid spacing, and the field is inexact there. Take "
             "a smaller Grid/Spacing with smaller cells, or keep the surface "
             "smooth by Boundary conditions/Surface tension. Later times are "
             "not told of.";
        tools.announce(text.str());
      }
      void
      warn_of_nothing(const FieldSolution<dim> &field, const double t)
      {
        if (field.pieces_of_nothing == 0 || warned_of_nothing)
          return;
        warned_of_nothing = true;
        std::ostringstream text;
        text
          << "Warning: at t = " << t << " day "
          << (field.pieces_of_nothing == 1 ?
                "a separate piece" :
                std::to_string(field.pieces_of_nothing) + " separate pieces")
          << " of the tissue has neither source nor sink of the steady field '"
          << parameters.fields[field.number].name
          << "': its level there is not determined, and is set to 0. Give it a "
             "Consumption, a fixed value or a Transfer there. Later ones are "
             "not told of.";
        tools.announce(text.str());
      }

      const Fields<dim>              &fields;
      const FieldsParameters         &parameters;
      const RunTools<dim>             tools;
      std::optional<FieldSolver<dim>> solver;         // of the configuration
      std::vector<std::uint64_t>      clipped;        // by field, in the step
      bool                            warned = false; // of one not converged
      bool                            warned_of_surface = false; // too rough
      bool                            warned_of_nothing = false; // in a piece
    };
  } // namespace


  template <int dim>
  std::unique_ptr<EquationInRun<dim>>
  fields_in_run(const Fields<dim> &fields, const RunTools<dim> &tools)
  {
    return std::make_unique<StepFields<dim>>(fields, tools);
  }


  MORULA_INSTANTIATE(fields_in_run);
} // namespace Morula
