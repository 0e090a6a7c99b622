// ranks: 1 2
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/assembly.h>
#include <morula/seeding/seeding.h>
#include <morula/solver/linear_solver.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>
#include <vector>

#include "common/body_on_grid.h"
#include "common/linear_problem.h"

using namespace Morula;

/*
 * -∇·(D ∇c) + k c = s on a disc and a ball that the grid cuts anywhere, with a
 * known solution: fields of one component, and of two, on the displacement's
 * splines, assembly and linear solver. The cells are the quadrature points.
 */
namespace
{
  constexpr double radius = 100.;     // µm
  constexpr double D = 300., k = 0.1; // µm²/day, 1/day
  constexpr double coarsest = 40.;    // grid spacing, µm

  enum class Held
  {
    value, // at all boundary points, by Nitsche's method
    flux   // D ∂c/∂n given
  };

  /** 2 + Π cos(a_d x_d + b_d), and what follows from it. */
  template <int dim>
  struct Solution
  {
    static constexpr double a[3] = {1. / 40., 1. / 55., 1. / 70.}; // 1/µm
    static constexpr double b[3] = {0.4, -0.7, 0.2};

    static double
    value(const Point<dim> &x)
    {
      double product = 1.;
      for (unsigned int d = 0; d < dim; ++d)
        product *= std::cos(a[d] * x[d] + b[d]);
      return 2. + product;
    }

    static Tensor<1, dim>
    gradient(const Point<dim> &x)
    {
      Tensor<1, dim> result;
      for (unsigned int d = 0; d < dim; ++d)
        {
          result[d] = -a[d] * std::sin(a[d] * x[d] + b[d]);
          for (unsigned int e = 0; e < dim; ++e)
            if (e != d)
              result[d] *= std::cos(a[e] * x[e] + b[e]);
        }
      return result;
    }

    /** s = -D Δc + k c. */
    static double
    source(const Point<dim> &x)
    {
      double square = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        square += a[d] * a[d];
      return D * square * (value(x) - 2.) + k * value(x);
    }
  };

  /** Not aligned with the grid. */
  template <int dim>
  TissueParameters
  ball(const double cell_spacing, const bool trimmed)
  {
    TissueParameters parameters;
    parameters.shape          = "sphere";
    parameters.radius         = radius;
    parameters.center         = {7.3, 11.9, -4.1};
    parameters.cell_spacing   = cell_spacing;
    parameters.lattice_offset = {0.31 * cell_spacing,
                                 0.17 * cell_spacing,
                                 0.43 * cell_spacing};
    parameters.surface_cells  = trimmed ? "trimmed" : "whole";
    // Patches as large as cells.
    parameters.boundary_points =
      dim == 2 ? std::ceil(2. * numbers::PI * radius / cell_spacing) :
                 std::ceil(4. * numbers::PI * radius * radius /
                           (cell_spacing * cell_spacing));
    return parameters;
  }

  /** Cells and surface of a ball, the same on all ranks, and its splines. */
  template <int dim>
  struct Ball
  {
    Ball(const double   h,
         const double   cell_spacing,
         const bool     trimmed,
         const MPI_Comm comm)
      : cells(
          seed_founders<dim>(ball<dim>(cell_spacing, trimmed), MPI_COMM_SELF))
      , surface(
          seed_surface<dim>(ball<dim>(cell_spacing, trimmed), MPI_COMM_SELF))
      , body(cells.positions,
             cells.volumes,
             grid_parameters(h),
             surface.positions,
             comm)
      , groups{body.group(cells.positions), body.group(surface.positions)}
      , points{body.grouped(cells.positions, groups[0]),
               body.grouped(surface.positions, groups[1])}
    {}

    static GridParameters
    grid_parameters(const double h)
    {
      GridParameters parameters;
      parameters.spacing = h;
      return parameters;
    }

