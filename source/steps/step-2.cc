// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// Step 2: an elastic body that the grid cuts, held by Nitsche's method, and how
// fast its errors fall.
//
// A disc of tissue is sheared into waves by a displacement that we choose
// beforehand; the body force that keeps it there follows by hand. So the exact
// solution of a problem with large deformations is known everywhere, and the
// program measures by how much Morula misses it. Theory and results are in
// doc/steps/step-2.md, equation numbers are those of doc/theory.md.
//
//   build/step-2 prm/step-2.prm

#include <morula/base/expression.h>
#include <morula/effects/forces/body_force.h>
#include <morula/effects/surface/fixed.h>
#include <morula/mechanics/material.h>
#include <morula/particles/boundary_state.h>
#include <morula/program/program.h>
#include <morula/simulation/simulation.h>

#include <deal.II/base/convergence_table.h>
#include <deal.II/base/mpi.h>

#include <cmath>
#include <iostream>
#include <sstream>

namespace Step2
{
  using namespace dealii;
  using namespace Morula;

  constexpr unsigned int dim = 2;

  // The solution. Every layer of the disc slides along x, as far as its height
  // Y says:
  //
  //   $x = X + A \sin(kY)\, e_x$,
  //   $F = I + \gamma\, e_x \otimes e_y$,  $\gamma = A k \cos(kY)$.
  //
  // The volume does not change, $J = 1$, so that by (1.5)
  // $\tau = \mu (F F^T - I)$ and the first Piola-Kirchhoff stress is
  // $P = \tau F^{-T} = \mu \gamma (e_x \otimes e_y + e_y \otimes e_x)$. The
  // body force that balances it, $b = -\operatorname{Div} P$, is
  // $b = -\mu \gamma'(Y)\, e_x = \mu A k^2 \sin(kY)\, e_x$.
  struct Waves
  {
    double amplitude   = 40.;                     // A, um
    double wave_number = 2. * numbers::PI / 500.; // k, 1/um

    Tensor<1, dim>
    displacement(const Point<dim> &X) const
    {
      Tensor<1, dim> u;
      u[0] = amplitude * std::sin(wave_number * X[1]);
      return u;
    }

    Tensor<2, dim>
    deformation(const Point<dim> &X) const
    {
      Tensor<2, dim> F(unit_symmetric_tensor<dim>());
      F[0][1] = amplitude * wave_number * std::cos(wave_number * X[1]);
      return F;
    }
  };


  // The scene as a user would write it, but written by the program: a Scene is
  // a plain struct with a member for every key. Conditions and loads are
  // expressions of the initial position, so the solution is handed over as
  // text; the factor t lets them grow with time. With "Fixed where = 1" the
  // whole surface is held at its prescribed position. Cells get smaller with
  // the grid, as they are its quadrature points; and "trimmed" cells at the rim
  // have the volume that is really inside of the disc, lest that error hide all
  // others.
  Scene
  scene_of(const Waves &waves, Scene scene, const double refinement)
  {
    const Lame lame = Morula::lame(
      scene.material.youngs_modulus.expression(dim).value(Point<dim>(), 0.),
      scene.material.poissons_ratio.expression(dim).value(Point<dim>(), 0.));

    std::ostringstream sine, displacement, force;
    sine.precision(16);
    displacement.precision(16);
    force.precision(16);
    sine << "t*sin(" << std::fixed << waves.wave_number << "*Y)";
    displacement << waves.amplitude << "*" << sine.str() << "; 0; 0";
    force << lame.mu * waves.amplitude * std::pow(waves.wave_number, 2) << "*"
          << sine.str() << "; 0; 0";

    scene.output_directory += "/" + std::to_string(std::lround(refinement));
    scene.grid.spacing /= refinement;
    scene.tissue.cell_spacing /= refinement;
    scene.material.volumetric_strain                = "pointwise";
    scene.keys<FixedParameters>().where             = "1";
    scene.keys<FixedParameters>().displacement      = displacement.str();
    scene.keys<BodyForceParameters>().force_density = force.str();
    scene.check();
    return scene;
  }


  // What is measured, each the root of a mean square, or a maximum.
  struct Errors
  {
    double displacement = 0.; // of the cells, um
    double deformation  = 0.; // |F - exact F| of the cells
    double gap          = 0.; // largest distance of a held point, um
  };


  // After run(), state() is the tissue as it is. Cells and boundary points are
  // visited in the same way: this rank's ones are numbered from 0 on, and what
  // they have is asked for by its name.
  Errors
  errors_of(const Simulation<dim> &simulation, const Waves &waves)
  {
    const Tissue<dim> &tissue = simulation.state();
    Errors             errors;
    double             volume = 0.;
    const Cells<dim>  &cells  = tissue.cells();
    for (unsigned int p = 0; p < cells.size(); ++p)
      {
        const Point<dim>     X = cells[p].founder_position();
        const double         V = cells.initial_volume(p);
        const Tensor<1, dim> u = cells.position(p) - X;
        errors.displacement += V * (u - waves.displacement(X)).norm_square();
        errors.deformation +=
          V * (cells[p].F() - waves.deformation(X)).norm_square();
        volume += V;
      }
    const BoundaryPoints<dim> &points = tissue.boundary_points();
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        const Point<dim>     X = points[p].initial_position();
        const Tensor<1, dim> u = points.position(p) - X;
        errors.gap = std::max(errors.gap, (u - waves.displacement(X)).norm());
      }

    const MPI_Comm comm = tissue.communicator();
    volume              = Utilities::MPI::sum(volume, comm);
    errors.displacement =
      std::sqrt(Utilities::MPI::sum(errors.displacement, comm) / volume);
    errors.deformation =
      std::sqrt(Utilities::MPI::sum(errors.deformation, comm) / volume);
    errors.gap = Utilities::MPI::max(errors.gap, comm);
    return errors;
  }


  // Four grids, each twice as fine as the one before. Ten time steps take the
  // disc from rest to the full waves, a shear of one half. The exact solution
  // does not know of steps; the error depends on them a little, because each
  // has splines of its own around the tissue as it is then.
  void
  run(const Scene &scene, const bool /*resume*/)
  {
    const Waves      waves;
    ConvergenceTable table;
    for (const double refinement : {1., 2., 4., 8.})
      {
        Simulation<dim> simulation(scene_of(waves, scene, refinement),
                                   MPI_COMM_WORLD,
                                   false);
        simulation.run();
        const Errors         errors = errors_of(simulation, waves);
        const StatisticsRow &row    = simulation.last_row();

        table.add_value("h", scene.grid.spacing / refinement);
        table.add_value("cells", static_cast<unsigned int>(row.cells));
        table.add_value("unknowns", static_cast<unsigned int>(row.unknowns));
        table.add_value("Newton", row.newton_iterations);
        table.add_value("displacement", errors.displacement);
        table.add_value("deformation", errors.deformation);
        table.add_value("gap", errors.gap);
      }

    for (const std::string column : {"displacement", "deformation", "gap"})
      {
        table.set_scientific(column, true);
        table.set_precision(column, 3);
        table.evaluate_convergence_rates(column,
                                         ConvergenceTable::reduction_rate_log2);
      }
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      {
        std::cout << "Errors\n";
        table.write_text(std::cout, TableHandler::org_mode_table);
      }
  }
} // namespace Step2


int
main(int argc, char *argv[])
{
  Morula::Program program;
  program.work      = Step2::run;
  program.dimension = Step2::dim;
  program.resumes   = false;
  return program.run(argc, argv);
}
