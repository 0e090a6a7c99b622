// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "seeding/room.h"

Polygons
reversed(Polygons polygons)
{
  for (auto &face : polygons.faces)
    std::reverse(face.begin(), face.end());
  return polygons;
}

double
volume(const std::vector<SurfaceTriangle> &triangles)
{
  double sum = 0.;
  for (const SurfaceTriangle &t : triangles)
    sum += t.vertices[0] * area_vector(t.vertices) / 3.;
  return sum;
}

double
volume_of(const TemporaryFile &file)
{
  return volume(SurfaceMesh("Tissue/Surface mesh", file.path).triangles());
}

/** Why a mesh is refused; empty if it is not. */
std::string
refusal(const std::string &content, const std::string &ending = ".off")
{
  const TemporaryFile file(ending, content);
  return complaint_of(
    [&] { SurfaceMesh mesh("Tissue/Surface mesh", file.path); });
}


struct MeshSums
{
  double       area = 0., volume = 0., smallest = 1e300, largest = 0.;
  Tensor<1, 3> vector;
};

MeshSums
sums(const std::vector<SurfacePatch<3>> &patches)
{
  MeshSums sums;
  for (const SurfacePatch<3> &patch : patches)
    {
      EXPECT_NEAR(patch.normal.norm(), 1., 1e-14);
      sums.area += patch.area;
      sums.vector += patch.area * patch.normal;
      sums.volume += patch.area * (patch.position * patch.normal) / 3.;
      sums.smallest = std::min(sums.smallest, patch.area);
      sums.largest  = std::max(sums.largest, patch.area);
    }
  return sums;
}

/** Checks that the patches are those of a cube with an edge of 200 um. */
MeshSums
sums_of_cube(const std::vector<SurfacePatch<3>> &patches)
{
  const MeshSums total = sums(patches);
  EXPECT_NEAR(total.area / 240000., 1., 1e-12);
  EXPECT_LT(total.vector.norm() / 240000., 1e-12);
  EXPECT_NEAR(total.volume / 8e6, 1., 1e-12);
  return total;
}

/** One square face cut into a grid of triangles; the cube of such faces. */
Polygons
fine_cube(const double edge, const unsigned int n)
{
  Polygons                                            result;
  std::map<std::array<unsigned int, 3>, unsigned int> numbers;
  const auto number = [&](const std::array<unsigned int, 3> &i) {
    const auto [place, is_new] = numbers.emplace(i, result.points.size());
    if (is_new)
      result.points.push_back(
        Point<3>(edge * i[0] / n, edge * i[1] / n, edge * i[2] / n));
    return place->second;
  };
  for (unsigned int d = 0; d < 3; ++d)
    for (const unsigned int side : {0u, n})
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
          {
            const auto corner = [&](const unsigned int k,
                                    const unsigned int l) {
              std::array<unsigned int, 3> index;
              index[d]           = side;
              index[(d + 1) % 3] = k;
              index[(d + 2) % 3] = l;
              return number(index);
            };
            const unsigned int a = corner(i, j), b = corner(i + 1, j),
                               c = corner(i + 1, j + 1), e = corner(i, j + 1);
            result.faces.push_back({a, b, c});
            result.faces.push_back({a, c, e});
          }
  return result; // sides of d = 0 wind inward: reading puts that right
}

