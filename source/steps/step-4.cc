// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// Step 4: grid spacing, accuracy and time.
//
// A sphere of tissue is held on its lower half and grows (the paper's Fig. 2).
// How fine must the grid be? The program runs the same scene on four grids, and
// each of them with two ways of holding the surface, and sets the errors
// against a reference solution beside the time that they cost. Theory and
// results are in doc/steps/step-4.md, equation numbers are those of
// doc/theory.md.
//
//   build/step-4 prm/step-4.prm

#include <morula/base/expression.h>
#include <morula/base/input_error.h>
#include <morula/effects/growth/isotropic.h>
#include <morula/program/program.h>
#include <morula/simulation/simulation.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/table_handler.h>
#include <deal.II/base/utilities.h>

#include <cmath>
#include <fstream>
#include <iostream>

namespace Step4
{
  using namespace dealii;
  using namespace Morula;

  constexpr unsigned int dim = 3;

  // What is compared: the height of the apex and the mean energy density. The
  // first is a displacement, mild and easy to get right; the second looks at
  // the stresses everywhere, and most of all beside the edge of the clamp,
  // where they have no bound.
  struct Result
  {
    double apex;   // um
    double energy; // kPa
  };


  // The reference is the work of another program that shares nothing with the
  // library, see doc/half-fixed-sphere.md. It stands in a file with the columns
  // theta, time, zmax, zmax_error, total_volume, total_volume_error,
  // mean_energy_density, mean_energy_density_error. Which theta the scene
  // reaches, its own expression says.
  Result
  reference_for(const Scene &scene)
  {
    const ExpressionKey &theta =
      scene.keys<IsotropicGrowthParameters>().stretch;
    const double stretch =
      theta.expression(dim).value(Point<dim>(), scene.time.end_time);
    const std::string path =
      MORULA_SOURCE_DIRECTORY "/doc/data/half-fixed-sphere.csv";
    std::ifstream file(path);
    std::string   line;
    std::getline(file, line); // the header
    while (std::getline(file, line))
      {
        const std::vector<double> row =
          Utilities::string_to_double(Utilities::split_string_list(line, ','));
        if (std::abs(row.at(0) - stretch) < 1e-6)
          return {row.at(2), row.at(6)};
      }
    theta.refuse("a stretch that doc/data/half-fixed-sphere.csv has at End "
                 "time",
                 "It is " + std::to_string(stretch) + ". Let " +
                   scene.time.end_time.path() + " be 1, 2, 3 or 4 days.");
  }


  // One run. A Scene is a plain struct, so that a copy of it with other values
  // is all that a variation takes. Each run has a directory of its own.
  StatisticsRow
  result_of(const Scene &scene)
  {
    Simulation<dim> simulation(scene, MPI_COMM_WORLD, false);
    simulation.run();
    return simulation.last_row();
  }


  // The two ways of holding the surface (section 4.2): the symmetric form of
  // Nitsche's method with the paper's penalty, and the unsymmetric one with a
  // small penalty, which (4.4) allows.
  struct Clamp
  {
    std::string form;
    double      penalty;
  };


  // The loop over clamps and grids. The cells keep their size: how many of them
  // there are is biology, not numerics. What changes is the grid.
  void
  run(const Scene &scene, const bool /*resume*/)
  {
    const Result exact = reference_for(scene);
    TableHandler table;
    for (const Clamp &clamp :
         {Clamp{"symmetric", 1e3}, Clamp{"unsymmetric", 20.}})
      for (const double factor : {2., 1.5, 1., 0.75})
        {
          Scene varied(scene);
          varied.grid.spacing    = factor * varied.grid.spacing;
          varied.nitsche.form    = clamp.form;
          varied.nitsche.penalty = clamp.penalty;
          varied.output_directory +=
            "/" + clamp.form + "-" +
            std::to_string(std::lround(varied.grid.spacing));
          varied.check();

          const StatisticsRow row = result_of(varied);
          const Result        result{row.tissue.upper[2],
                              row.tissue.mean_energy_density};
          table.add_value("clamp", clamp.form);
          table.add_value("h", varied.grid.spacing.value());
          table.add_value("unknowns", static_cast<unsigned int>(row.unknowns));
          table.add_value("apex", result.apex);
          table.add_value("error, %", 100. * (result.apex / exact.apex - 1.));
          table.add_value("energy", result.energy);
          table.add_value("error, % ",
                          100. * (result.energy / exact.energy - 1.));
          table.add_value("seconds", row.wall_seconds);
        }

    table.set_precision("h", 1);
    table.set_precision("apex", 2);
    table.set_precision("error, %", 2);
    table.set_precision("energy", 5);
    table.set_precision("error, % ", 2);
    table.set_precision("seconds", 1);
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      {
        table.write_text(std::cout, TableHandler::org_mode_table);
        std::ofstream file(scene.output_directory + "/table.txt");
        table.write_text(file);
      }
  }
} // namespace Step4


int
main(int argc, char *argv[])
{
  Morula::Program program;
  program.work      = Step4::run;
  program.dimension = Step4::dim;
  program.resumes   = false;
  return program.run(argc, argv);
}
