// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/input_error.h>
#include <morula/base/step_failed.h>
#include <morula/effects/catalogue.h>
#include <morula/effects/fields/fields.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Morula
{
  namespace
  {
    template <int dim>
    class Fields;

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
            warn(field, t);
          }
        return found;
      }

      /** Tells of what is wrong with a field, each kind of it once in a run.
       *  @throws InputError about a field that has no steady state */
      void
      warn(const FieldSolution<dim> &field, const double t)
      {
        const auto        &keys = parameters.fields[field.number];
        const std::string &name = keys.name;
        const auto warn_once    = [&](bool &said, const std::string &what) {
          if (!std::exchange(said, true))
            tools.announce("Warning: at t = " + as_text(t) + " day " + what);
        };
        // Iterations that fail to settle stay within bounds; here each makes
        // more of the field than the one before.
        if (!field.converged && field.growth > most_growth)
          throw InputError(
            "Fields/" + name + "/Production",
            keys.production.text(),
            "less than what cells use up, also where it depends on "
            "the field itself or on fields that depend on it",
            "The field grows with every iteration, by " +
              as_text(field.growth) +
              " so far, and has no steady state: lower Production, "
              "raise Consumption, let Production saturate, or set "
              "Time = transient with a shorter step.");
        if (!field.converged)
          warn_once(warned,
                    "the field '" + name + "' still changed by " +
                      as_text(field.change) + " of its largest value after " +
                      std::to_string(field.iterations) +
                      " iterations, as what cells do to it depends on itself. "
                      "The next step goes on from there; expressions without "
                      "jumps converge better. Further cases are not reported.");
        if (field.raised > 1.)
          warn_once(warned_of_surface,
                    "the fixed value of the field '" + name +
                      "' was enforced " + as_text(field.raised) +
                      " times as strongly as usual: the surface is rough, or "
                      "the tissue thin, within a grid spacing, and the field "
                      "is inexact there. Take a smaller Grid/Spacing with "
                      "smaller cells, or keep the surface smooth by Boundary "
                      "conditions/Surface tension. Further cases are not "
                      "reported.");
        if (const unsigned int n = field.pieces_of_nothing; n > 0)
          warn_once(warned_of_nothing,
                    (n == 1 ? "a separate part" :
                              std::to_string(n) + " separate parts") +
                      " of the tissue has neither source nor sink of the "
                      "steady field '" +
                      name +
                      "': its level there is not determined, and is set to 0. "
                      "Give it a Consumption, a fixed value or a Transfer "
                      "there. Further cases are not reported.");
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

    /** Refuses a condition that holds at @p n boundary points of this rank, and
     *  at none of others. Collective. */
    void
    check_holds(const ExpressionKey         &where,
                const types::particle_index &n,
                const MPI_Comm               comm)
    {
      // A condition that holds nowhere is most likely a mistake.
      if (!where.empty() && Utilities::MPI::sum(n, comm) == 0)
        where.refuse("a condition that holds at some boundary point",
                     "It is positive at none: correct it, or leave it empty. "
                     "Boundary points sit at centers of surface patches, not "
                     "on edges or corners.");
    }

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

      Fields(const FieldsParameters   &parameters,
             const EffectSetting<dim> &setting)
        : parameters_(parameters)
      {
        // Numbers follow the order of the names; the order in which fields are
        // found is another one.
        for (const FieldKeys &keys : parameters.fields)
          fields.emplace_back(keys, fields.size(), setting);
        groups = groups_of(fields);
        setting.state.declare_fields(setting.columns);
        columns   = setting.state.fields;
        gradients = setting.state.gradients;
      }

      /** Their names and expressions. */
      const FieldsParameters &
      parameters() const
      {
        return parameters_;
      }

      std::unique_ptr<EquationInRun<dim>>
      in_run(const RunTools<dim> &tools) const override
      {
        return std::make_unique<StepFields<dim>>(*this, tools);
      }

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
      begin(const PresentCell<dim> &,
            const CellView<dim, double> &cell) const override
      {
        const Point<dim> X = cell.founder_position();
        for (unsigned int k = 0; k < fields.size(); ++k)
          {
            cell.set(columns[k], fields[k].initial.value(X, 0.));
            if (!gradients[k].exists())
              continue;
            // Founders that divide along a gradient ask for it before any step.
            const double delta =
              std::pow(cell.initial_volume(), 1. / dim) / 100.;
            Tensor<1, dim> gradient;
            for (unsigned int d = 0; d < dim; ++d)
              {
                Point<dim> before(X), behind(X);
                before[d] -= delta;
                behind[d] += delta;
                gradient[d] = (fields[k].initial.value(behind, 0.) -
                               fields[k].initial.value(before, 0.)) /
                              (2. * delta);
              }
            cell.set(gradients[k], gradient);
          }
      }

      /** Refuses values for the surface that it cannot have at t = 0, and
       *  conditions that hold nowhere. */
      void
      check_surface(const std::vector<Point<dim>> &X,
                    const MPI_Comm                 comm) const override
      {
        for (unsigned int k = 0; k < fields.size(); ++k)
          {
            // Values are evaluated for their rules; that a point is fixed or
            // takes a flux is counted over all ranks.
            types::particle_index n_fixed = 0, n_of_flux = 0;
            everywhere(comm, [&]() {
              for (const Point<dim> &place : X)
                if (fields[k].acts_on(place))
                  {
                    n_fixed += fields[k].is_fixed(place);
                    n_of_flux += fields[k].takes_flux(place);
                    fields[k].value.value(place, 0.);
                    fields[k].transfer(place, 0.);
                    fields[k].flux(place, 0.);
                  }
            });
            check_holds(parameters_.fields[k].fixed_where, n_fixed, comm);
            check_holds(parameters_.fields[k].flux_where, n_of_flux, comm);
          }
      }

      void
      review(const Preview<dim> &scene, Review &review) const override
      {
        review_fields(parameters_, scene, review);
      }

      /** The columns of the fields that growth dilutes, doc/theory.md, section
       *  11.4. */
      std::vector<Column<double>>
      densities() const override
      {
        std::vector<Column<double>> list;
        for (unsigned int k = 0; k < fields.size(); ++k)
          if (fields[k].is_diluted())
            list.push_back(columns[k]);
        return list;
      }

      /**
       * Finds the fields of one kind at the end @p t1 of a step that begins at
       * @p t0 with the tissue as the solver has it, in days; steady ones at t1
       * = t0. Those on which others depend come first, so that their order in
       * the scene does not matter; those that depend on each other are found in
       * turns until they agree. Collective.
       * @throws InputError  for expressions without a value
       * @throws StepFailed where there is no solution
       */
      FieldsOfStep<dim>
      find(const FieldKind   kind,
           FieldSolver<dim> &solver,
           const double      t0,
           const double      t1) const
      {
        // Groups come in an order in which each finds what it depends on. All
        // fields of a group are of one kind.
        FieldsOfStep<dim> found;
        for (const auto &group : groups)
          if (fields[group.front()].kind == kind)
            for (FieldSolution<dim> &field :
                 find_group(fields, group, solver, t0, t1))
              found.push_back(std::move(field));
        return found;
      }

      /** Gives cells the values that were found. */
      void
      set(Tissue<dim> &tissue, const FieldsOfStep<dim> &of_step) const
      {
        for (const FieldSolution<dim> &field : of_step)
          for (unsigned int p = 0; p < tissue.cells().size(); ++p)
            {
              const CellView<dim, double> cell = tissue.cell(p);
              cell.set(columns[field.number], field.values[p]);
              if (gradients[field.number].exists())
                cell.set(gradients[field.number], field.gradients[p]);
            }
      }

      /** Least, mean and largest values in statistics.csv, and how many were
       *  clipped. */
      void
      declare(Tables<dim> &tables) const override
      {
        for (const Field<dim> &field : fields)
          for (const std::string what : {"min", "mean", "max", "clipped"})
            tables.add_number(field.name + "_" + what);
      }

      /** Whether some are of this kind. */
      bool
      any(const FieldKind kind) const
      {
        return std::any_of(fields.begin(),
                           fields.end(),
                           [kind](const Field<dim> &field) {
                             return field.kind == kind;
                           });
      }

      /** Gives their least, mean and largest values, 0 where there are no
       * cells. Collective. */
      void
      describe(const Tissue<dim> &tissue, NamedNumbers &numbers) const
      {
        const Cells<dim> &cells = tissue.cells();
        for (unsigned int k = 0; k < fields.size(); ++k)
          {
            // One pass over the cells of this rank for each field; the mean is
            // over the volume, as that of an amount.
            double least  = std::numeric_limits<double>::infinity(),
                   most   = -least;
            double amount = 0., volume = 0.;
            for (unsigned int p = 0; p < cells.size(); ++p)
              {
                const double c = cells[p].get(columns[k]);
                least          = std::min(least, c);
                most           = std::max(most, c);
                amount += c * cells.volume(p);
                volume += cells.volume(p);
              }
            const MPI_Comm comm = tissue.communicator();
            least               = Utilities::MPI::min(least, comm);
            most                = Utilities::MPI::max(most, comm);
            amount              = Utilities::MPI::sum(amount, comm);
            volume              = Utilities::MPI::sum(volume, comm);
            // Without cells all quantities are 0.
            const std::string &name = fields[k].name;
            numbers[name + "_min"]  = volume > 0. ? least : 0.;
            numbers[name + "_mean"] = volume > 0. ? amount / volume : 0.;
            numbers[name + "_max"]  = volume > 0. ? most : 0.;
          }
      }

    private:
      FieldsParameters parameters_;
      /** Numbers of fields that depend on each other, in the order in which
       * they are found. */
      std::vector<std::vector<unsigned int>> groups;
      std::vector<Field<dim>>                fields;
      std::vector<Column<double>>            columns;
      std::vector<Column<Tensor<1, dim>>>    gradients;
    };
  } // namespace


  void
  add_fields(Catalogue &catalogue)
  {
    catalogue.add_own<Fields>("fields",
                              {"Fields/Names=signal",
                               "Fields/signal/Time=transient",
                               "Fields/signal/Diffusion=1",
                               "Fields/signal/Consumption=signal",
                               "Fields/signal/Initial=1 + 0.1*X*Y",
                               "Fields/signal/Fixed where=X + Y > 2"});
  }
} // namespace Morula