TEST(SurfaceMesh, CubeOfPolygons)
{
  const TemporaryFile file(".off", cube(Point<3>(-1., 2., 3.), 4.).off());
  const SurfaceMesh   mesh("Tissue/Surface mesh", file.path);
  EXPECT_EQ(mesh.triangles().size(), 12u);
  EXPECT_NEAR(volume(mesh.triangles()), 64., 1e-12);
  EXPECT_EQ(mesh.bounding_box(),
            BoundingBox<3>({Point<3>(-1., 2., 3.), Point<3>(3., 6., 7.)}));
  EXPECT_TRUE(mesh.contains(Point<3>(0., 3., 4.), 0.5));
  EXPECT_TRUE(mesh.contains(Point<3>(-1. + 2e-8, 3., 4.), 1e-8));
  EXPECT_FALSE(mesh.contains(Point<3>(-1. + 0.5e-8, 3., 4.), 1e-8));
  EXPECT_FALSE(mesh.contains(Point<3>(-1., 3., 4.), 0.));
  EXPECT_FALSE(mesh.contains(Point<3>(-2., 3., 4.), 1e-8));
  for (const SurfaceTriangle &t : mesh.triangles())
    for (unsigned int i = 0; i < 3; ++i)
      {
        // both ends of the edge are the neighbour's, too
        const auto &other = mesh.triangles().at(t.neighbors[i]).vertices;
        EXPECT_EQ(std::count(other.begin(), other.end(), t.vertices[i]), 1);
        EXPECT_EQ(
          std::count(other.begin(), other.end(), t.vertices[(i + 1) % 3]), 1);
      }
}

TEST(SurfaceMesh, OrientationIsMadeOutward)
{
  const TemporaryFile inward(".off", reversed(cube({}, 2.)).off());
  EXPECT_NEAR(volume_of(inward), 8., 1e-12);

  Polygons mixed = cube({}, 2.);
  std::reverse(mixed.faces[3].begin(), mixed.faces[3].end());
  const TemporaryFile file(".off", mixed.off());
  EXPECT_NEAR(volume_of(file), 8., 1e-12);
}

TEST(SurfaceMesh, CavitiesAndSeveralBodies)
{
  Polygons bodies = cube({}, 4.);
  bodies.append(cube(Point<3>(1., 1., 1.), 2.));
  bodies.append(cube(Point<3>(10., 0., 0.), 1.));
  const TemporaryFile file(".off", bodies.off());
  const SurfaceMesh   mesh("Tissue/Surface mesh", file.path);
  EXPECT_NEAR(volume(mesh.triangles()), 64. - 8. + 1., 1e-12);
  EXPECT_TRUE(mesh.contains(Point<3>(0.5, 2., 2.), 1e-9));
  EXPECT_FALSE(mesh.contains(Point<3>(2., 2., 2.), 1e-9));
  EXPECT_FALSE(mesh.contains(Point<3>(7., 0.5, 0.5), 1e-9));
  EXPECT_TRUE(mesh.contains(Point<3>(10.5, 0.5, 0.5), 1e-9));
}


TEST(SurfaceMesh, RefusesWhatHasNoInside)
{
  EXPECT_EQ(refusal(cube({}, 2.).off()), "");

  Polygons open = cube({}, 2.);
  open.faces.pop_back();
  expect_parts(refusal(open.off()), {"open: the edge"});

  Polygons fin = cube({}, 2.);
  fin.points.push_back(Point<3>(3., 3., 3.));
  fin.faces.push_back({0, 1, 8});
  expect_parts(refusal(fin.off()), {"non-manifold: the edge"});

  Polygons wall = cube({}, 2.); // a neighbour shares a face: a wall inside
  Polygons next = cube(Point<3>(2., 0., 0.), 2.);
  wall.append(next);
  expect_parts(refusal(wall.off()), {"non-manifold: the edge"});

  Polygons touching = cube({}, 2.);
  touching.append(cube(Point<3>(2., 2., 2.), 2.));
  expect_parts(refusal(touching.off()), {"touches itself"});
}


TEST(MeshPatches, LargeTrianglesAreCut)
{
  const TemporaryFile file(".off", cube({}, 200.).off());
  const SurfaceMesh   mesh("Tissue/Surface mesh", file.path);
  for (const unsigned int n : {12u, 13u, 100u, 2904u, 10000u})
    {
      const auto patches = cut_into_patches(mesh.triangles(), n);
      EXPECT_EQ(patches.size(), n);
      const MeshSums total = sums_of_cube(patches);
      if (n >= 100)
        {
          EXPECT_LT(total.largest, 1.2 * total.smallest);
        }
    }
}

