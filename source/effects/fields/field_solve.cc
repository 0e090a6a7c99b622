// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/input_error.h>
#include <morula/effects/fields/field_solve.h>
#include <morula/particles/detached_points.h>
#include <morula/particles/nearest.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

namespace Morula
{
  namespace
  {
    /** Penalty of fixed values in units of D/h: the least one of the mechanical
     *  conditions, doc/theory.md (4.6). */
    constexpr double penalty = 20.;

    /** What depends on the field itself is solved again until the field's
     *  largest change is so small, relative to its largest value. */
    constexpr double       small_change    = 1e-6;
    constexpr unsigned int most_iterations = 25;

    /** Of the residual of the linear equations. Amounts are kept as well as
     *  this says. */
    constexpr double tolerance_of_steady = 1e-10, tolerance_of_amounts = 1e-13;

    double
    largest(const std::vector<double> &values)
    {
      double result = 0.;
      for (const double value : values)
        result = std::max(result, std::abs(value));
      return result;
    }
  } // namespace


  template <int dim>
  FieldSolver<dim>::FieldSolver(const Tissue<dim>      &tissue,
                                const SplineSpace<dim> &space,
                                const CellReader<dim>  &reader,
                                const SolveLinear      &solve)
    : tissue(tissue)
    , space(space)
    , reader(reader)
    , solve(solve)
    , assembly(space, tissue.communicator())
    , strongly_coupled(assembly.unknowns().of_extended_splines())
    , values(reader.columns.fields.size())
  {
    assembly.make_pattern();
    groups =
      group_points(tissue.cells(), space, [](const auto &) { return true; });
    equation.cell_places = grouped_places(tissue.cells(), space, groups);
  }


  template <int dim>
  double
  FieldSolver<dim>::value(const unsigned int field, const unsigned int p) const
  {
    return values[field].empty() ?
             tissue.cells()[p].get(reader.columns.fields[field]) :
             values[field][p];
  }


  template <int dim>
  template <typename Action>
  void
  FieldSolver<dim>::with_cell(const unsigned int p, const Action &action) const
  {
    const Cells<dim> &cells = tissue.cells();
    const auto        view  = cells[p];
    if (!has_found)
      {
        action(PresentCell<dim>(view, cells.id(p), cells.position(p), reader));
        return;
      }
    std::vector<double>         row(view.row().begin(), view.row().end());
    const CellView<dim, double> now(make_array_view(row), view.columns());
    for (unsigned int k = 0; k < values.size(); ++k)
      if (!values[k].empty())
        now.set(reader.columns.fields[k], values[k][p]);
    action(PresentCell<dim>(now, cells.id(p), cells.position(p), reader));
  }


  template <int dim>
  void
  FieldSolver<dim>::evaluate_cells(const Field<dim>          &field,
                                   const unsigned int         number,
                                   const double               t,
                                   const std::vector<double> &known)
  {
    const double most =
      Utilities::MPI::max(largest(values[number]), tissue.communicator());
    equation.cells.clear();
    everywhere(tissue.communicator(), [&]() {
      for (unsigned int p = 0; p < tissue.cells().size(); ++p)
        with_cell(p, [&](const PresentCell<dim> &cell) {
          equation.cells.push_back(field.at_cell(
            cell, t, values[number][p], known[p], most > 0. ? most : 1.));
        });
    });
  }


  template <int dim>
  void
  FieldSolver<dim>::evaluate_surface(const Field<dim> &field,
                                     const double      t,
                                     const double      t1)
  {
    equation.surface.clear();
    if (!field.has_surface())
      return;
    const BoundaryPoints<dim> &points = tissue.boundary_points();
    PointGroups                at_surface;
    everywhere(tissue.communicator(), [&]() {
      at_surface = group_points(points, space, [&](const unsigned int p) {
        return field.acts_on(points[p].seed_position());
      });
    });
    equation.surface_places = grouped_places(points, space, at_surface);

    std::vector<Point<dim>> places;
    for (const unsigned int p : at_surface.points)
      places.push_back(points.position(p));
    const std::vector<double> attached = attachment(places, tissue);
    // Expressions of cells: those of the nearest one count.
    std::vector<double> of_cells, diffusion;
    if (!field.uniform_diffusion())
      {
        everywhere(tissue.communicator(), [&]() {
          for (unsigned int p = 0; p < tissue.cells().size(); ++p)
            with_cell(p, [&](const PresentCell<dim> &cell) {
              of_cells.push_back(field.diffusion(cell, t));
            });
        });
        diffusion = nearest_values(
          places,
          tissue.cells(),
          [&](const unsigned int p) { return of_cells[p]; },
          Ties::mean,
          tissue.grid());
      }
    everywhere(tissue.communicator(), [&]() {
      for (std::size_t k = 0; k < at_surface.points.size(); ++k)
        {
          const BoundaryView<dim> point = points[at_surface.points[k]];
          const Point<dim>        X     = point.seed_position();
          const Tensor<1, dim>    area  = point.area_vector();
          const double            D =
            diffusion.empty() ? *field.uniform_diffusion() : diffusion[k];
          FieldAtSurface<dim> here{Tensor<1, dim>(),
                                   area.norm() * field.transfer(X, t1),
                                   field.value(X, t1)};
          if (field.is_fixed(X))
            {
              // doc/theory.md (11.3). Off the tissue the flux would be
              // extrapolated.
              here.flux   = attached[k] * D * area;
              here.weight = area.norm() * penalty * D / space.box().spacing();
            }
          equation.surface.push_back(here);
        }
    });
  }


