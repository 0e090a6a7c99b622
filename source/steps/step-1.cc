// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// Step 1: splines on a disc that the grid cuts, and why they are extended.
//
// Everything in Morula is expressed by quadratic B-splines on a Cartesian grid
// that knows nothing of the tissue's shape. This program takes the smallest
// problem that has all the difficulties of that: a function f on a disc is
// projected onto the splines. The page doc/steps/step-1.md has the theory and
// the results; equation numbers are those of doc/theory.md.
//
//   build/step-1 prm/step-1.prm

// The rooms of the library that this program visits: `particles` for the cells
// that fill the disc, `grid` for the splines around them. There is no mechanics
// here. The scene is read and checked by `program` as in every other program.
#include <morula/particles/tissue.h>
#include <morula/program/program.h>
#include <morula/seeding/seeding.h>

#include <deal.II/base/convergence_table.h>
#include <deal.II/base/mpi.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/lapack_full_matrix.h>
#include <deal.II/lac/vector.h>

#include <cmath>
#include <iostream>
#include <map>
#include <optional>
#include <sstream>

namespace Step1
{
  using namespace dealii;
  using namespace Morula;

  // A disc is a two-dimensional thing, so the dimension is fixed.
  constexpr unsigned int dim = 2;

  // The disc, filled with cells on a regular lattice: a list of ids, positions,
  // and a row of numbers each. What the numbers of a row are, the columns know.
  // Every rank seeds its part of the lattice.
  PointList<dim>
  cells_of_disc(const TissueParameters &disc, const CellColumns<dim> &columns)
  {
    const Founders<dim> founders = seed_founders<dim>(disc, MPI_COMM_WORLD);
    PointList<dim>      cells(columns.n_numbers());
    for (std::size_t i = 0; i < founders.positions.size(); ++i)
      cells.add(founders.first_id + i,
                founders.positions[i],
                columns.founder(founders.positions[i], founders.volumes[i]));
    return cells;
  }


  // The projection of a function onto the splines. A Tissue holds the cells and
  // the background grid around them, both distributed over the ranks.
  class Projection
  {
  public:
    explicit Projection(const Scene &scene);

    unsigned int
    size() const
    {
      return n_unknowns;
    }

    double
    condition_number(const bool scaled) const;

    template <typename Function>
    double
    error(const Function &f) const;

  private:
    template <typename Visit>
    void
    for_each_cell(const Visit &visit) const;

    FullMatrix<double>
    mass_matrix() const;

    Tissue<dim>                     tissue;
    std::optional<SplineSpace<dim>> space;
    unsigned int                    n_unknowns;
  };


  // Without growth and division a cell has three properties: founder position,
  // volume, and deformation gradient. place() sends every cell to the rank that
  // owns its grid cell; there are no boundary points, as nothing is held.
  // splines() classifies the grid cells by (3.1) and (3.2) and numbers the
  // unknowns. In Morula each is a vector; here f is a scalar.
  Projection::Projection(const Scene &scene)
    : tissue(scene.grid,
             CellColumns<dim>(), // nothing grows or divides
             MPI_COMM_WORLD)
  {
    const PointList<dim> no_boundary_points;
    tissue.place(cells_of_disc(scene.tissue, tissue.cells().columns()),
                 no_boundary_points);
    space.emplace(tissue.splines());
    n_unknowns = space->n_unknowns();
  }