    const Founders<dim>                   cells;
    const SurfacePatches<dim>             surface;
    const BodyOnGrid<dim>                 body;
    const std::vector<PointGroups>        groups; // cells, boundary points
    const std::vector<GroupedPoints<dim>> points; // the same
  };

  /**
   * Residual and tangent of the energy
   *   Σ_p V (D/2 |∇c|² + k/2 c² - s c)
   *   + Σ_b a (β/2 g² - D ∂c/∂n g) or - Σ_b a q c
   * with the gap g = c - c̄ or the flux q. Component i has i + 1 times the
   * solution.
   */
  template <int dim, int n_components>
  class Diffusion
  {
  public:
    using Local = LocalEquations<dim, n_components>;
    using Field = LocalField<dim, n_components>;

    Diffusion(const Ball<dim> &ball, const Held held)
      : ball(ball)
      , held(held)
    {}

    bool
    operator()(const unsigned int c, const Field &field, Local &local) const
    {
      for_points(c, 0, [&](const unsigned int p, const auto &splines) {
        const double V = ball.cells.volumes[p];
        add_product(splines, V, field, local);
        add_load(splines.value,
                 -V * Solution<dim>::source(ball.cells.positions[p]),
                 local);
      });
      for_points(c, 1, [&](const unsigned int p, const auto &splines) {
        add_boundary_point(p, splines, field, local);
      });
      return true;
    }

  private:
    static constexpr unsigned int n = BSpline<dim>::n;

    template <typename Visit>
    void
    for_points(const unsigned int c,
               const unsigned int kind,
               const Visit       &visit) const
    {
      const auto &points = ball.points[kind];
      for (unsigned int p = points.offsets[c]; p < points.offsets[c + 1]; ++p)
        visit(ball.groups[kind].points[p],
              SplineValues<dim>(points.xi[p], points.h));
    }

    /** Adds K_ab(i, i) of one point and K c. */
    template <typename Entry>
    static void
    add(const Entry &entry, const Field &field, Local &local)
    {
      for (unsigned int i = 0; i < n_components; ++i)
        for (unsigned int a = 0; a < n; ++a)
          for (unsigned int b = 0; b < n; ++b)
            if (local.wanted == Local::tangent)
              local.matrix[(i * n + a) * Local::n_dofs + i * n + b] +=
                entry(a, b);
            else
              local.add_force(i, a, entry(a, b) * field.coefficient[i][b]);
    }

    static void
    add_load(const double (&N)[n], const double factor, Local &local)
    {
      for (unsigned int i = 0; i < n_components; ++i)
        for (unsigned int a = 0; a < n; ++a)
          local.add_force(i, a, factor * (i + 1) * N[a]);
    }

    static void
    add_product(const SplineValues<dim> &splines,
                const double             V,
                const Field             &field,
                Local                   &local)
    {
      const auto entry = [&](const unsigned int a, const unsigned int b) {
        double product = k * splines.value[a] * splines.value[b];
        for (unsigned int d = 0; d < dim; ++d)
          product += D * splines.gradient[d][a] * splines.gradient[d][b];
        return V * product;
      };
      add(entry, field, local);
    }

    void
    add_boundary_point(const unsigned int       p,
                       const SplineValues<dim> &splines,
                       const Field             &field,
                       Local                   &local) const
    {
      const Point<dim>     &x      = ball.surface.positions[p];
      const Tensor<1, dim> &normal = ball.surface.normals[p];
      const double          area   = ball.surface.areas[p];
      if (held == Held::flux)
        {
          add_load(splines.value,
                   -area * D * (Solution<dim>::gradient(x) * normal),
                   local);
          return;
        }
      const double beta = 20. * D / ball.points[1].h;
      double       slope[n];
      for (unsigned int a = 0; a < n; ++a)
        {
          slope[a] = 0.;
          for (unsigned int d = 0; d < dim; ++d)
            slope[a] += D * splines.gradient[d][a] * normal[d];
        }
      const auto &N     = splines.value;
      const auto  entry = [&](const unsigned int a, const unsigned int b) {
        return area * (beta * N[a] * N[b] - slope[a] * N[b] - N[a] * slope[b]);
      };
      add(entry, field, local);
      double load[n];
      for (unsigned int a = 0; a < n; ++a)
        load[a] = beta * N[a] - slope[a];
      add_load(load, -area * Solution<dim>::value(x), local);
    }

