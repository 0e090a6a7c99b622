// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// Step 5: division.
//
// The cells of a cube grow along an axis, divide across it, and go on. First
// all of them at once and along z (the paper's Fig. 1d): then the cube doubles
// its height and nothing else, exactly. Then each at its own random time and
// along its own random axis (Fig. 3b): then only expectations are known, and
// the program compares with them over several random seeds. Theory and results
// are in doc/steps/step-5.md, equation numbers are those of doc/theory.md.
//
//   build/step-5 prm/step-5.prm

#include <morula/base/expression.h>
#include <morula/base/input_error.h>
#include <morula/effects/division/division_rule.h>
#include <morula/program/program.h>
#include <morula/simulation/simulation.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/table_handler.h>

#include <cmath>
#include <iostream>
#include <sstream>

namespace Step5
{
  using namespace dealii;
  using namespace Morula;

  constexpr unsigned int dim = 3;

  // Keys that may depend on the place are expressions. Here they are constants;
  // their value at the centre is as good as any.
  double
  duration(const Scene &scene)
  {
    return scene.keys<CellCycleParameters>().duration.expression(dim).value(
      Point<dim>(), 0.);
  }

  double
  exit_rate(const Scene &scene)
  {
    return scene.keys<CellCycleParameters>().exit_rate.expression(dim).value(
      Point<dim>(), 0.);
  }


  // First experiment. All cells enter S at t = 0, with the cycle's axis along
  // z. By (6.2) the cube should be $1 + t/T$ times as high at time t, without
  // any stress; at T/2 the number of cells doubles, which should not be seen in
  // the shape at all.
  void
  divide_together(Scene scene, std::ostream &out)
  {
    CellCycleParameters &cycle             = scene.keys<CellCycleParameters>();
    cycle.start                            = "together";
    cycle.exit_rate                        = "0"; // and then wait for ever
    scene.division.axis                    = "fixed";
    scene.keys<FixedAxisParameters>().axis = "0; 0; 1";
    scene.time.end_time                    = duration(scene);
    scene.output_directory += "/together";
    scene.check();

    Simulation<dim> simulation(scene, MPI_COMM_WORLD, false);
    const double    T = scene.time.end_time;

    TableHandler table;
    double       initial_height = 0., largest_error = 0.;
    simulation.run([&]() {
      const StatisticsRow &row    = simulation.last_row();
      const double         height = row.tissue.upper[2] - row.tissue.lower[2];
      if (row.step == 0)
        initial_height = height;
      const double error =
        std::abs(height - initial_height * (1. + row.time / T));
      largest_error = std::max(largest_error, error);

      // The steps on both sides of the division, and the end.
      if (row.step == 0 || std::abs(row.time - 0.5 * T) < 1.5 * row.dt ||
          std::abs(row.time - T) < 0.5 * row.dt)
        {
          table.add_value("day", row.time);
          table.add_value("cells", static_cast<unsigned int>(row.cells));
          table.add_value("height", height);
          table.add_value("energy", row.tissue.mean_energy_density);
        }
    });
    table.set_precision("height", 6);
    table.set_scientific("energy", true);
    out << "All at once, along z\n";
    table.write_text(out, TableHandler::org_mode_table);
    out << "Largest error of the height: " << largest_error << " um\n";
  }


  // Second experiment. A founder leaves G0 at a random time with the rate
  // Lambda and divides T/2 later; its daughters reach their next division 3T/2
  // after the onset at the earliest. So up to t = 3T/2, a founder is still one
  // cell, or two with the probability
  //
  //   $p = 1 - e^{-\Lambda (t - T/2)}$.
  //
  // N founders are N independent draws: the number of divisions has the mean
  // $N p$ and the standard deviation $\sqrt{N p (1-p)}$.


