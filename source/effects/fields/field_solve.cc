// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/step_failed.h>
#include <morula/effects/fields/field_equation.h>
#include <morula/effects/fields/fields.h>
#include <morula/mechanics/spline_moments.h>
#include <morula/particles/detached_points.h>
#include <morula/particles/nearest.h>
#include <morula/particles/neighbours.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

namespace Morula
{
  /** When a solution of linear equations is good enough. */
  struct LinearAccuracy
  {
    double tolerance; // of the residual, relative to the right-hand side
    double reduction; // or relative to what it was at the start
  };

  namespace
  {
    /** Differences within a grid cell level out at this rate, in units of D/h²:
     *  about that of a wave of two grid cells, doc/theory.md (11.8). */
    constexpr double levelling = 10.;

    /** What depends on the field itself is solved again until the field's
     *  largest change is so small, relative to its largest value. */
    constexpr double       small_change    = 1e-6;
    constexpr unsigned int most_iterations = 25;

    /** Slopes and the matrix are kept while each change is so much smaller than
     *  the one before: an iteration more is cheaper than a matrix. */
    constexpr double fast = 0.2;

    /** After a change of the field that is so large the next matrix gets a
     *  preconditioner of its own. */
    constexpr double matrices_differ = 0.01;

    /** A first change that is so large shows that the field began far from its
     *  solution. */
    constexpr double far_off = 0.1;

    /** The accuracy of solutions that serve the next iteration: as little is
     *  left as that one will leave, which is more with slopes that are kept.
     *  The last one is far more exact. */
    constexpr LinearAccuracy accuracy_of_iterations{1e-12, 1e-4},
      accuracy_of_kept{1e-12, 1e-2};

    /** The penalty of fixed values is raised no further beyond this. */
    constexpr double most_raised = 1000.;

    /** Amounts are kept to this accuracy. */
    constexpr LinearAccuracy accuracy_of_steady{1e-10, 0.},
      accuracy_of_amounts{1e-13, 0.};

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
                                const MakeLinearSolver &make_solver)
    : tissue(tissue)
    , space(space)
    , reader(reader)
    , make_solver(make_solver)
    , assembly(space, tissue.communicator())
    , values(reader.columns.fields.size())
  {
    assembly.make_pattern(true);
    equation.cell_places =
      grouped_places(tissue.cells(),
                     space,
                     group_points(tissue.cells(), space, [](const auto &) {
                       return true;
                     }));
  }

  template <int dim>
  void
  FieldSolver<dim>::begin_cells(const Field<dim> &field, const double t)
  {
    const unsigned int n_cells = tissue.cells().size();
    equation.cells.resize(n_cells);
    productions.resize(n_cells);
    everywhere(tissue.communicator(), [&]() {
      for (unsigned int p = 0; p < n_cells; ++p)
        {
          const PresentCell<dim> cell = present_cell(p);
          equation.cells[p].volume    = cell.cell().volume();
          equation.cells[p].diffusion = cell.value(field.diffusion, t);
          productions[p]              = cell.value(field.production, t);
        }
    });
  }

  template <int dim>
  void
  FieldSolver<dim>::linearise_cells(const Field<dim>          &field,
                                    const unsigned int         number,
                                    const double               t,
                                    const double               dt,
                                    const std::vector<double> &before)
  {
    const double most =
      Utilities::MPI::max(largest(values[number]), tissue.communicator());
    const double inverse_dt = dt > 0. ? 1. / dt : 0.;
    everywhere(tissue.communicator(), [&]() {
      for (unsigned int p = 0; p < equation.cells.size(); ++p)
        {
          const double     c    = values[number][p];
          PresentCell<dim> cell = present_cell(p);
          const Uptake uptake = field.uptake(cell, t, c, most > 0. ? most : 1.);
          equation.cells[p].rate = uptake.slope + inverse_dt;
          equation.cells[p].load = productions[p] - uptake.used +
                                   uptake.slope * c + inverse_dt * before[p];
        }
    });
    find_steepness(equation);
    mark_lumped(equation);
  }

