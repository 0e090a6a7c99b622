// ranks: 1 2 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/grid/occupancy.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "../body_on_grid.h"

using namespace Morula;

namespace
{
  template <int dim>
  GridBox<dim>
  cube(const int n, const double h)
  {
    GridIndex<dim> first, size;
    first.fill(-n / 2);
    size.fill(n);
    return GridBox<dim>(first, size, h, Point<dim>());
  }

  template <int dim>
  std::vector<double>
  fills(const Occupancy<dim> &occupancy)
  {
    std::vector<double> list;
    for (unsigned int number = 0; number < occupancy.box().size(); ++number)
      list.push_back(occupancy.fill(number));
    return list;
  }

  /** Five particles per grid spacing, grown by θ. */
  template <int dim>
  void
  check_grown_lattice()
  {
    const double       h   = 50.;
    const GridBox<dim> box = cube<dim>(8, h);
    for (const double theta : {1., 1.1, 1.2345, 1.4, 1.7})
      {
        SCOPED_TRACE("stretch " + std::to_string(theta));
        const double spacing = theta * h / 5.;
        // Straddles no edge of the box, whatever theta.
        const auto points =
          lattice_points<dim>(Point<dim>(),
                              3.4 * h - spacing,
                              spacing,
                              [](const auto &) { return true; });
        Occupancy<dim> occupancy(box);
        double         volume = 0.;
        if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
          for (const Point<dim> &x : points)
            occupancy.add_particle(x, std::pow(spacing, dim));
        occupancy.sum(MPI_COMM_WORLD);
        for (unsigned int number = 0; number < box.size(); ++number)
          {
            bool interior = true;
            for (const int i : box.index(number))
              interior = interior && i >= -2 && i < 2;
            if (interior)
              {
                EXPECT_NEAR(occupancy.fill(number), 1., 1e-9);
              }
            volume += occupancy.fill(number) * std::pow(h, dim);
          }
        EXPECT_NEAR(volume / (points.size() * std::pow(spacing, dim)),
                    1.,
                    1e-9);
      }
  }

  template <int dim>
  void
  check_order()
  {
    const unsigned int n_ranks =
      Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
    const unsigned int rank = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
    const GridBox<dim> box  = cube<dim>(8, 50.);
    std::mt19937       generator(4);
    std::vector<std::pair<Point<dim>, double>> cells;
    for (unsigned int i = 0; i < 3000; ++i)
      {
        Point<dim> x(150. * random_tensor<1, dim>(generator));
        cells.emplace_back(x, std::pow(5. + generator() % 20, dim));
      }
    Occupancy<dim> alone(box), together(box);
    for (const auto &[x, V] : cells)
      alone.add_particle(x, V);
    std::shuffle(cells.begin(), cells.end(), generator);
    for (std::size_t i = rank; i < cells.size(); i += n_ranks)
      together.add_particle(cells[i].first, cells[i].second);
    together.sum(MPI_COMM_WORLD);
    EXPECT_EQ(fills(alone), fills(together)); // bitwise
    EXPECT_EQ(classify(alone, 0.85), classify(together, 0.85));
    for (unsigned int number = 0; number < box.size(); ++number)
      EXPECT_EQ(alone.n_quadrature_points(number),
                together.n_quadrature_points(number));
  }

  /** Classes of a slab 0 < x < thickness of ten particles per spacing. */
  template <int dim>
  std::vector<GridCellClass>
  slab_classes(const GridBox<dim> &box,
               const double        thickness,
               const double        C_C)
  {
    const double   spacing = 5.;
    Occupancy<dim> occupancy(box);
    for (const auto &x :
         lattice_points<dim>(Point<dim>(), 100., spacing, [&](const auto &x) {
           return x[0] > 0. && x[0] < thickness;
         }))
      occupancy.add_particle(x, std::pow(spacing, dim));
    return classify(occupancy, C_C);
  }