TEST(MeshPatches, SmallTrianglesAreMergedButNotAcrossEdges)
{
  const TemporaryFile file(".off", fine_cube(200., 30).off());
  const SurfaceMesh   mesh("Tissue/Surface mesh", file.path);
  EXPECT_NEAR(volume(mesh.triangles()) / 8e6, 1., 1e-12);
  for (const unsigned int n : {6u, 60u, 600u, 2904u})
    {
      const auto patches = cut_into_patches(mesh.triangles(), n);
      EXPECT_EQ(patches.size(), n);
      const MeshSums total = sums_of_cube(patches);
      EXPECT_LT(total.largest, 4. * total.smallest);
      for (const SurfacePatch<3> &patch : patches)
        {
          // on one face, off the edges
          unsigned int n_faces = 0;
          for (unsigned int d = 0; d < 3; ++d)
            n_faces +=
              std::abs(std::abs(patch.position[d] - 100.) - 100.) < 0.5;
          EXPECT_EQ(n_faces, 1u);
        }
    }
  // not fewer than faces
  EXPECT_EQ(cut_into_patches(mesh.triangles(), 1).size(), 6u);
}

TEST(MeshPatches, SphereIsFollowed)
{
  const TemporaryFile file(".off", sphere(250., 5).off());
  const SurfaceMesh   mesh("Tissue/Surface mesh", file.path);
  const double        exact = volume(mesh.triangles());
  double              area  = 0.;
  for (const SurfaceTriangle &t : mesh.triangles())
    area += area_vector(t.vertices).norm();

  for (const unsigned int n : {160u, 640u, 2560u})
    {
      const auto patches = cut_into_patches(mesh.triangles(), n);
      EXPECT_EQ(patches.size(), n);
      const MeshSums total = sums(patches);
      EXPECT_NEAR(total.area / area, 1., 1e-12);
      EXPECT_LT(total.vector.norm() / area, 0.2 / n);
      // the sagitta of a patch against the radius
      EXPECT_NEAR(total.volume / exact, 1., numbers::PI / (2. * n));
      for (const SurfacePatch<3> &patch : patches)
        {
          EXPECT_NEAR(patch.position.norm(), 250., 0.5);
          EXPECT_GT(patch.normal * patch.position / patch.position.norm(),
                    0.995);
        }
    }
}

TEST(MeshSeeding, IsTheSameForAnyNumberOfRanks)
{
  const TemporaryFile file(".off", cube(Point<3>(-50., -50., 7.), 100.).off());
  TissueParameters    parameters;
  parameters.shape           = "mesh";
  parameters.surface_mesh    = file.path;
  parameters.center          = {0., 0., 2.};
  parameters.boundary_points = 600;
  parameters.surface_cells   = "whole";
  parameters.check(3);

  const auto mine  = seed_founders<3>(parameters, MPI_COMM_WORLD);
  const auto alone = seed_founders<3>(parameters, MPI_COMM_SELF);
  // z = 7 is on a layer of the lattice, and so is z = 107
  EXPECT_EQ(alone.n_global, 900u);
  EXPECT_EQ(mine.n_global, 900u);
  EXPECT_LT(alone.positions[0].distance(Point<3>(-45., -45., 17.)), 1e-12);
  for (std::size_t i = 0; i < mine.positions.size(); ++i)
    ASSERT_EQ(mine.positions[i], alone.positions.at(mine.first_id + i));

  const auto surface       = seed_surface<3>(parameters, MPI_COMM_WORLD);
  const auto surface_alone = seed_surface<3>(parameters, MPI_COMM_SELF);
  EXPECT_EQ(surface.n_global, 600u);
  EXPECT_EQ(sum_over_ranks(surface.areas.size()), 600u);
  for (std::size_t i = 0; i < surface.areas.size(); ++i)
    {
      ASSERT_EQ(surface.positions[i],
                surface_alone.positions.at(surface.first_id + i));
      ASSERT_EQ(surface.areas[i], surface_alone.areas[surface.first_id + i]);
    }

  parameters.cell_spacing = 150.;
  EXPECT_THROW(seed_founders<3>(parameters, MPI_COMM_WORLD), InputError);
}