    const Ball<dim> &ball;
    const Held       held;
  };

  struct Result
  {
    double              error;      // in L2, relative to the solution
    std::vector<double> means;      // of the components
    double              defect;     // of the linear system, relative
    unsigned int        iterations; // of the linear solver
  };

  /** The solution of all components; the error is the largest one's. */
  template <int dim, int n_components>
  Result
  solve(const Ball<dim>   &ball,
        const Held         held,
        const std::string &linear_solver,
        const MPI_Comm     comm)
  {
    using Local = LocalEquations<dim, n_components>;
    const Diffusion<dim, n_components> diffusion(ball, held);
    Assembly<dim, n_components>        assembly(*ball.body.space, comm);
    const auto                         zero = assembly.unknowns().zero();
    assembly.make_pattern();
    Local       tangent(Local::tangent), residual(Local::energy_and_residual);
    const auto &K = assembly.matrix(zero, tangent, diffusion);
    auto        b =
      assembly.unknowns().sum(assembly.residual(zero, residual, diffusion));
    b *= -1.;

    LinearProblem problem;
    problem.typical_entry = D * std::pow(ball.points[0].h, dim - 2);
    QuietTimer       timer;
    SolverParameters parameters;
    parameters.linear_solver = linear_solver;
    LinearSolver solver(parameters, problem, timer);
    auto         c = zero;
    Result       result{0., {}, 0., 0};
    solver.solve(K, c, b, 1e-10, result.iterations);

    // The residual at the solution is that of the linear system.
    auto R = assembly.unknowns().sum(assembly.residual(c, residual, diffusion));
    result.defect = R.l2_norm() / b.l2_norm();

    const SplineField<dim, n_components> field(*ball.body.space, c, comm);
    const auto                          &points = ball.points[0];
    // By component: Σ V (error)² and Σ V c; then Σ V c̄² and Σ V.
    std::vector<double> sums(2 * n_components + 2, 0.);
    for (unsigned int g = 0; g + 1 < points.offsets.size(); ++g)
      {
        const auto local = field.on_grid_cell(g);
        for (unsigned int p = points.offsets[g]; p < points.offsets[g + 1]; ++p)
          {
            const unsigned int cell = ball.groups[0].points[p];
            const double       V    = ball.cells.volumes[cell];
            const auto         found =
              local.value(SplineValues<dim>(points.xi[p], points.h));
            const double exact =
              Solution<dim>::value(ball.cells.positions[cell]);
            for (unsigned int i = 0; i < n_components; ++i)
              {
                sums[2 * i] += V * std::pow(found[i] - (i + 1) * exact, 2);
                sums[2 * i + 1] += V * found[i];
              }
            sums[2 * n_components] += V * exact * exact;
            sums[2 * n_components + 1] += V;
          }
      }
    Utilities::MPI::sum(sums, comm, sums);
    for (unsigned int i = 0; i < n_components; ++i)
      {
        result.error =
          std::max(result.error,
                   std::sqrt(sums[2 * i] / sums[2 * n_components]));
        result.means.push_back(sums[2 * i + 1] / sums[2 * n_components + 1]);
      }
    return result;
  }

