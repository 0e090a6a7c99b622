// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "grid/room.h"

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
using Particles = std::vector<ParticleDomain<dim>>;

/** A grid with this box, shared evenly. */
template <int dim>
struct GridOf : public BackgroundGrid<dim>
{
  explicit GridOf(const GridBox<dim> &box)
    : BackgroundGrid<dim>(grid_of_spacing(box.spacing()), MPI_COMM_WORLD)
  {
    this->make(box.first(), box.n());
    this->partition({});
  }
};

/** Cells here and there in a box that is longer than all ranks' windows
 *  together: sparse, dense, in sheets and in rows. */
template <int dim>
Particles<dim>
strange_tissue(const double length)
{
  std::mt19937   generator(4);
  Particles<dim> cells;
  for (unsigned int i = 0; i < 3000; ++i)
    {
      Point<dim> x(150. * random_tensor<1, dim>(generator));
      x[0] += 75. * (generator() % 2) - 0.5 * length + 180.;
      cells.emplace_back(x, std::pow(5. + generator() % 20, dim));
    }
  for (double along = -0.45 * length; along < 0.45 * length; along += 7.)
    for (double across = 0.; across < 60.; across += 7.)
      {
        Point<dim> x; // a sheet, not along the grid
        x[0]       = along;
        x[1]       = 60. + 0.15 * along * along / length;
        x[dim - 1] = dim == 3 ? across - 30. : x[1];
        cells.emplace_back(x, std::pow(7., dim));
        if (across == 0.) // a row
          {
            x[1] = -200. + 0.1 * along;
            if (dim == 3)
              x[dim - 1] = 120.;
            cells.emplace_back(x, std::pow(7., dim));
          }
      }
  return cells;
}

/** Classes of a slab 0 < x < thickness of ten particles per spacing. */
template <int dim>
std::vector<GridCellClass>
slab_classes(const GridBox<dim> &box, const double thickness, const double C_C)
{
  const double spacing = 5.;
  const auto   points =
    lattice_points<dim>(Point<dim>(), 100., spacing, [&](const auto &x) {
      return x[0] > 0. && x[0] < thickness;
    });
  return classify(occupancy_of(box, domains_of(points, std::pow(spacing, dim))),
                  C_C);
}

/** @p n particles of 20 µm along the diagonal of the grid. */
template <int dim>
Particles<dim>
diagonal(const unsigned int n, const double start)
{
  Particles<dim> particles;
  for (unsigned int i = 0; i < n; ++i)
    {
      Point<dim> x;
      for (unsigned int d = 0; d < dim; ++d)
        x[d] = start + i;
      particles.emplace_back(x, std::pow(20., dim));
    }
  return particles;
}


// Five particles per grid spacing, grown by θ.
TEST_2D_3D(Occupancy, FillsTheInteriorOfAGrownLattice)
{
  const double       h   = 50.;
  const GridBox<dim> box = cube<dim>(8, h);
  for (const double theta : {1., 1.1, 1.2345, 1.4, 1.7})
    {
      SCOPED_TRACE("stretch " + std::to_string(theta));
      const double spacing = theta * h / 5.;
      // Straddles no edge of the box, whatever theta.
      const auto points = lattice_points<dim>(3.4 * h - spacing, spacing);
      const auto occupancy =
        occupancy_of(box, domains_of(points, std::pow(spacing, dim)));
      double volume = 0.;
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
      EXPECT_NEAR(volume / (points.size() * std::pow(spacing, dim)), 1., 1e-9);
    }
}