  double
  probability_of_division(const Scene &scene)
  {
    const double T      = duration(scene);
    const double Lambda = exit_rate(scene);
    const double t      = scene.time.end_time;
    if (t < 0.5 * T || t > 1.5 * T)
      scene.time.end_time.refuse(
        "a time between a half and one and a half cycles",
        "Beyond, daughters divide as well, and the formula in step-5.cc does "
        "not count them.");
    return 1. - std::exp(-Lambda * (t - 0.5 * T));
  }


  // Ancestry stands in the cells' columns: the generation counts the divisions
  // since the founder. Two daughters of the first generation are one division.
  // The axes are in a column of the cell cycle, found by its name. They
  // should point everywhere alike: the
  // mean of $n_z^2$ over random directions is 1/3.
  struct Census
  {
    double divisions  = 0.;
    double mean_n_z_2 = 0.;
  };

  Census
  census(const Tissue<dim> &tissue)
  {
    const Cells<dim> &cells = tissue.cells();
    const auto axes = cells.columns().find<Tensor<1, dim>>("division_axis");
    double     n_daughters = 0., n_z_2 = 0., n_cycling = 0.;
    for (unsigned int p = 0; p < cells.size(); ++p)
      {
        n_daughters += (cells[p].generation() == 1);
        const Tensor<1, dim> axis = cells.get(axes, p);
        if (axis.norm() > 0.) // else the cell waits
          {
            n_z_2 += axis[2] * axis[2];
            n_cycling += 1.;
          }
      }
    const MPI_Comm comm = tissue.communicator();
    return {0.5 * Utilities::MPI::sum(n_daughters, comm),
            Utilities::MPI::sum(n_z_2, comm) /
              Utilities::MPI::sum(n_cycling, comm)};
  }


  void
  divide_at_random(const Scene &scene, const double p, std::ostream &out)
  {
    // The same tissue three times, with random seeds that follow each other.
    // The number of divisions is compared with its expectation in units of the
    // standard deviation, the axes with the mean 1/3; the volume shows whether
    // divisions leave stress behind.
    TableHandler table;
    for (unsigned int i = 0; i < 3; ++i)
      {
        Scene varied(scene);
        varied.random_seed += i;
        varied.output_directory +=
          "/seed-" + std::to_string(varied.random_seed);
        varied.check();

        Simulation<dim> simulation(varied, MPI_COMM_WORLD, false);
        double          n_founders = 0.;
        simulation.run([&]() {
          if (simulation.last_row().step == 0)
            n_founders = simulation.last_row().cells;
        });
        const StatisticsRow &row     = simulation.last_row();
        const Census         counted = census(simulation.state());


        table.add_value("seed", varied.random_seed.value());
        table.add_value("cells", static_cast<unsigned int>(row.cells));
        table.add_value("divisions", static_cast<int>(counted.divisions));
        table.add_value("expected", n_founders * p);
        table.add_value("deviations",
                        (counted.divisions - n_founders * p) /
                          std::sqrt(n_founders * p * (1. - p)));
        table.add_value("n_z^2", counted.mean_n_z_2);
        table.add_value("volume/grown",
                        row.tissue.total_volume / row.tissue.grown_volume);
        table.add_value("energy", row.tissue.mean_energy_density);
      }
    table.set_precision("expected", 1);
    table.set_precision("deviations", 2);
    table.set_precision("n_z^2", 4);
    table.set_precision("volume/grown", 5);
    table.set_precision("energy", 5);
    out << "Each at its own time, along its own axis\n";
    table.write_text(out, TableHandler::org_mode_table);
  }


  void
  run(const Scene &scene, const bool /*resume*/)
  {
    const double       p = probability_of_division(scene); // or bad input
    std::ostringstream out;
    divide_together(scene, out);
    divide_at_random(scene, p, out);
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      std::cout << out.str();
  }
} // namespace Step5


int
main(int argc, char *argv[])
{
  Morula::Program program;
  program.work      = Step5::run;
  program.dimension = Step5::dim;
  program.resumes   = false;
  return program.run(argc, argv);
}
