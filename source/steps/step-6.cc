// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// Step 6: a constrained tissue with a size checkpoint.
//
// A sphere of cells that proliferate is held on its lower half (the paper's
// Fig. 4). Cells near the clamp have no room; with a size checkpoint they wait
// until they do. The program runs the same scene with three thresholds and asks
// where in the tissue cells have divided, and how squeezed they are. Theory and
// results are in doc/steps/step-6.md, equation numbers are those of
// doc/theory.md.
//
//   build/step-6 prm/step-6.prm

#include <morula/program/program.h>
#include <morula/simulation/simulation.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/table_handler.h>

#include <cmath>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <sstream>

namespace Step6
{
  using namespace dealii;
  using namespace Morula;

  constexpr unsigned int dim      = 3;
  constexpr unsigned int n_layers = 5;

  // The tissue in horizontal layers of equal height, 0 at the bottom. A cell
  // belongs to the layer where its *founder* was, so that a layer is a
  // population and its descendants, wherever they have been pushed to.
  unsigned int
  layer_of(const Point<dim> &X, const TissueParameters &sphere)
  {
    const double bottom = sphere.center.value()[2] - sphere.radius;
    const double part   = (X[2] - bottom) / (2. * sphere.radius);
    return std::min<unsigned int>(n_layers - 1, n_layers * part);
  }


  // One layer: how many cells there are, how many founders they come from, and
  // sums for means.
  struct Layer
  {
    double founders   = 0.;
    double cells      = 0.;
    double J_e        = 0.; // sum over the cells
    double generation = 0.; // likewise
  };

  using Layers = std::vector<Layer>;


  // The layers of the present state. A founder's position and volume are passed
  // on to all descendants, and the volume is halved at each division. So the
  // initial volume that a layer's cells stand for is that of its founders for
  // ever, and no list of the founders has to be kept:
  // a cell of generation g stands for $2^{-g}$ founders.
  Layers
  layers_of(const Tissue<dim> &tissue, const TissueParameters &sphere)
  {
    std::vector<double> sums(4 * n_layers);
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      {
        const auto         cell = tissue.cells()[p];
        const unsigned int i    = layer_of(cell.founder_position(), sphere);
        sums[4 * i + 0] += std::pow(0.5, cell.generation());
        sums[4 * i + 1] += 1.;
        sums[4 * i + 2] += cell.elastic_volume_ratio(); // J_e, (1.3)
        sums[4 * i + 3] += cell.generation();
      }
    Utilities::MPI::sum(sums, tissue.communicator(), sums);

    Layers layers;
    for (unsigned int i = 0; i < n_layers; ++i)
      layers.push_back(
        {sums[4 * i], sums[4 * i + 1], sums[4 * i + 2], sums[4 * i + 3]});
    return layers;
  }


  // The runs. Nothing but one key differs: the threshold $J_{th}$ of section
  // 6.3. The random numbers depend on the seed and on the lineage alone (6.7),
  // so that the same founder draws the same wait in all three runs; what
  // differs between them is the checkpoint's doing and not chance.
  struct Outcome
  {
    StatisticsRow row;
    Layers        layers;
  };

  Outcome
  run_with_checkpoint(Scene scene, const std::string &threshold)
  {
    scene.keys<CellCycleParameters>().size_checkpoint = threshold;
    scene.output_directory += "/J-" + threshold;
    scene.check();
    Simulation<dim> simulation(scene, MPI_COMM_WORLD, false);
    simulation.run();
    return {simulation.last_row(), layers_of(simulation.state(), scene.tissue)};
  }


  // Two tables: the tissue as a whole, and the layers. The second one is also
  // written as layers.csv, for the picture.
  void
  run(const Scene &scene, const bool /*resume*/)
  {
    TableHandler       whole, layered;
    std::ostringstream csv;
    csv << "J_th,layer,cells_per_founder,J_e,generation\n";
    for (const std::string threshold : {"0", "0.8", "0.9"})
      {
        const auto [row, layers] = run_with_checkpoint(scene, threshold);

        whole.add_value("J_th", threshold);
        whole.add_value("cells", static_cast<unsigned int>(row.cells));
        whole.add_value("waiting",
                        static_cast<unsigned int>(row.held_at_checkpoint));
        whole.add_value("apex", row.tissue.upper[2]);
        whole.add_value("volume/grown",
                        row.tissue.total_volume / row.tissue.grown_volume);
        whole.add_value("energy", row.tissue.mean_energy_density);
        whole.add_value("smallest J_e", row.tissue.min_elastic_volume_ratio);

        for (unsigned int i = n_layers; i-- > 0;)
          {
            const Layer &layer = layers[i];
            layered.add_value("J_th", threshold);
            layered.add_value("layer", i);
            layered.add_value("founders",
                              static_cast<int>(std::lround(layer.founders)));
            layered.add_value("cells per founder",
                              layer.cells / layer.founders);
            layered.add_value("J_e", layer.J_e / layer.cells);
            csv << threshold << ',' << i << ',' << std::setprecision(10)
                << layer.cells / layer.founders << ','
                << layer.J_e / layer.cells << ','
                << layer.generation / layer.cells << '\n';
          }
      }

    whole.set_precision("apex", 2);
    whole.set_precision("energy", 5);
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      {
        std::cout << "The whole tissue\n";
        whole.write_text(std::cout, TableHandler::org_mode_table);
        std::cout << "From the top layer, 4, to the bottom, 0\n";
        layered.write_text(std::cout, TableHandler::org_mode_table);
        std::ofstream(scene.output_directory + "/layers.csv") << csv.str();
      }
  }
} // namespace Step6


int
main(int argc, char *argv[])
{
  Morula::Program program;
  program.work      = Step6::run;
  program.dimension = Step6::dim;
  program.resumes   = false;
  return program.run(argc, argv);
}