  template <int dim>
  void
  check_threshold()
  {
    const GridBox<dim> box = cube<dim>(8, 50.);
    GridIndex<dim>     full{}, part{}, empty{};
    part[0]  = 1;
    empty[0] = 2;
    // The second layer of grid cells is filled to 0.8 or to 0.9.
    for (const double fill : {0.8, 0.9})
      {
        const auto classes = slab_classes<dim>(box, 50. * (1. + fill), 0.85);
        EXPECT_EQ(classes[box.number(full)], GridCellClass::inner);
        EXPECT_EQ(classes[box.number(part)],
                  fill > 0.85 ? GridCellClass::inner : GridCellClass::cut);
        EXPECT_EQ(classes[box.number(empty)], GridCellClass::inactive);
      }
    // Exactly the threshold is inner.
    EXPECT_EQ(slab_classes<dim>(box, 50. * 1.8, 0.8)[box.number(part)],
              GridCellClass::inner);
    // A sheet of 0.4 grid cells has no fuller neighbour.
    EXPECT_EQ(slab_classes<dim>(box, 50. * 0.4, 0.85)[box.number(full)],
              GridCellClass::inner);
  }

  template <int dim>
  void
  check_few_points()
  {
    const GridBox<dim> box = cube<dim>(8, 50.);
    const unsigned int few = Utilities::pow(2, dim);
    for (const unsigned int n : {few - 1, few})
      {
        Occupancy<dim> occupancy(box);
        for (unsigned int i = 0; i < n; ++i)
          {
            Point<dim> x;
            for (unsigned int d = 0; d < dim; ++d)
              x[d] = 25. + i;
            occupancy.add_particle(x, std::pow(10., dim)); // one point each
          }
        Point<dim> boundary_point;
        for (unsigned int d = 0; d < dim; ++d)
          boundary_point[d] = -30.;
        occupancy.add_boundary_point(boundary_point);
        const auto classes = classify(occupancy, 0.5);
        EXPECT_EQ(classes[box.number(GridIndex<dim>{})],
                  n == few ? GridCellClass::inner : GridCellClass::cut);
        const auto beside = box.number(box.locate(boundary_point));
        EXPECT_TRUE(occupancy.active(beside));
        EXPECT_EQ(classes[beside], GridCellClass::cut);
      }
  }

  /** A coarse lattice: the quadrature points of the cells' boxes fill in. */
  template <int dim>
  void
  check_coarse_lattice()
  {
    const double       h   = 50.;
    const GridBox<dim> box = cube<dim>(16, h);
    for (const double spacing : {60., 75., 110.})
      {
        Occupancy<dim> occupancy(box);
        for (const auto &x :
             lattice_points<dim>(Point<dim>(), 220., spacing, [](const auto &) {
               return true;
             }))
          occupancy.add_particle(x, std::pow(spacing, dim));
        const auto classes = classify(occupancy, 0.85);
        for (unsigned int number = 0; number < box.size(); ++number)
          {
            bool interior = true;
            for (const int i : box.index(number))
              interior = interior && i >= -3 && i < 3;
            if (interior)
              {
                EXPECT_EQ(classes[number], GridCellClass::inner);
              }
          }
      }
  }
} // namespace


TEST(Occupancy, FillsTheInteriorOfAGrownLattice){
  MORULA_BOTH_DIMENSIONS(check_grown_lattice)}


TEST(Occupancy, CoarseLatticesHaveInnerGridCells){
  MORULA_BOTH_DIMENSIONS(check_coarse_lattice)}


TEST(Occupancy,
     DoesNotDependOnOrderAndRanks){MORULA_BOTH_DIMENSIONS(check_order)}


TEST(Occupancy,
     InnerGridCellsAreFullEnough){MORULA_BOTH_DIMENSIONS(check_threshold)}


TEST(Occupancy, InnerGridCellsHoldEnoughPoints)
{
  MORULA_BOTH_DIMENSIONS(check_few_points)
}
