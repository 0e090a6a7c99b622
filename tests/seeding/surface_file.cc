// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "seeding/room.h"

/** An OFF file of a cube in a cube around the origin, um. */
std::string
hollow_cube(const double outer, const double inner)
{
  const auto centered = [](const double edge) {
    return cube(Point<3>(-0.5 * edge, -0.5 * edge, -0.5 * edge), edge);
  };
  Polygons hollow = centered(outer);
  hollow.append(centered(inner));
  return hollow.off();
}

std::string
hollow_square(const double outer, const double inner)
{
  const auto ring = [](const double edge) {
    std::ostringstream text;
    const double       a = edge / 2.;
    text << '(' << -a << ' ' << -a << ", " << a << ' ' << -a << ",\n " << a
         << ' ' << a << ", " << -a << ' ' << a << ", " << -a << ' ' << -a
         << ')';
    return text.str();
  };
  return "POLYGON(" + ring(outer) + ',' + ring(inner) + ")\n";
}

/** All ranks' patches around cells on a lattice of 10 um, half of one from
 *  the axes, of which some are left out around the origin. */
template <int dim>
SurfacePatches<dim>
surface(const std::string &file, const double hole, const MPI_Comm comm)
{
  std::vector<Point<dim>> cells;
  for (int i = 0; i < Utilities::pow(6, dim); ++i)
    {
      Point<dim> x;
      double     farthest = 0.;
      for (unsigned int d = 0, rest = i; d < dim; ++d, rest /= 6)
        {
          x[d]     = 10. * (rest % 6) - 25.;
          farthest = std::max(farthest, std::abs(x[d]));
        }
      if (farthest > hole)
        cells.push_back(x);
    }
  const auto [begin, end] = share(cells.size(), comm);
  Founders<dim> mine;
  mine.n_global = cells.size();
  mine.positions.assign(cells.begin() + begin, cells.begin() + end);
  mine.volumes.assign(end - begin, Utilities::fixed_power<dim>(10.));
  TissueParameters parameters;
  parameters.shape          = "points";
  parameters.points_surface = file;
  return seed_points_surface(parameters, GridParameters(), mine, comm);
}

/** Checks the sums over all ranks: areas times normals add up to nothing, the
 *  volume is that of the file's surface, and so is the cavity's. */
template <int dim>
void
expect_hollow(const SurfacePatches<dim> &patches)
{
  Tensor<1, dim> vector;
  double         volume = 0., cavity = 0.;
  for (std::size_t i = 0; i < patches.areas.size(); ++i)
    {
      const Tensor<1, dim> area = patches.areas[i] * patches.normals[i];
      const double         part = area * patches.positions[i] / dim;
      vector += area;
      volume += part;
      if (part < 0.)
        cavity -= part;
    }
  EXPECT_LT(sum_over_ranks(vector).norm(), 1e-9);
  const double hole = Utilities::fixed_power<dim>(20.);
  EXPECT_NEAR(sum_over_ranks(cavity), hole, 1e-6);
  EXPECT_NEAR(sum_over_ranks(volume),
              Utilities::fixed_power<dim>(60.) - hole,
              1e-6);
}


TEST(SurfaceFile, MeshWithCavity)
{
  const TemporaryFile file(".off", hollow_cube(60., 20.));
  const auto          patches = surface<3>(file.path, 10., MPI_COMM_WORLD);
  expect_hollow(patches);
  EXPECT_EQ(patches.n_global,
            surface<3>(file.path, 10., MPI_COMM_SELF).n_global);
}


TEST(SurfaceFile, PolygonWithCavity)
{
  const TemporaryFile file(".wkt", hollow_square(60., 20.));
  const auto          patches = surface<2>(file.path, 10., MPI_COMM_WORLD);
  expect_hollow(patches);
  EXPECT_EQ(patches.n_global, 32u); // one for 10 um
}


TEST(SurfaceFile, CountsCellsOutside)
{
  const TemporaryFile mesh(".off", hollow_cube(60., 20.));
  const TemporaryFile polygon(".wkt", hollow_square(60., 20.));
  expect_parts(complaint_of([&] { surface<3>(mesh.path, 0., MPI_COMM_WORLD); }),
               {"8 of 216 cells lie outside"});
  expect_parts(complaint_of(
                 [&] { surface<2>(polygon.path, 0., MPI_COMM_WORLD); }),
               {"4 of 36 cells lie outside"});
}