  /**
   * Errors on grids of spacing h = 40 µm / factor^i, with cells as large as
   * h^(3/2): the error of the cells as quadrature points is of the order of
   * their spacing squared, of whole ones at the surface less, and that of the
   * splines of order h³.
   */
  template <int dim>
  void
  check_order(const Held   held,
              const bool   trimmed,
              const double order,
              const double finest)
  {
    SCOPED_TRACE(std::string(held == Held::value ? "values" : "flux") +
                 (trimmed ? ", trimmed" : ""));
    const double        factor = dim == 2 ? 1.5 : 1.25;
    constexpr int       n      = 3; // refinements
    std::vector<double> errors;
    for (int i = 0; i <= n; ++i)
      {
        const double    h = coarsest / std::pow(factor, i);
        const Ball<dim> ball(h,
                             0.25 * coarsest * std::pow(h / coarsest, 1.5),
                             trimmed,
                             MPI_COMM_WORLD);
        EXPECT_GT(ball.body.space->n_outer_splines(), 0u);
        const Result result =
          solve<dim, 1>(ball, held, "iterative", MPI_COMM_WORLD);
        EXPECT_LE(result.defect, 1e-9);
        EXPECT_LE(result.iterations, 30u); // on any grid
        errors.push_back(result.error);
      }
    EXPECT_LE(errors.back(), finest);
    EXPECT_GE(std::log(errors.front() / errors.back()) / std::log(factor) / n,
              order)
      << "errors from " << errors.front() << " to " << errors.back();
  }

  /** The same on all ranks together and on each alone, and by the direct
   *  solver. */
  template <int dim>
  void
  check_ranks(const Held held)
  {
    const Ball<dim> shared(coarsest, 0.25 * coarsest, true, MPI_COMM_WORLD);
    const Ball<dim> own(coarsest, 0.25 * coarsest, true, MPI_COMM_SELF);
    const Result expected = solve<dim, 1>(own, held, "direct", MPI_COMM_SELF);
    EXPECT_GT(expected.error, 1e-4);
    EXPECT_NEAR(expected.means[0], 2., 1.);
    for (const std::string solver : {"iterative", "direct"})
      {
        const Result found =
          solve<dim, 1>(shared, held, solver, MPI_COMM_WORLD);
        EXPECT_NEAR(found.error, expected.error, 1e-7);
        EXPECT_NEAR(found.means[0], expected.means[0], 1e-7);
      }
  }

  /** Each component of a field is what it is alone. */
  template <int dim, int n_components>
  void
  check_components()
  {
    const Ball<dim> ball(coarsest, 0.25 * coarsest, true, MPI_COMM_WORLD);
    const auto      solutions = [&](const auto n) {
      return solve<dim, n.value>(ball, Held::value, "iterative", MPI_COMM_WORLD)
        .means;
    };
    const auto one = solutions(std::integral_constant<int, 1>());
    const auto all = solutions(std::integral_constant<int, n_components>());
    ASSERT_EQ(all.size(), n_components);
    for (unsigned int i = 0; i < n_components; ++i)
      EXPECT_NEAR(all[i], (i + 1) * one[0], 1e-7);
  }
} // namespace


// Order 2 is what the cells as quadrature points allow; trimmed ones fill the
// disc up to its surface.
TEST(ScalarField, ErrorsFallOnADisc)
{
  check_order<2>(Held::value, false, 2., 4e-4);
  check_order<2>(Held::flux, false, 2., 6e-4);
  check_order<2>(Held::value, true, 2.5, 2e-4);
  check_order<2>(Held::flux, true, 2.5, 2e-4);
}


TEST(ScalarField, ErrorsFallInABall)
{
  check_order<3>(Held::value, false, 2., 6e-4);
  check_order<3>(Held::flux, false, 2., 6e-4);
  check_order<3>(Held::value, true, 2.5, 6e-4);
  check_order<3>(Held::flux, true, 2.5, 6e-4);
}


TEST(ScalarField, IsTheSameForAnyNumberOfRanks)
{
  for (const Held held : {Held::value, Held::flux})
    {
      SCOPED_TRACE(held == Held::value ? "values" : "flux");
      check_ranks<2>(held);
      check_ranks<3>(held);
    }
}


TEST(ScalarField, ComponentsDoNotMix)
{
  check_components<2, 2>();
  check_components<2, 3>();
  check_components<3, 2>();
}