// A coarse lattice: the quadrature points of the cells' boxes fill in.
TEST_2D_3D(Occupancy, CoarseLatticesHaveInnerGridCells)
{
  const double       h   = 50.;
  const GridBox<dim> box = cube<dim>(16, h);
  for (const double spacing : {60., 75., 110.})
    {
      const auto points = lattice_points<dim>(220., spacing);
      const auto classes =
        classify(occupancy_of(box, domains_of(points, std::pow(spacing, dim))),
                 0.85);
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


TEST_2D_3D(Occupancy, DoesNotDependOnOrderAndRanks)
{
  const unsigned int n_ranks = number_of_ranks();
  const unsigned int rank    = this_rank();
  constexpr double   h = 50., length = 96 * h;
  GridIndex<dim>     first, size;
  first.fill(-12);
  size.fill(24);
  first[0] = -56;
  size[0]  = 112;
  const GridBox<dim>        box(first, size, h, Point<dim>());
  const GridOf<dim>         grid(box);
  const auto                cells   = strange_tissue<dim>(length);
  const auto                alone   = occupancy_of(box, cells);
  const auto                classes = classify(alone, 0.85);
  std::mt19937              generator(5);
  std::vector<unsigned int> order(cells.size());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), generator);
  Particles<dim> mine;
  for (const unsigned int i : order)
    {
      // Most cells are told of by their owner.
      const unsigned int teller =
        i % 50 == 0 ? i % n_ranks : grid.owner(box.locate(cells[i].position()));
      if (teller == rank)
        mine.push_back(cells[i]);
    }
  Occupancy<dim> together(GridWindow<dim>(grid, ranges_of(mine, grid)));
  occupy(together, grid, mine);
  for (const bool wide : {false, true})
    {
      SCOPED_TRACE(wide ? "wide" : "narrow");
      if (wide && n_ranks > 1)
        together.widen(grid, rank % 2 == 1);
      const auto   mine_of_classes = classify(together, 0.85);
      unsigned int n_thin = 0, n_own = 0;
      for (unsigned int number = 0; number < box.size(); ++number)
        if (const auto index = box.index(number);
            together.window().contains(index))
          {
            const unsigned int here = together.window().number(index);
            EXPECT_EQ(alone.fill(number), together.fill(here)); // bitwise
            EXPECT_EQ(alone.n_quadrature_points(number),
                      together.n_quadrature_points(here));
            EXPECT_EQ(alone.bounds(number), together.bounds(here));
            if (together.window().holds(index, reach_of_classes<dim>()))
              {
                EXPECT_EQ(classes[number], mine_of_classes[here]);
                EXPECT_EQ(alone.is_thin(number), together.is_thin(here));
              }
            n_thin += alone.is_thin(number);
            if (grid.owner(index) == rank)
              n_own += alone.fill(number) > 0.;
          }
        else
          {
            EXPECT_FALSE(grid.owner(index) == rank && alone.active(number));
          }
      EXPECT_EQ(together.own().size(), n_own);
      EXPECT_GT(sum_over_ranks(n_thin), 20u);
    }
  for (const ParticleDomain<dim> &domain : mine)
    if (const Point<dim> x = domain.position();
        grid.owner(box.locate(x)) == rank)
      {
        EXPECT_EQ(alone.n_points_per_edge(domain),
                  together.n_points_per_edge(domain));
        EXPECT_EQ(alone.crowded(x), together.crowded(x));
      }
}


TEST_2D_3D(Occupancy, InnerGridCellsAreFullEnough)
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
      EXPECT_EQ(classes[box.number(empty)], GridCellClass::empty);
    }
  // Exactly the threshold is inner.
  EXPECT_EQ(slab_classes<dim>(box, 50. * 1.8, 0.8)[box.number(part)],
            GridCellClass::inner);
  // A sheet of 0.4 grid cells has no fuller neighbour.
  EXPECT_EQ(slab_classes<dim>(box, 50. * 0.4, 0.85)[box.number(full)],
            GridCellClass::inner);
}


