// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "particles/room.h"

template <int dim>
std::vector<Point<dim>>
random_box(const unsigned int n, const unsigned int seed)
{
  std::mt19937                           generator(seed);
  std::uniform_real_distribution<double> uniform(0., 1.);
  const double            edge = std::pow(n, 1. / dim); // one a unit volume
  std::vector<Point<dim>> points(n);
  for (Point<dim> &x : points)
    for (unsigned int d = 0; d < dim; ++d)
      x[d] = edge * uniform(generator);
  return points;
}

template <int dim>
std::vector<types::particle_index>
numbered(const std::vector<Point<dim>> &points)
{
  std::vector<types::particle_index> ids(points.size());
  for (unsigned int i = 0; i < ids.size(); ++i)
    ids[i] = i;
  return ids;
}

template <int dim>
double
depth_in_box(const Point<dim> &x, const double edge)
{
  double depth = edge;
  for (unsigned int d = 0; d < dim; ++d)
    depth = std::min({depth, x[d], edge - x[d]});
  return depth;
}

/** The mean number of Delaunay neighbours inside. */
template <int dim>
double
mean_degree(const unsigned int n)
{
  const auto                points = random_box<dim>(n, 11);
  const double              edge   = std::pow(n, 1. / dim);
  std::vector<unsigned int> degree(n, 0);
  for (const VoronoiFacet &facet :
       voronoi_facets(points, numbered(points), 1e9, 30.))
    ++degree[facet.a], ++degree[facet.b];
  double sum = 0., count = 0.;
  for (unsigned int i = 0; i < n; ++i)
    if (depth_in_box(points[i], edge) > 4.)
      sum += degree[i], ++count;
  return sum / count;
}

/** A tissue of cells of unit volume scaled to spacing 10, with a surface at
 *  some places. */
template <int dim>
std::unique_ptr<Tissue<dim>>
tissue_of(const std::vector<Point<dim>> &points,
          const std::vector<Point<dim>> &surface = {})
{
  auto tissue = std::make_unique<Tissue<dim>>(grid_of_spacing(30.),
                                              CellColumns<dim>(),
                                              MPI_COMM_WORLD);
  const BoundaryColumns<dim> of_surface;
  PointList<dim>             patches(of_surface.n_numbers());
  for (const Point<dim> &x : surface)
    patches.add(patches.size(),
                x,
                of_surface.initial_point(x,
                                         Point<dim>::unit_vector(0),
                                         std::pow(10., dim - 1),
                                         SurfaceCondition::free));
  tissue->place(dealt(cells_at(points, std::pow(10., dim))), dealt(patches));
  return tissue;
}

/** All edges of all ranks, by ids, with their areas. */
template <int dim>
std::map<std::pair<types::particle_index, types::particle_index>, double>
all_edges(const Tissue<dim> &tissue, const NeighbourSearch &search)
{
  PointList<dim> cells;
  for (unsigned int p = 0; p < tissue.cells().size(); ++p)
    cells.add(tissue.cells().id(p), tissue.cells().position(p), {});
  const NeighbourGraph<dim> graph = neighbours(tissue, cells, search);
  using Edges =
    std::map<std::pair<types::particle_index, types::particle_index>, double>;
  Edges mine, all;
  for (unsigned int p = 0; p < graph.n_own; ++p)
    graph.for_neighbours(p, [&](const auto &e) {
      mine[{graph.points.ids[p], graph.points.ids[e.other]}] = e.area;
    });
  for (const Edges &part : Utilities::MPI::all_gather(MPI_COMM_WORLD, mine))
    all.insert(part.begin(), part.end());
  return all;
}

/** The same tissue, found by one triangulation of all points. */
template <int dim>
void
check_edges(std::vector<Point<dim>> points)
{
  for (Point<dim> &x : points)
    x *= 10.;
  const auto tissue = tissue_of(points);
  const auto edges  = all_edges(*tissue, {true, 1.8});
  std::map<std::pair<types::particle_index, types::particle_index>, double>
       expected;
  auto shuffled = numbered(points);
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(4));
  std::vector<Point<dim>> places;
  for (const auto id : shuffled)
    places.push_back(points[id]);
  // The root of the mean volume is 10 but for rounding.
  const double a    = std::pow(std::pow(10., dim), 1. / dim);
  const double face = std::pow(a, dim - 1);
  for (const VoronoiFacet &facet :
       voronoi_facets(places, shuffled, 3. * a, 1.5 * a))
    if (facet.area >= 0.02 * dim * face)
      {
        const auto i = shuffled[facet.a], j = shuffled[facet.b];
        expected[{i, j}] = expected[{j, i}] = facet.area;
      }
  // The same edges and areas. Where facets are cut, far points of the whole
  // tissue leave their rounding.
  EXPECT_EQ(edges.size(), expected.size());
  for (const auto &[pair, area] : expected)
    {
      const auto found = edges.find(pair);
      EXPECT_TRUE(found != edges.end() &&
                  std::abs(found->second - area) < 1e-11 * face)
        << pair.first << ' ' << pair.second << ": " << area << ", found "
        << (found == edges.end() ? 0. : found->second) << "; at "
        << points[pair.first] << ", " << points[pair.second];
    }
}

/** Two blocks whose outermost layers are @p distance apart: how many pairs
 *  of them have a cell in each. */