  template <int dim>
  void
  FieldSolver<dim>::renew_loads(const Field<dim>  &field,
                                const unsigned int number,
                                const double       t)
  {
    everywhere(tissue.communicator(), [&]() {
      for (unsigned int p = 0; p < equation.cells.size(); ++p)
        {
          const double     c     = values[number][p];
          PresentCell<dim> cell  = present_cell(p);
          equation.cells[p].load = productions[p] - field.used(cell, t, c) +
                                   equation.cells[p].rate * c;
        }
    });
  }

  template <int dim>
  void
  FieldSolver<dim>::evaluate_surface(const Field<dim> &field, const double t)
  {
    // The points at which something is done are found first, by the places that
    // they had at t = 0, as conditions are decided there. Where bodies touch
    // and the field passes, there is no surface for it. Points need to know how
    // far they belong to the tissue, and D, which is that of the nearest cell
    // where it differs between cells; both ask other ranks. Then each point
    // gets its coefficients of doc/theory.md (11.2), (11.3), at the time t.
    equation.surface.clear();
    equation.raised = 1.;
    if (!field.has_surface())
      return;
    const BoundaryPoints<dim> &points = tissue.boundary_points();
    if (!touching && points.has_bodies() && !space.is_parted())
      touching = touching_points(tissue);
    PointGroups at_surface;
    everywhere(tissue.communicator(), [&]() {
      at_surface = group_points(points, space, [&](const unsigned int p) {
        return !(touching && (*touching)[p]) &&
               field.acts_on(points[p].seed_position());
      });
    });
    equation.surface_places = grouped_places(points, space, at_surface);

    const std::vector<Point<dim>> places =
      points.positions_of(at_surface.points);
    const auto                sides    = points.sides_of(at_surface.points);
    const std::vector<double> attached = attachment(places, tissue, sides);
    std::vector<double>       of_cells, diffusion; // of the nearest cell
    if (!field.uniform_diffusion())
      {
        everywhere(tissue.communicator(), [&]() {
          for (unsigned int p = 0; p < tissue.cells().size(); ++p)
            of_cells.push_back(present_cell(p).value(field.diffusion, t));
        });
        diffusion = nearest_values(
          places,
          tissue.cells(),
          [&](const unsigned int p) { return of_cells[p]; },
          Ties::mean,
          tissue.grid(),
          sides);
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
                                   area.norm() * field.transfer(X, t),
                                   0.,
                                   field.value.value(X, t),
                                   area.norm() * field.flux(X, t)};
          if (field.is_fixed(X))
            {
              // These are Nitsche's terms, doc/theory.md (11.3). Off the tissue
              // the flux would be extrapolated, so it counts only as far as the
              // point is attached.
              here.flux   = attached[k] * D * area;
              here.weight = 0.;
              here.fixed  = area.norm() * D;
            }
          equation.surface.push_back(here);
        }
    });
  }

  template <int dim>
  typename FieldSolver<dim>::Vector
  FieldSolver<dim>::projection()
  {
    // The mass is that of the equation, so that constants stay constants.
    const std::vector<FieldAtCell>   cells   = equation.cells;
    std::vector<FieldAtSurface<dim>> surface = std::move(equation.surface);
    equation.surface.clear();
    for (FieldAtCell &cell : equation.cells)
      cell.diffusion = 0.;
    linear              = nullptr; // another matrix
    const Vector zero   = assembly.unknowns().zero();
    const Vector result = solve_equation(zero, zero, accuracy_of_steady);
    linear              = nullptr;
    equation.cells      = cells;
    equation.surface    = std::move(surface);
    return result;
  }

  template <int dim>
  void
  FieldSolver<dim>::set_known(std::vector<double> &known, Vector &known_field)
  {
    known_field    = projection();
    const double h = space.box().spacing();
    at_cells(known_field, [&](const unsigned int p, const double smooth) {
      FieldAtCell &cell = equation.cells[p];
      const double kept =
        cell.rate / (cell.rate + levelling * cell.diffusion / (h * h));
      known[p] = smooth + kept * (cell.load / cell.rate - smooth);
      cell.load -= cell.rate * known[p];
    });
  }

  template <int dim>
  typename FieldSolver<dim>::Vector
  FieldSolver<dim>::solve_equation(const Vector         &known,
                                   const Vector         &start,
                                   const LinearAccuracy &accuracy,
                                   const bool            same_matrix)
  {
    // What is sought is the correction to `start`, so that a good start saves
    // iterations. The residual is made relative to the load, so that the
    // accuracy means the same for any start. A matrix that is not positive has
    // too small a penalty: that is raised, and the matrix made anew.
    using Local = LocalEquations<dim, 1>;
    Local matrix(Local::tangent), load(Local::energy_and_residual);
    for (bool keep = same_matrix;; keep = false)
      {
        const auto  &A = keep ? assembly.last_matrix() :
                                assembly.matrix(known, matrix, equation);
        const Vector b =
          assembly.unknowns().sum(assembly.residual(known, load, equation));
        if (!linear)
          {
            problem.typical_entry = A.diagonal(b).linfty_norm();
            linear                = make_solver(problem);
          }
        Vector       x     = start, missing(b), change(b);
        const double small = accuracy.tolerance * b.l2_norm();
        A.vmult(missing, x);
        missing.sadd(-1., 1., b);
        const double size = missing.l2_norm();
        if (!(size > small))
          return x;
        if (linear(
              A, change, missing, std::max(small / size, accuracy.reduction)))
          {
            x += change;
            return x;
          }
        raise_penalty();
      }
  }

  template <int dim>
  void
  FieldSolver<dim>::raise_penalty()
  {
    // Only a fixed value can make the matrix indefinite, so without any there
    // is nothing to raise.
    const int has_fixed = equation.has_fixed_value() ? 1 : 0;
    if (Utilities::MPI::max(has_fixed, tissue.communicator()) == 0 ||
        equation.raised > most_raised)
      throw StepFailed("its matrix is not positive.");
    equation.raised *= 4.;
    linear = nullptr;
  }

  template <int dim>
  FieldSolution<dim>
  FieldSolver<dim>::field(const Field<dim>  &field,
                          const unsigned int number,
                          const double       t,
                          const double       t1)
  {
    std::vector<double> now(tissue.cells().size());
    for (unsigned int p = 0; p < now.size(); ++p)
      now[p] = value(number, p);
    values[number] = std::move(now);
    evaluate_surface(field, t1);
    FieldSolution<dim> result;
    result.number     = number;
    const double step = iterate(field, t1, t1 - t, result);
    // Where the first values were far off, so was what they had lumped: the
    // iterations begin again at the solution.
    if (!(t1 > t) && field.is_nonlinear() && result.converged && step > far_off)
      iterate(field, t1, t1 - t, result);
    result.raised = equation.raised;
    return result;
  }

  template <int dim>
  double
  FieldSolver<dim>::iterate(const Field<dim>   &field,
                            const double        t,
                            const double        dt,
                            FieldSolution<dim> &result)
  {
    // The uptake is linearised at the values of now and the equation solved,
    // until the values no longer change: doc/theory.md (11.4). A transient
    // field gets its known part first, (11.7), (11.8); a field that does not
    // read itself is done after one pass. While changes fall fast, slopes,
    // matrix and preconditioner are kept, and only the loads are renewed.
    const bool           steady    = !(dt > 0.);
    const bool           nonlinear = field.is_nonlinear();
    std::vector<double> &now       = values[result.number];
    std::vector<double>  before    = now; // in turns from the same start
    for (unsigned int p = 0; !steady && p < before.size(); ++p)
      before[p] = tissue.cells()[p].get(reader.columns.fields[result.number]);
    // All of a steady field is sought.
    std::vector<double> known(now.size(), 0.);
    Vector known_field = assembly.unknowns().zero(), sought = known_field;
    double first_step = 0., first_size = 0.;
    bool   kept      = false; // slopes and matrix of the iteration before
    linear           = nullptr;
    result.converged = false;
    // Only an uptake that saturates makes a field end inside of the tissue.
    equation.lumped.assign(steady && nonlinear ? space.grid_cells().size() : 0,
                           false);
    for (unsigned int i = 0; i < most_iterations && !result.converged; ++i)
      {
        if (i == 0 || field.has_nonlinear_source())
          begin_cells(field, t);
        if (kept)
          renew_loads(field, result.number, t);
        else
          linearise_cells(field, result.number, t, dt, before);
        if (i == 0 && steady)
          result.pieces_of_nothing = check_sink(field);
        if (!steady)
          set_known(known, known_field);
        const LinearAccuracy &accuracy = !steady    ? accuracy_of_amounts :
                                         !nonlinear ? accuracy_of_steady :
                                         kept       ? accuracy_of_kept :
                                                      accuracy_of_iterations;
        sought = solve_equation(known_field, sought, accuracy, kept);
        ++result.iterations;
        take(sought, known, !steady || !nonlinear, result);
        const double last_change = result.change;
        result.change            = relative_change(now, result.values);
        if (i == 0)
          {
            first_step = result.change;
            first_size = size(result.values);
          }
        kept = steady && !field.has_nonlinear_source() && i > 0 &&
               result.change <= fast * last_change;
        if (!kept && result.change > matrices_differ)
          linear = nullptr;
        now              = result.values;
        result.converged = !nonlinear || result.change <= small_change;
      }
    if (!result.converged && first_size > 0.)
      result.growth = size(result.values) / first_size;
    if (reader.columns.gradients[result.number].exists())
      {
        sought += known_field;
        result.gradients = gradients(sought);
      }
    return first_step;
  }

  template <int dim>
  double
  FieldSolver<dim>::size(const std::vector<double> &of_cells) const
  {
    return Utilities::MPI::max(largest(of_cells), tissue.communicator());
  }

  template <int dim>
  double
  FieldSolver<dim>::relative_change(const std::vector<double> &before,
                                    const std::vector<double> &after) const
  {
    double change = 0.;
    for (unsigned int p = 0; p < after.size(); ++p)
      change = std::max(change, std::abs(after[p] - before[p]));
    const double most =
      Utilities::MPI::max(largest(after), tissue.communicator());
    change = Utilities::MPI::max(change, tissue.communicator());
    return most > 0. ? change / most : 0.;
  }

  template <int dim>
  template <typename Action>
  void
  FieldSolver<dim>::at_cells(const Vector &field, const Action &action) const
  {
    const SplineField<dim, 1> splines(space, assembly.unknowns(), field);
    const auto               &places = equation.cell_places;
    for (unsigned int c = 0; c < space.grid_cells().size(); ++c)
      {
        if (!places.any(c))
          continue;
        const auto here = splines.on_grid_cell(c);
        for (unsigned int p = places.offsets[c]; p < places.offsets[c + 1]; ++p)
          action(p, value_at(here, places.xi[p]));
      }
  }

  template <int dim>
  void
  FieldSolver<dim>::take(const Vector              &sought,
                         const std::vector<double> &known,
                         const bool                 balanced,
                         FieldSolution<dim>        &result) const
  {
    // Weights are what a cell has at the end of a step and uses up in it.
    std::vector<double> weights(known.size(), 0.);
    result.values.resize(known.size());
    at_cells(sought, [&](const unsigned int p, const double added) {
      result.values[p] = known[p] + added;
      if (balanced)
        weights[p] = equation.cells[p].volume * equation.cells[p].rate;
    });
    result.clipped = keep_positive(result.values,
                                   weights,
                                   equation.cell_places,
                                   space,
                                   tissue.communicator());
  }

  template <int dim>
  std::vector<Tensor<1, dim>>
  FieldSolver<dim>::gradients(const Vector &field) const
  {
    std::vector<Tensor<1, dim>> result(tissue.cells().size());
    const SplineField<dim, 1>   all(space, assembly.unknowns(), field);
    all.at_points(tissue.cells(),
                  [&](const unsigned int        p,
                      const LocalField<dim, 1> &here,
                      const SplineValues<dim>  &splines) {
                    result[p] = here.gradients(splines)[0];
                  });
    return result;
  }

  template class FieldSolver<2>;
  template class FieldSolver<3>;
} // namespace Morula