  // The one loop that the rest is made of: for each biological cell of this
  // rank, the values there of the functions that belong to the unknowns.
  //
  // A grid cell knows its $3^d$ splines $N_a$ (2.3). Which unknowns they are
  // expressed by, and with which weights, stands in SplineSpace::cells(): where
  // the weights are empty, the splines are unknowns themselves; elsewhere they
  // are the rows of the matrix C of (3.5), with the extension weights (3.3) in
  // the rows of outer splines. So the function of unknown s is
  // $\phi_s = \sum_a C_{as} N_a$. This is all of extension that a loop over
  // points ever sees.
  template <typename Visit>
  void
  Projection::for_each_cell(const Visit &visit) const
  {
    auto grid_cell = space->grid_cells().begin();
    for (const auto &group : tissue.cells().grid_cells())
      {
        while (grid_cell->number != group.number)
          ++grid_cell;
        const unsigned int m     = grid_cell->unknowns.size();
        const auto         index = space->box().index(group.number);

        std::vector<types::global_dof_index> unknowns;
        for (const unsigned int position : grid_cell->unknowns)
          unknowns.push_back(space->relevant().nth_index_in_set(position));

        for (unsigned int p = group.begin; p < group.end; ++p)
          {
            const Point<dim>        x = tissue.cells().position(p);
            const SplineValues<dim> N(space->box().unit_position(x, index),
                                      space->box().spacing());
            std::vector<double>     phi(m, 0.);
            for (unsigned int a = 0; a < N.n; ++a)
              for (unsigned int s = 0; s < m; ++s)
                phi[s] +=
                  (grid_cell->weights.empty() ? (a == s ? 1. : 0.) :
                                                grid_cell->weights[a * m + s]) *
                  N.value[a];
            visit(x, tissue.cells().volume(p), unknowns, phi);
          }
      }
  }


  // The matrix of the projection, $M_{st} = \sum_p V_p \phi_s(x_p)
  // \phi_t(x_p)$: the cells are the quadrature points, as in (2.1). There are a
  // few hundred unknowns, so that a full matrix on every rank is the simplest.
  FullMatrix<double>
  Projection::mass_matrix() const
  {
    FullMatrix<double> M(n_unknowns);
    for_each_cell([&](const Point<dim> &,
                      const double                                V,
                      const std::vector<types::global_dof_index> &unknowns,
                      const std::vector<double>                  &phi) {
      for (unsigned int s = 0; s < phi.size(); ++s)
        for (unsigned int t = 0; t < phi.size(); ++t)
          M(unknowns[s], unknowns[t]) += V * phi[s] * phi[t];
    });
    Utilities::MPI::sum(M, MPI_COMM_WORLD, M);
    return M;
  }


  // How much an error in the right-hand side is amplified, at most: the ratio
  // of the largest to the smallest singular value. If scaled, of the matrix
  // with a unit diagonal, $M_{st} / \sqrt{M_{ss} M_{tt}}$, which is what a
  // preconditioner makes of it at least.
  double
  Projection::condition_number(const bool scaled) const
  {
    const FullMatrix<double> M = mass_matrix();
    LAPACKFullMatrix<double> A(n_unknowns);
    for (unsigned int s = 0; s < n_unknowns; ++s)
      for (unsigned int t = 0; t < n_unknowns; ++t)
        A(s, t) = scaled ? M(s, t) / std::sqrt(M(s, s) * M(t, t)) : M(s, t);
    A.compute_svd();
    return A.singular_value(0) / A.singular_value(n_unknowns - 1);
  }


  // Projects f and returns the root of the mean square of what is left over.
  // For f = 1 this is the partition of unity: the splines can be 1 everywhere.
  template <typename Function>
  double
  Projection::error(const Function &f) const
  {
    Vector<double> coefficients(n_unknowns);
    for_each_cell([&](const Point<dim>                           &x,
                      const double                                V,
                      const std::vector<types::global_dof_index> &unknowns,
                      const std::vector<double>                  &phi) {
      for (unsigned int s = 0; s < phi.size(); ++s)
        coefficients(unknowns[s]) += V * f(x) * phi[s];
    });
    Utilities::MPI::sum(coefficients, MPI_COMM_WORLD, coefficients);

    LAPACKFullMatrix<double> M(n_unknowns);
    M = mass_matrix();
    M.compute_lu_factorization();
    M.solve(coefficients);

    double square = 0., area = 0.;
    for_each_cell([&](const Point<dim>                           &x,
                      const double                                V,
                      const std::vector<types::global_dof_index> &unknowns,
                      const std::vector<double>                  &phi) {
      double value = 0.;
      for (unsigned int s = 0; s < phi.size(); ++s)
        value += coefficients(unknowns[s]) * phi[s];
      square += V * std::pow(value - f(x), 2);
      area += V;
    });
    return std::sqrt(Utilities::MPI::sum(square, MPI_COMM_WORLD) /
                     Utilities::MPI::sum(area, MPI_COMM_WORLD));
  }