template <int dim>
unsigned int
pairs_across(const double distance, const bool has_surface)
{
  std::vector<Point<dim>> points, surface;
  for (const Point<dim> &x : lattice_points<dim>(30., 10.))
    {
      Point<dim> y = x;
      y[0] += x[0] > 0. ? 0.5 * distance - 5. : 5. - 0.5 * distance;
      points.push_back(y);
      if (std::abs(std::abs(x[0]) - 5.) < 1e-6)
        {
          y[0] += x[0] > 0. ? -5. : 5.;
          surface.push_back(y);
        }
    }
  if (!has_surface)
    surface.clear();
  unsigned int n = 0;
  for (const auto &[pair, area] :
       all_edges(*tissue_of(points, surface), {true, 1.8}))
    n += points[pair.first][0] < 0. && points[pair.second][0] > 0.;
  return n;
}


TEST(VoronoiFacets, HaveTheMeanDegreesOfPoissonPoints)
{
  ONE_RANK_IS_ENOUGH();
  // 48 π²/35 + 2 and 6
  EXPECT_NEAR(mean_degree<3>(60000), 15.535, 0.06);
  EXPECT_NEAR(mean_degree<2>(60000), 6., 0.01);
}

// Σ S (x_q - x_p)/l = 0 and Σ S l = 2 d V of closed polyhedra; the volumes
// inside add up.
TEST_2D_3D(VoronoiFacets, CloseEachCell)
{
  const auto                  points = random_box<dim>(3000, 2);
  std::vector<Tensor<1, dim>> closure(points.size());
  std::vector<double>         size(points.size(), 0.);
  std::vector<double>         volume(points.size(), 0.);
  for (const VoronoiFacet &facet :
       voronoi_facets(points, numbered(points), 1e9, 30.))
    {
      const Tensor<1, dim> n =
        (points[facet.b] - points[facet.a]) / facet.distance;
      closure[facet.a] += facet.area * n;
      closure[facet.b] -= facet.area * n;
      for (const unsigned int i : {facet.a, facet.b})
        {
          size[i] += facet.area;
          volume[i] += facet.area * facet.distance / (2. * dim);
        }
    }
  const double edge = std::pow(3000., 1. / dim);
  double       sum = 0., count = 0.;
  for (unsigned int i = 0; i < points.size(); ++i)
    if (depth_in_box(points[i], edge) > 3.)
      {
        EXPECT_LT(closure[i].norm(), 1e-9 * size[i]);
        sum += volume[i];
        ++count;
      }
  // One point a unit volume; the spread of a mean of Poisson's cells.
  EXPECT_NEAR(sum / count, 1., 3. * 0.55 / std::sqrt(count));
}

TEST_2D_3D(Neighbours, OnLatticesAreThoseThatTouch)
{
  std::vector<Point<dim>> points = lattice_points<dim>(4., 1.);
  check_edges<dim>(points);
  for (Point<dim> &x : points)
    x *= 10.;
  const auto edges = all_edges(*tissue_of(points), {true, 1.8});
  for (unsigned int i = 0; i < points.size(); ++i)
    {
      double reach = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        reach = std::max(reach, std::abs(points[i][d]));
      unsigned int degree = 0;
      for (unsigned int j = 0; j < points.size(); ++j)
        degree += edges.count({i, j});
      if (reach < 30.)
        {
          EXPECT_EQ(degree, 2u * dim);
        }
    }
}

TEST_2D_3D(Neighbours, DoNotDependOnRanksAndOrder)
{
  check_edges<dim>(random_box<dim>(1500, 3));
}

// doc/theory.md, section 12.1.
TEST_2D_3D(Neighbours, AcrossAGapAreThoseWithinReach)
{
  const unsigned int layer = Utilities::fixed_power<dim - 1>(7u);
  EXPECT_EQ(pairs_across<dim>(17., true), layer) << "within reach";
  EXPECT_EQ(pairs_across<dim>(19., true), 0u) << "the surface is between";
  EXPECT_EQ(pairs_across<dim>(28., true), 0u) << "the surface is between";
  EXPECT_EQ(pairs_across<dim>(19., false), layer) << "in full tissue";
  EXPECT_EQ(pairs_across<dim>(31., false), 0u) << "beyond the ring";
}

TEST_2D_3D(Neighbours, ByRadiusAreThoseWithinIt)
{
  std::vector<Point<dim>> points = random_box<dim>(700, 3);
  for (Point<dim> &x : points)
    x *= 10.;
  const auto  edges = all_edges(*tissue_of(points), {false, 1.5});
  std::size_t n     = 0;
  for (unsigned int i = 0; i < points.size(); ++i)
    for (unsigned int j = 0; j < points.size(); ++j)
      if (i != j && points[i].distance(points[j]) <= 15.)
        {
          ++n;
          EXPECT_EQ(edges.count({i, j}), 1u);
        }
  EXPECT_EQ(edges.size(), n);
}

TEST(Neighbours, DegenerateListsHaveNoFacets)
{
  EXPECT_TRUE(voronoi_facets<2>({}, {}, 1., 1.).empty());
  EXPECT_TRUE(
    voronoi_facets<3>({Point<3>(), Point<3>(1., 0., 0.)}, {0, 1}, 2., 2.)
      .empty());
}
