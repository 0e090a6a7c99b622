// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_simulation_field_runs_h
#define morula_tests_simulation_field_runs_h

#include <morula/simulation/simulation.h>

#include <string>
#include <vector>

#include "common/temporary_file.h"
#include "output/scratch_directory.h"

namespace Morula
{
  /** A scene of these settings, whose files go into a directory of this test.
   */
  inline Scene
  read_field(std::vector<std::string> settings,
             const ScratchDirectory  &directory)
  {
    const TemporaryFile file("fields.prm", "");
    settings.insert(settings.end(),
                    {"Output directory=" + (directory / "run"),
                     "Output/Formats=none",
                     "Fields/Names=signal"});
    Scene scene = Scene::read(file.path, settings);
    scene.check();
    return scene;
  }

  /** Runs a scene; observe(cells, values of the field `signal` by cell, row of
   *  statistics.csv). */
  template <int dim, typename Observe>
  void
  run_field(const std::vector<std::string> &settings, const Observe &observe)
  {
    const ScratchDirectory directory;
    const Scene            scene = read_field(settings, directory);
    Simulation<dim>        simulation(scene, MPI_COMM_WORLD, false);
    simulation.run([&]() {
      const Cells<dim>    &cells = simulation.state().cells();
      const Column<double> column =
        cells.columns().template find<double>("signal");
      std::vector<double> values;
      for (unsigned int p = 0; p < cells.size(); ++p)
        values.push_back(cells[p].get(column));
      observe(cells, values, simulation.last_row());
    });
  }
} // namespace Morula

#endif
