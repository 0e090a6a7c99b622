// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/key.h>
#include <morula/effects/fields/step_fields.h>

#include <sstream>

namespace Morula
{
  namespace
  {
    /** A field that has grown by more in iterations that did not converge has
     *  no steady state. */
    constexpr double most_growth = 1e4;
  } // namespace


  template <int dim>
  StepFields<dim>::StepFields(const Fields<dim>   &fields,
                              const RunTools<dim> &tools)
    : fields(fields)
    , parameters(fields.parameters())
    , tools(tools)
  {}


  template <int dim>
  void
  StepFields<dim>::begin_step()
  {
    clipped.clear();
  }


  template <int dim>
  FieldsOfStep<dim>
  StepFields<dim>::find(const FieldKind         kind,
                        const Tissue<dim>      &tissue,
                        const SplineSpace<dim> &space,
                        const double            t,
                        const double            t1)
  {
    // The first call in a configuration makes the solver, with the sums over
    // cells and the surface that all fields share. Each solution is then looked
    // at for what the user should know: negative values that were cut off
    // (doc/theory.md, section 11.3), and fields that are inexact. Collective;
    // the solution is equal on all ranks as far as these warnings ask.
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


  template <int dim>
  void
  StepFields<dim>::warn_if_unsettled(const FieldSolution<dim> &field,
                                     const double              t)
  {
    if (field.converged)
      return;
    const std::string &name = parameters.fields[field.number].name;
    // Iterations that fail to settle stay within bounds; here each makes more
    // of the field than the one before.
    if (field.growth > most_growth)
      throw InputError("Fields/" + name + "/Production",
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
    text << "Warning: at t = " << t << " day the field '"
         << parameters.fields[field.number].name << "' still changed by "
         << field.change << " of its largest value after " << field.iterations
         << " iterations, as what cells do to it depends on itself. The next "
            "step goes on from there; expressions without jumps converge "
            "better. Later ones are not told of.";
    tools.announce(text.str());
  }


  template <int dim>
  void
  StepFields<dim>::warn_of_nothing(const FieldSolution<dim> &field,
                                   const double              t)
  {
    if (field.pieces_of_nothing == 0 || warned_of_nothing)
      return;
    warned_of_nothing = true;
    std::ostringstream text;
    text << "Warning: at t = " << t << " day "
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


  template <int dim>
  void
  StepFields<dim>::warn_if_raised(const FieldSolution<dim> &field,
                                  const double              t)
  {
    if (!(field.raised > 1.) || warned_of_surface)
      return;
    warned_of_surface = true;
    std::ostringstream text;
    text << "Warning: at t = " << t << " day the fixed value of the field '"
         << parameters.fields[field.number].name << "' was enforced "
         << field.raised
         << " times as strongly as usual: the surface is rough, or the tissue "
            "thin, within a grid spacing, and the field is inexact there. Take "
            "a smaller Grid/Spacing with smaller cells, or keep the surface "
            "smooth by Boundary conditions/Surface tension. Later times are "
            "not told of.";
    tools.announce(text.str());
  }


  template <int dim>
  void
  StepFields<dim>::settle(Tissue<dim>            &tissue,
                          const SplineSpace<dim> &space,
                          const double            t)
  {
    fields.set(tissue, find(FieldKind::steady, tissue, space, t, t));
    // The transient fields of this step use the same configuration, and then
    // the same solver. Without any nothing else will ask for it.
    if (!fields.any(FieldKind::transient))
      forget_configuration();
  }


  template <int dim>
  void
  StepFields<dim>::advance(Tissue<dim>            &tissue,
                           const SplineSpace<dim> &space,
                           const double            t,
                           const double            t_next)
  {
    // The tissue moves after this call. What the solver has summed belongs to
    // the places before.
    const FieldsOfStep<dim> found =
      find(FieldKind::transient, tissue, space, t, t_next);
    forget_configuration();
    fields.set(tissue, found);
  }


  template <int dim>
  void
  StepFields<dim>::forget_configuration()
  {
    solver.reset();
  }


  template <int dim>
  void
  StepFields<dim>::describe(const Tissue<dim> &tissue,
                            NamedNumbers      &columns) const
  {
    // Before the first call of find() nothing was clipped.
    const std::vector<FieldTotals> totals = fields.totals(tissue);
    for (std::size_t k = 0; k < totals.size(); ++k)
      {
        const FieldTotals &field      = totals[k];
        columns[field.name + "_min"]  = field.min;
        columns[field.name + "_mean"] = field.mean;
        columns[field.name + "_max"]  = field.max;
        columns[field.name + "_clipped"] =
          k < clipped.size() ? double(clipped[k]) : 0.;
      }
  }


  template class StepFields<2>;
  template class StepFields<3>;
} // namespace Morula