  template <int dim>
  void
  FieldSolver<dim>::check_sink(const Field<dim> &field) const
  {
    double sink = 0.;
    for (const FieldAtCell &cell : equation.cells)
      sink += cell.volume * cell.rate;
    for (const FieldAtSurface<dim> &point : equation.surface)
      sink += point.weight;
    if (!(Utilities::MPI::sum(sink, tissue.communicator()) > 0.))
      throw InputError(
        "Fields/" + field.name() + "/Consumption",
        "",
        "a rate > 0 1/day at some cell, or a value or a transfer > 0 at some "
        "boundary point",
        "Without a sink a steady field has no level: any constant could be "
        "added to it.");
  }


  template <int dim>
  typename FieldSolver<dim>::Vector
  FieldSolver<dim>::projection(const std::vector<double> &cell_values)
  {
    // The same mass as in the equation, so that constants stay constants.
    std::vector<FieldAtCell>         cells   = equation.cells;
    std::vector<FieldAtSurface<dim>> surface = std::move(equation.surface);
    equation.surface.clear();
    for (unsigned int p = 0; p < cells.size(); ++p)
      equation.cells[p] = {cells[p].volume, 0., 1., cell_values[p]};
    const Vector result =
      solve_equation(assembly.unknowns().zero(), tolerance_of_steady);
    equation.cells   = std::move(cells);
    equation.surface = std::move(surface);
    return result;
  }


  template <int dim>
  typename FieldSolver<dim>::Vector
  FieldSolver<dim>::solve_equation(const Vector &known, const double tolerance)
  {
    using Local = LocalEquations<dim, 1>;
    Local        matrix(Local::tangent), load(Local::energy_and_residual);
    const auto  &A = assembly.matrix(known, matrix, equation);
    const Vector b =
      assembly.unknowns().sum(assembly.residual(known, load, equation));
    Vector x = assembly.unknowns().zero();
    if (!(b.l2_norm() > 0.))
      return x;
    LinearProblem problem;
    problem.strongly_coupled = strongly_coupled;
    problem.typical_entry    = A.linfty_norm();
    solve(problem, A, x, b, tolerance);
    return x;
  }


  template <int dim>
  FieldSolution<dim>
  FieldSolver<dim>::field(const Field<dim>  &field,
                          const unsigned int number,
                          const double       t,
                          const double       t1,
                          const double       dt)
  {
    const MPI_Comm      comm    = tissue.communicator();
    const unsigned int  n_cells = tissue.cells().size();
    std::vector<double> now;
    for (unsigned int p = 0; p < n_cells; ++p)
      now.push_back(value(number, p));
    // Of a steady field all is sought, of others what is added.
    const std::vector<double> known =
      dt > 0. ? now : std::vector<double>(n_cells, 0.);
    values[number] = now;
    equation.lumped.assign(space.grid_cells().size(), false);
    evaluate_surface(field, t, t1);

    FieldSolution<dim> result;
    result.number      = number;
    result.converged   = false;
    Vector known_field = assembly.unknowns().zero();
    while (!result.converged && result.iterations < most_iterations)
      {
        evaluate_cells(field, number, t, known);
        mark_lumped(equation, dt);
        if (result.iterations == 0 && dt > 0.)
          known_field = projection(known);
        if (result.iterations == 0 && !(dt > 0.))
          check_sink(field);
        if (dt > 0.)
          for (FieldAtCell &cell : equation.cells)
            cell.rate += 1. / dt;
        const Vector sought =
          solve_equation(known_field,
                         dt > 0. ? tolerance_of_amounts : tolerance_of_steady);
        ++result.iterations;
        take(known_field, sought, known, result);
        has_found     = true;
        double change = 0.;
        for (unsigned int p = 0; p < n_cells; ++p)
          change =
            std::max(change, std::abs(result.values[p] - values[number][p]));
        const double most = Utilities::MPI::max(largest(result.values), comm);
        change            = Utilities::MPI::max(change, comm);
        result.change     = most > 0. ? change / most : 0.;
        values[number]    = result.values;
        result.converged =
          !field.is_nonlinear() || result.change <= small_change;
      }
    return result;
  }


  template <int dim>
  void
  FieldSolver<dim>::take(const Vector              &known_field,
                         const Vector              &sought,
                         const std::vector<double> &known,
                         FieldSolution<dim>        &result) const
  {
    Vector total(known_field);
    total += sought;
    const SplineField<dim, 1> added(space, sought, tissue.communicator());
    const SplineField<dim, 1> all(space, total, tissue.communicator());
    result.values.assign(known.size(), 0.);
    result.gradients.assign(known.size(), Tensor<1, dim>());
    std::uint64_t clipped = 0;
    const auto   &places  = equation.cell_places;
    for (unsigned int c = 0; c < space.grid_cells().size(); ++c)
      {
        if (!places.any(c))
          continue;
        const auto here = added.on_grid_cell(c), field = all.on_grid_cell(c);
        for (unsigned int p = places.offsets[c]; p < places.offsets[c + 1]; ++p)
          {
            const SplineValues<dim> splines(places.xi[p], places.h);
            const double            value = known[p] + here.value(splines)[0];
            clipped += value < 0.;
            result.values[p]    = std::max(0., value);
            result.gradients[p] = field.gradients(splines)[0];
          }
      }
    result.clipped = Utilities::MPI::sum(clipped, tissue.communicator());
  }


  template class FieldSolver<2>;
  template class FieldSolver<3>;
} // namespace Morula