  // First experiment: what the splines can represent. Constants and quadratics
  // to rounding errors, because (3.3) continues quadratics exactly across the
  // cut grid cells; a wave with an error of the order $h^3$, like uncut
  // splines.
  void
  show_errors(const Scene &scene, std::ostream &out)
  {
    ConvergenceTable table;
    for (const double h : {100., 50., 25., 12.5})
      {
        Scene finer(scene);
        finer.grid.spacing = h * scene.grid.spacing / 50.;
        const Projection projection(finer);

        table.add_value("h", finer.grid.spacing.value());
        table.add_value("unknowns", projection.size());
        table.add_value("of 1", projection.error([](const Point<dim> &) {
          return 1.;
        }));
        table.add_value("of xy", projection.error([](const Point<dim> &x) {
          return x[0] * x[1] / 1e4;
        }));
        table.add_value("of a wave", projection.error([](const Point<dim> &x) {
          return std::sin(x[0] / 60.) * std::cos(x[1] / 60.);
        }));
      }
    for (const std::string column : {"of 1", "of xy", "of a wave"})
      {
        table.set_scientific(column, true);
        table.set_precision(column, 2);
      }
    table.evaluate_convergence_rates("of a wave",
                                     ConvergenceTable::reduction_rate_log2);
    out << "Error of the projection\n";
    table.write_text(out, TableHandler::org_mode_table);
  }


  // Second experiment: the grid is shifted under the disc, and the condition
  // number computed with and without extension. The disc does not change, so a
  // good method should not notice.
  void
  show_condition_numbers(const Scene &scene, std::ostream &out)
  {
    constexpr unsigned int n_offsets = 16;

    TableHandler                  table;
    std::map<std::string, double> largest;
    for (unsigned int i = 0; i < n_offsets; ++i)
      {
        Scene        shifted(scene);
        const double offset = scene.grid.spacing * (i + 0.5) / n_offsets;
        shifted.grid.offset = {offset, 0.6 * offset, 0.};
        table.add_value("offset", offset);
        for (const bool extension : {false, true})
          for (const bool scaled : {false, true})
            {
              shifted.grid.extension = extension;
              const double condition =
                Projection(shifted).condition_number(scaled);
              const std::string name =
                std::string(extension ? "extended" : "plain") +
                (scaled ? ", scaled" : "");
              largest[name] = std::max(largest[name], condition);
              table.add_value(name, condition);
              table.set_scientific(name, true);
              table.set_precision(name, 2);
            }
      }
    out << "Condition number\n";
    table.write_text(out, TableHandler::org_mode_table);
    for (const auto &[name, condition] : largest)
      out << "Largest, " << name << ": " << condition << '\n';
  }


  void
  run(const Scene &scene, const bool /*resume*/)
  {
    // All ranks compute, the first one speaks.
    std::ostringstream out;
    show_errors(scene, out);
    show_condition_numbers(scene, out);
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      std::cout << out.str();
  }
} // namespace Step1


// Program does what all main() functions have in common: MPI, the command line
// with -s overrides, --parameters and --explain, and messages and exit codes
// for what is thrown. We only say what is done with the scene.
int
main(int argc, char *argv[])
{
  Morula::Program program;
  program.work      = Step1::run;
  program.dimension = Step1::dim;
  program.resumes   = false;
  return program.run(argc, argv);
}