TEST_2D_3D(Occupancy, InnerGridCellsHoldEnoughPoints)
{
  const GridBox<dim>   box = cube<dim>(10, 50.);
  const GridIndex<dim> middle{};
  Point<dim>           boundary_point;
  for (unsigned int d = 0; d < dim; ++d)
    boundary_point[d] = -180.;
  const auto class_of_middle = [&](const Particles<dim> &particles) {
    const auto occupancy = occupancy_of(box, particles, {boundary_point});
    const auto classes   = classify(occupancy, 0.01);
    const auto beside    = box.number(box.locate(boundary_point));
    EXPECT_TRUE(occupancy.active(beside));
    EXPECT_EQ(classes[beside], GridCellClass::cut);
    return classes[box.number(middle)];
  };
  // 3^dim points in the grid cell and its neighbours ...
  const unsigned int enough = Utilities::pow(3, dim);
  EXPECT_EQ(class_of_middle(diagonal<dim>(enough, 15.)), GridCellClass::inner);
  EXPECT_EQ(class_of_middle(diagonal<dim>(enough - 1, 15.)),
            GridCellClass::cut);
  // ... of which it holds itself 2^dim, beside a large body.
  const auto body =
    lattice_points<dim>(Point<dim>(), 100., 20., [](const auto &x) {
      return x[0] < 0.;
    });
  const unsigned int few = Utilities::pow(2, dim);
  for (const unsigned int n : {few - 1, few})
    {
      Particles<dim> particles = domains_of(body, std::pow(20., dim));
      for (const auto &particle : diagonal<dim>(n, 30.))
        particles.push_back(particle);
      EXPECT_EQ(class_of_middle(particles),
                n == few ? GridCellClass::inner : GridCellClass::cut);
    }
}


// Thin sheets and small clusters have inner grid cells on one side only of the
// grid line that they stand on.
TEST_2D_3D(Occupancy, ThinTissueHasInnerGridCellsOnOneSideOfAGridLine)
{
  const GridBox<dim> box = cube<dim>(8, 50.);
  for (unsigned int n_thin = 1; n_thin <= dim; ++n_thin)
    {
      SCOPED_TRACE(std::to_string(n_thin) + " thin directions");
      const auto points =
        lattice_points<dim>(Point<dim>(), 150., 5., [&](const auto &x) {
          for (unsigned int d = 0; d < dim; ++d)
            if (std::abs(x[d]) > (d < n_thin ? 15. : 150.))
              return false;
          return true;
        });
      const auto occupancy =
        occupancy_of(box, domains_of(points, std::pow(5., dim)));
      const auto classes = classify(occupancy, 0.85);
      for (unsigned int number = 0; number < box.size(); ++number)
        {
          const GridIndex<dim> index  = box.index(number);
          bool                 tissue = true, first = true;
          for (unsigned int d = 0; d < n_thin; ++d)
            {
              tissue = tissue && (index[d] == -1 || index[d] == 0);
              first  = first && index[d] == -1;
            }
          for (unsigned int d = n_thin; d < dim; ++d)
            tissue = tissue && index[d] >= -3 && index[d] < 3;
          EXPECT_EQ(classes[number],
                    !tissue ? GridCellClass::empty :
                    first   ? GridCellClass::inner :
                              GridCellClass::cut);
          if (tissue)
            {
              EXPECT_NEAR(occupancy.thickness(number), 30., 1e-4);
            }
        }
    }
}


// A sheet of one layer of cells has two points per direction in each.
TEST_2D_3D(Occupancy, CellsOfASingleLayerHaveSeveralPoints)
{
  const GridBox<dim> box = cube<dim>(8, 50.);
  for (const unsigned int n_layers : {1u, 2u})
    {
      const auto points =
        lattice_points<dim>(Point<dim>(), 150., 10., [&](const auto &x) {
          return x[0] > 0. && x[0] < 10. * n_layers && std::abs(x[1]) < 150. &&
                 std::abs(x[dim - 1]) < 150.;
        });
      const double V         = std::pow(10., dim);
      const auto   occupancy = occupancy_of(box, domains_of(points, V));
      typename ParticleDomain<dim>::Numbers expected;
      expected.fill(n_layers == 1 ? 2 : 1);
      EXPECT_EQ(occupancy.n_points_per_edge({points.front(), V}), expected);
      EXPECT_EQ(occupancy.n_quadrature_points(box.number(GridIndex<dim>{})),
                n_layers * Utilities::pow(5, dim - 1) *
                  (n_layers == 1 ? Utilities::pow(2, dim) : 1));
    }
}
