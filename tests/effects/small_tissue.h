// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_effects_small_tissue_h
#define morula_tests_effects_small_tissue_h

#include <morula/effects/development.h>
#include <morula/effects/growth/isotropic.h>
#include <morula/particles/tissue.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/body_on_grid.h"

namespace Morula
{
  template <int dim>
  std::unique_ptr<const GrowthLaw<dim>>
  isotropic_growth(const std::string &stretch)
  {
    IsotropicGrowthParameters parameters;
    parameters.stretch = stretch;
    return std::make_unique<const IsotropicGrowth<dim>>(parameters);
  }

  template <int dim>
  CellCycle<dim>
  cell_cycle(const std::string &start, const std::string &size_checkpoint = "0")
  {
    CellCycleParameters parameters;
    parameters.start           = start;
    parameters.size_checkpoint = size_checkpoint;
    return CellCycle<dim>(parameters, 42, 1e-9);
  }

  /** A smooth F ≠ I with det F > 0. */
  template <int dim>
  Tensor<2, dim>
  some_deformation(const Point<dim> &x)
  {
    Tensor<2, dim> F = unit_tensor<dim>();
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        F[i][j] += 0.1 * std::sin(x[i] / 70. + 2. * j + i);
    return F;
  }

  /** Cells at given positions with their state at t = 0, by id. */
  template <int dim, typename Deformation>
  PointList<dim>
  founders(const std::vector<Point<dim>> &positions,
           const double                   V0,
           const CellDevelopment<dim>    &growth,
           const Deformation             &deformation)
  {
    const CellColumns<dim> &columns = growth.columns();
    PointList<dim>          cells(columns.n_numbers());
    for (unsigned int i = 0; i < positions.size(); ++i)
      {
        const double V = V0 * (1. + 0.1 * (i % 3));
        cells.add(i, positions[i], columns.founder(positions[i], V));
        const CellView<dim, double> cell(cells.row(i), columns);
        cell.set(columns.deformation, deformation(positions[i]));
        growth.initialize(i, cell);
      }
    return cells;
  }

  /** A small ball of cells at t = 0, strained or not. */
  template <int dim>
  struct SmallBall : public Tissue<dim>
  {
    explicit SmallBall(const CellDevelopment<dim> &growth,
                       const bool                  strained = true)
      : Tissue<dim>(GridParameters(), growth.columns(), MPI_COMM_SELF)
    {
      this->place(founders(ball_points(Point<dim>(), 60., 20.),
                           std::pow(20., dim),
                           growth,
                           [=](const Point<dim> &x) {
                             return strained ? some_deformation<dim>(x) :
                                               unit_tensor<dim>();
                           }),
                  PointList<dim>());
    }
  };

  /** On one rank what all ranks give alike, so that it is placed once. */
  template <int dim>
  PointList<dim>
  only_first_rank(const PointList<dim> &points, const MPI_Comm comm)
  {
    if (Utilities::MPI::this_mpi_process(comm) == 0)
      return points;
    return PointList<dim>(points.n_numbers);
  }

  /** Moves no cell, grows them over (t0, t1], as a step does. */
  template <int dim>
  void
  grow(Tissue<dim>                &tissue,
       const CellDevelopment<dim> &growth,
       const double                t0,
       const double                t1)
  {
    growth.commit(tissue, growth.of_step(tissue, t0, t1), t0, t1);
  }

  /** All cells of all ranks: position and row by id. */
  template <int dim>
  std::map<types::particle_index, std::pair<Point<dim>, std::vector<double>>>
  all_cells(const Tissue<dim> &tissue)
  {
    using Cells              = std::map<types::particle_index,
                                        std::pair<Point<dim>, std::vector<double>>>;
    const PointList<dim> own = tissue.cells().copy();
    Cells                mine, all;
    for (std::size_t i = 0; i < own.size(); ++i)
      {
        const auto row   = own.row(i);
        mine[own.ids[i]] = {own.positions[i], {row.begin(), row.end()}};
      }
    for (const Cells &part :
         Utilities::MPI::all_gather(tissue.communicator(), mine))
      all.insert(part.begin(), part.end());
    return all;
  }
} // namespace Morula

#endif
