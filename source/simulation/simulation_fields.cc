// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/simulation/simulation.h>
#include <morula/solver/linear_solver.h>

#include <iostream>
#include <sstream>

namespace Morula
{
  template <int dim>
  FieldsOfStep<dim>
  Simulation<dim>::solve_fields(
    const std::function<FieldsOfStep<dim>(const SolveLinear &)> &find)
  {
    const TimerOutput::Scope section(timer, "fields");
    // The rows of the linear solver in timings.csv are those of Newton's
    // method.
    TimerOutput       own_timer(std::cout,
                          TimerOutput::never,
                          TimerOutput::wall_times);
    FieldsOfStep<dim> found;
    try
      {
        found = find([&](const LinearProblem       &problem,
                         const Equilibrium::Matrix &A,
                         Equilibrium::Vector       &x,
                         const Equilibrium::Vector &b,
                         const double               tolerance) {
          unsigned int iterations = 0;
          LinearSolver(scene.solver, problem, own_timer)
            .solve(A, x, b, tolerance, iterations);
        });
      }
    catch (const InputError &error)
      {
        if (n_steps == 0)
          throw;
        give_up(scene.located(error.what()));
      }
    catch (const StepFailed &failure)
      {
        const std::string reason =
          "the equation of a field could not be solved: " +
          std::string(failure.what()) + '.';
        if (n_steps == 0)
          throw std::runtime_error(reason);
        give_up(reason);
      }
    clipped.resize(scene.fields.fields.size(), 0);
    for (const FieldSolution<dim> &field : found)
      {
        clipped[field.number] += field.clipped;
        if (field.converged || warned_of_fields)
          continue;
        warned_of_fields = true;
        std::ostringstream text;
        text << "Warning: at t = " << time_steps.time() << " day the field '"
             << scene.fields.fields[field.number].name << "' still changed by "
             << field.change << " of its largest value after "
             << field.iterations
             << " iterations, as what cells do to it depends on itself. The "
                "next step goes on from there; expressions without jumps "
                "converge better. Later ones are not told of.";
        files->message(text.str());
      }
    return found;
  }


  template <int dim>
  void
  Simulation<dim>::solve_steady_fields(const SplineSpace<dim> &space)
  {
    if (!fields.any_steady())
      return;
    const CellReader<dim> reader = development.reader(time_steps.time());
    fields.set(tissue, solve_fields([&](const SolveLinear &solve) {
                 return fields.steady(
                   tissue, space, reader, time_steps.time(), solve);
               }));
  }


  template <int dim>
  FieldsOfStep<dim>
  Simulation<dim>::transient_fields(const SplineSpace<dim> &space)
  {
    if (!fields.any_transient())
      return {};
    const CellReader<dim> reader = development.reader(time_steps.time());
    return solve_fields([&](const SolveLinear &solve) {
      return fields.transient(
        tissue, space, reader, time_steps.time(), time_steps.next(), solve);
    });
  }


  template <int dim>
  std::vector<FieldStatistics>
  Simulation<dim>::field_statistics() const
  {
    std::vector<FieldStatistics> list;
    for (const FieldTotals &field : fields.totals(tissue))
      list.push_back({field.name,
                      field.min,
                      field.mean,
                      field.max,
                      list.size() < clipped.size() ? clipped[list.size()] : 0});
    return list;
  }


  template class Simulation<2>;
  template class Simulation<3>;
} // namespace Morula
