// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/simulation/simulation.h>
#include <morula/solver/linear_solver.h>

#include <iostream>
#include <memory>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** A linear solver with a timer of its own: the rows of the linear solver
     *  in timings.csv are those of Newton's method. */
    struct SilentSolver
    {
      SilentSolver(const SolverParameters &parameters,
                   const LinearProblem    &problem)
        : timer(std::cout, TimerOutput::never, TimerOutput::wall_times)
        , solver(parameters, problem, timer)
      {}

      TimerOutput  timer;
      LinearSolver solver;
    };

    MakeLinearSolver
    make_solver_of(const SolverParameters &parameters)
    {
      return [&parameters](const LinearProblem &problem) -> SolveLinear {
        // Functions are copied; a preconditioner is not.
        const auto own = std::make_shared<SilentSolver>(parameters, problem);
        return [own](const Equilibrium::Matrix &A,
                     Equilibrium::Vector       &x,
                     const Equilibrium::Vector &b,
                     const double               tolerance) {
          unsigned int iterations = 0;
          own->solver.solve(A, x, b, tolerance, iterations);
        };
      };
    }
  } // namespace


  template <int dim>
  FieldsOfStep<dim>
  Simulation<dim>::find_fields(const SplineSpace<dim> &space,
                               const FieldKind         kind,
                               const double            t1)
  {
    if (!fields.any(kind))
      return {};
    const TimerOutput::Scope section(timer, "fields");
    if (!field_solver)
      field_solver.emplace(tissue,
                           space,
                           development.reader(time_steps.time()),
                           make_solver_of(scene.solver));
    FieldsOfStep<dim> found;
    try
      {
        found = fields.find(kind, *field_solver, time_steps.time(), t1);
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
    tell_of_fields(found);
    return found;
  }


  template <int dim>
  void
  Simulation<dim>::tell_of_fields(const FieldsOfStep<dim> &found)
  {
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
  }


  template <int dim>
  void
  Simulation<dim>::set_steady_fields(const SplineSpace<dim> &space)
  {
    fields.set(tissue,
               find_fields(space, FieldKind::steady, time_steps.time()));
    // What it has made serves the others in the same configuration.
    if (!fields.any(FieldKind::transient))
      field_solver.reset();
  }


  template <int dim>
  FieldsOfStep<dim>
  Simulation<dim>::transient_fields(const SplineSpace<dim> &space)
  {
    FieldsOfStep<dim> found =
      find_fields(space, FieldKind::transient, time_steps.next());
    field_solver.reset();
    return found;
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
