// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "effects/division/dividing_tissue.h"

using namespace Morula;

namespace
{
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

  Kernel::Point_2
  convert(const Point<2> &p)
  {
    return {p[0], p[1]};
  }

  Kernel::Point_3
  convert(const Point<3> &p)
  {
    return {p[0], p[1], p[2]};
  }

  template <typename VertexHandle>
  std::vector<VertexHandle>
  neighbours(const CGAL::Delaunay_triangulation_2<Kernel> &delaunay,
             const VertexHandle                            vertex)
  {
    std::vector<VertexHandle> result;
    if (delaunay.number_of_vertices() < 2)
      return result;
    auto       circulator = delaunay.incident_vertices(vertex);
    const auto start      = circulator;
    do
      result.push_back(circulator);
    while (++circulator != start);
    return result;
  }

  template <typename VertexHandle>
  std::vector<VertexHandle>
  neighbours(const CGAL::Delaunay_triangulation_3<Kernel> &delaunay,
             const VertexHandle                            vertex)
  {
    std::vector<VertexHandle> result;
    delaunay.adjacent_vertices(vertex, std::back_inserter(result));
    return result;
  }

  template <int dim>
  struct Delaunay;

  template <>
  struct Delaunay<2>
  {
    using type = CGAL::Delaunay_triangulation_2<Kernel>;
  };

  template <>
  struct Delaunay<3>
  {
    using type = CGAL::Delaunay_triangulation_3<Kernel>;
  };

  /**
   * The distances from the full Voronoi diagram: the region of a cell is the
   * intersection of the half-spaces towards its Delaunay neighbours. Neither
   * Dirichlet walls nor coincident cells.
   */
  template <int dim>
  std::vector<Distances>
  from_diagram(const DividingTissue<dim> &tissue)
  {
    typename Delaunay<dim>::type delaunay;
    for (const Point<dim> &p : tissue.positions)
      delaunay.insert(convert(p));

    std::vector<Distances> result;
    for (const DividingCell<dim> &cell : tissue.dividing)
      {
        const auto vertex = delaunay.nearest_vertex(convert(cell.position));
        Distances  wall{{infinity, infinity}};
        for (const auto &neighbour : neighbours(delaunay, vertex))
          if (!delaunay.is_infinite(neighbour))
            {
              Point<dim> q;
              for (unsigned int d = 0; d < dim; ++d)
                q[d] = neighbour->point()[d];
              // The bisector: x with (x - (p+q)/2)·(q-p) = 0.
              const Tensor<1, dim> normal = q - cell.position;
              const Tensor<1, dim> middle =
                0.5 * (Tensor<1, dim>(q) - Tensor<1, dim>(cell.position));
              for (const unsigned int side : {0, 1})
                {
                  const double slope =
                    (side == 0 ? -1. : 1.) * (cell.axis * normal);
                  if (slope > 0.)
                    wall[side] =
                      std::min(wall[side], (middle * normal) / slope);
                }
            }
        for (double &distance : wall)
          if (distance > cell.length)
            distance = infinity;

        const double nearer = std::min(wall[0], wall[1]);
        for (double &distance : wall)
          distance = std::isfinite(distance) ? distance / 2. :
                     std::isfinite(nearer)   ? nearer / 2. :
                                               cell.length / 4.;
        result.push_back(wall);
      }
    return result;
  }

  template <int dim>
  void
  expect_like_diagram(const DividingTissue<dim> &tissue)
  {
    const auto result = tissue.distances();
    const auto oracle = from_diagram(tissue);
    ASSERT_EQ(result.size(), tissue.dividing.size());
    for (unsigned int i = 0; i < result.size(); ++i)
      for (const unsigned int side : {0, 1})
        EXPECT_NEAR(result[i][side],
                    oracle[i][side],
                    1e-12 * tissue.dividing[i].length)
          << "cell " << i << ", side " << side;
  }

  /** Random points, all dividing: includes the cells at the surface. */
  template <int dim>
  DividingTissue<dim>
  random_tissue(const unsigned int n, const unsigned int seed)
  {
    std::mt19937            generator(seed);
    std::vector<Point<dim>> points;
    for (unsigned int i = 0; i < n; ++i)
      points.push_back(random_point<dim>(generator, 10.));
    DividingTissue<dim>                    tissue(points);
    std::uniform_real_distribution<double> length(0.7, 1.5);
    for (unsigned int i = 0; i < n; ++i)
      tissue.divide(i,
                    random_axis<dim>(generator),
                    10. * std::pow(n, -1. / dim) * length(generator));
    return tissue;
  }
} // namespace


TEST(WallDistance, RandomPoints)
{
  expect_like_diagram(random_tissue<2>(500, 1));
  expect_like_diagram(random_tissue<3>(1500, 2));
}


