// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// Step 3: hypertrophy. The cells of a cube grow; nothing divides.
//
// If all cells grow alike and nothing is in their way, there is no stress, and
// every cell's place is known (the paper's Fig. 3a). If only some of them grow,
// they strain each other, and something remains that is known: without outer
// forces the stresses balance on average. The program runs one scene, watches
// it step by step, and asks the cells at the end. Theory and results are in
// doc/steps/step-3.md, equation numbers are those of doc/theory.md.
//
//   build/step-3 prm/step-3.prm

#include <morula/program/program.h>
#include <morula/simulation/simulation.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/table_handler.h>

#include <cmath>
#include <iostream>

namespace Step3
{
  using namespace dealii;
  using namespace Morula;

  constexpr unsigned int dim = 3;

  // Means over the tissue's volume that statistics.csv does not have.
  struct MeanStress
  {
    double pressure; // -tr(sigma)/3, kPa
    double size;     // |sigma|, kPa
  };


  // quantities() gives a cell's stress and energy as the output files have
  // them. In equilibrium the mean stress tells the forces on the surface:
  //
  //   $\sum_p V_p\, \sigma_p = \sum_b x_b \otimes f_b$.
  //
  // (Put the displacement u = a x_j into the virtual work (2.4); splines are
  // exact for it.) The only forces f are those of the slip plane z = 0. They
  // point along z and act where z = 0, so that the trace is zero: on average
  // the tissue is as much pulled as pressed, whatever grows in it; up to the
  // small gap, z = 0 not quite, that Nitsche's method leaves.
  MeanStress
  mean_stress(const Simulation<dim> &simulation)
  {
    const Tissue<dim> &tissue = simulation.state();
    double             volume = 0., trace = 0., size = 0.;
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      {
        const CellQuantities cell = simulation.quantities(p);
        volume += cell.volume;
        trace += cell.volume * dealii::trace(cell.stress);
        size += cell.volume * cell.stress.norm();
      }
    const MPI_Comm comm = tissue.communicator();
    volume              = Utilities::MPI::sum(volume, comm);
    return {-Utilities::MPI::sum(trace, comm) / (3. * volume),
            Utilities::MPI::sum(size, comm) / volume};
  }


  // If all cells grow by $F_g = \theta I$, (6.1), the tissue is $\theta$ times
  // as large in each direction and $F_e = I$. The cube stands on the plane
  // z = 0, its axis on x = y = 0, and the slip plane holds neither of the two
  // translations along it nor the rotation about z; (4.10) sets those to zero.
  // So the cell from X is at $\theta X$. Where growth is not uniform this
  // distance is simply how far the tissue has left that place.
  double
  largest_distance_from_free_growth(const Tissue<dim> &tissue)
  {
    const Cells<dim> &cells   = tissue.cells();
    double            largest = 0.;
    for (unsigned int p = 0; p < cells.size(); ++p)
      largest = std::max(largest,
                         cells.position(p).distance(Point<dim>(
                           cells[p].growth() * cells[p].founder_position())));
    return Utilities::MPI::max(largest, tissue.communicator());
  }


  // run() takes a function that is called with the initial state and after
  // every step. It may look at everything; here it fills a row of a table.
  // last_row() is the row of statistics.csv. All ranks must call what is
  // collective, and only the first prints.
  void
  run(const Scene &scene, const bool resume)
  {
    Simulation<dim> simulation(scene, MPI_COMM_WORLD, resume);
    TableHandler    table;
    simulation.run([&]() {
      const StatisticsRow &row    = simulation.last_row();
      const MeanStress     stress = mean_stress(simulation);
      table.add_value("day", row.time);
      table.add_value("height", row.tissue.upper[2]);
      table.add_value("volume/grown",
                      row.tissue.total_volume / row.tissue.grown_volume);
      table.add_value("energy", row.tissue.mean_energy_density);
      table.add_value("stress", stress.size);
      table.add_value("pressure", stress.pressure);
      table.add_value("Newton", row.newton_iterations);
    });
    const double distance =
      largest_distance_from_free_growth(simulation.state());

    table.set_precision("height", 4);
    table.set_precision("volume/grown", 6);
    for (const std::string column : {"energy", "stress", "pressure"})
      {
        table.set_scientific(column, true);
        table.set_precision(column, 3);
      }
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      {
        table.write_text(std::cout, TableHandler::org_mode_table);
        std::cout << "Largest distance from free growth: " << distance
                  << " um\n";
      }
  }
} // namespace Step3


// This program makes one run, so that --resume works as it does for morula.
int
main(int argc, char *argv[])
{
  Morula::Program program;
  program.work      = Step3::run;
  program.dimension = Step3::dim;
  return program.run(argc, argv);
}