// Along a lattice direction all daughters of a cube stand a quarter spacing
// from their mothers: inside, and by (19) at the surface.
TEST(WallDistance, LatticeDirections)
{
  DividingTissue<3> cube(lattice<3>(5));
  for (unsigned int i = 0; i < cube.ids.size(); ++i)
    cube.divide(i, Tensor<1, 3>({0., 0., 1.}), 1.);
  for (const Distances &d : cube.distances())
    EXPECT_EQ(d, (Distances{{0.25, 0.25}}));

  // Along the diagonal of the middle cell: the corner of its region.
  DividingTissue<3> diagonal(lattice<3>(3));
  diagonal.divide(13, Tensor<1, 3>({1., 1., 1.}), 1.);
  const Distances corner = diagonal.distances()[0];
  for (const double d : corner)
    EXPECT_NEAR(d, std::sqrt(3.) / 4., 1e-15);
}


TEST(WallDistance, AbsentWalls)
{
  // A lone cell: equation (20).
  DividingTissue<3> lone({Point<3>(1., 2., 3.)});
  lone.divide(0, Tensor<1, 3>({1., 2., 2.}), 8.);
  EXPECT_EQ(lone.distances()[0], (Distances{{2., 2.}}));

  // One neighbour: equation (19), until its wall is farther than the length.
  for (const double x : {1., 3.999, 4.001})
    for (const int sign : {-1, 1})
      {
        DividingTissue<3> two({Point<3>(), Point<3>(x, 0., 0.)});
        two.divide(0, Tensor<1, 3>({1. * sign, 0., 0.}), 2.);
        const double expected = x < 4. ? x / 4. : 0.5;
        EXPECT_EQ(two.distances()[0], (Distances{{expected, expected}}));
      }

  // Two unequal neighbours.
  DividingTissue<2> three({Point<2>(), Point<2>(1., 0.), Point<2>(-3., 0.)});
  three.divide(0, Tensor<1, 2>({1., 0.}), 2.);
  EXPECT_EQ(three.distances()[0], (Distances{{0.75, 0.25}}));

  EXPECT_TRUE(DividingTissue<2>({Point<2>()}).distances().empty());
}


TEST(WallDistance, CollinearPoints)
{
  std::vector<Point<3>> points;
  for (const double x : {0., 1., 1.5, 3.5, 4., 7.})
    points.emplace_back(x, 2. * x, 0.);
  DividingTissue<3> line(points);
  for (unsigned int i = 0; i < points.size(); ++i)
    {
      line.divide(i, Tensor<1, 3>({1., 2., 0.}), 20.);
      line.divide(i, Tensor<1, 3>({1., 1., 1.}), 20.);
      line.divide(i, Tensor<1, 3>({2., -1., 0.}), 20.);
    }
  expect_like_diagram(line);
  // Across the line there is no wall.
  EXPECT_EQ(line.distances()[2], (Distances{{5., 5.}}));
}


TEST(WallDistance, CoincidentCells)
{
  // A second cell at, or within 1e-3 lengths of the first bounds nothing.
  for (const double gap : {0., 1e-12, 0.999e-3})
    {
      DividingTissue<2> pair({Point<2>(), Point<2>(gap, 0.), Point<2>(2., 0.)});
      pair.divide(0, Tensor<1, 2>({1., 0.}), 1.);
      EXPECT_EQ(pair.distances()[0], (Distances{{0.5, 0.5}})) << gap;
    }

  // A little farther away it does; the daughters keep their distance.
  DividingTissue<2> pair({Point<2>(), Point<2>(2e-3, 0.)});
  pair.divide(0, Tensor<1, 2>({1., 0.}), 1.);
  EXPECT_EQ(pair.distances()[0], (Distances{{5e-4, 5e-4}}));

  // However dense the cluster: not below a quarter of the contact distance.
  std::mt19937          generator(8);
  std::vector<Point<3>> points;
  for (unsigned int i = 0; i < 2000; ++i)
    points.push_back(random_point<3>(generator, 5e-3));
  DividingTissue<3> cluster(points);
  for (unsigned int i = 0; i < points.size(); ++i)
    cluster.divide(i, random_axis<3>(generator), 1.);
  for (const Distances &d : cluster.distances())
    {
      EXPECT_GE(d[0], 2.5e-4);
      EXPECT_GE(d[1], 2.5e-4);
    }
}


// A cell that appears twice, here and as a copy from another rank.
TEST(WallDistance, CopiesOfACellAreTheCell)
{
  DividingTissue<2> tissue({Point<2>(), Point<2>(1., 0.)});
  tissue.divide(0, Tensor<1, 2>({1., 0.}), 1.);
  tissue.ids.push_back(tissue.ids[0]);
  tissue.positions.emplace_back(0.1, 0.);
  EXPECT_EQ(tissue.distances()[0], (Distances{{0.25, 0.25}}));
}
