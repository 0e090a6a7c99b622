// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/seeding/seeding.h>

#include <gtest/gtest.h>

#include "common/complaint.h"
#include "common/temporary_file.h"

using namespace Morula;

namespace
{
  /** The message with which the parameters are refused; empty if not. */
  std::string
  refusal(const TissueParameters &parameters, const unsigned int dim = 3)
  {
    return complaint_of([&] { parameters.check(dim); });
  }

  /** The refusal after changing the defaults. */
  template <typename Change>
  std::string
  refusal_after(const Change &change, const unsigned int dim = 3)
  {
    TissueParameters parameters;
    change(parameters);
    return refusal(parameters, dim);
  }

  bool
  starts_with(const std::string &text, const std::string &start)
  {
    return text.compare(0, start.size(), start) == 0;
  }
} // namespace

TEST(TissueParameters, DeclaresTheContract)
{
  TissueParameters parameters;
  ParameterHandler prm;
  parameters.declare(prm);
  prm.enter_subsection("Tissue");
  EXPECT_EQ(prm.get("Shape"), "sphere");
  EXPECT_EQ(prm.get("Center"), "0, 0, 0");
  EXPECT_EQ(prm.get("Radius"), "250");
  EXPECT_EQ(prm.get("Size"), "200, 200, 200");
  EXPECT_EQ(prm.get("Surface mesh"), "");
  EXPECT_EQ(prm.get("Points file"), "");
  EXPECT_EQ(prm.get("Cell spacing"), "10");
  EXPECT_EQ(prm.get("Lattice offset"), "0, 0, 0");
  EXPECT_EQ(prm.get("Boundary points"), "0");

  prm.set("Shape", "box");
  prm.set("Size", "10, 20, 30");
  prm.set("Boundary points", "2904");
  EXPECT_EQ(parameters.shape, "box");
  EXPECT_EQ(parameters.size, (std::vector<double>{10., 20., 30.}));
  EXPECT_EQ(parameters.boundary_points, 2904u);
  EXPECT_THROW(prm.set("Shape", "cone"), ExceptionBase);
}

TEST(TissueParameters, AcceptsTheDefaults)
{
  EXPECT_EQ(refusal(TissueParameters(), 3), "");
  EXPECT_EQ(refusal(TissueParameters(), 2), "");
}

TEST(TissueParameters, RefusesWrongLengths)
{
  using P = TissueParameters;
  EXPECT_TRUE(starts_with(refusal_after([](P &p) { p.radius = -1.; }),
                          "Tissue/Radius = '-1'"));
  EXPECT_TRUE(starts_with(refusal_after([](P &p) { p.cell_spacing = 0.; }),
                          "Tissue/Cell spacing = '0'"));
  EXPECT_TRUE(starts_with(refusal_after([](P &p) { p.cell_spacing = 1e-6; }),
                          "Tissue/Cell spacing"));
  EXPECT_TRUE(starts_with(refusal_after([](P &p) { p.cell_spacing = 600.; }),
                          "Tissue/Cell spacing"));
  EXPECT_TRUE(starts_with(refusal_after([](P &p) {
                            p.shape = "box";
                            p.size  = {1., 0., 1.};
                          }),
                          "Tissue/Size"));
  EXPECT_TRUE(starts_with(refusal_after([](P &p) {
                            p.shape = "cylinder";
                            p.size  = {0., 0., -2.};
                          }),
                          "Tissue/Size"));
  // a cylinder uses the third length only, 2-D the first two
  EXPECT_EQ(refusal_after([](P &p) {
              p.shape = "cylinder";
              p.size  = {0., 0., 200.};
            }),
            "");
  EXPECT_EQ(refusal_after(
              [](P &p) {
                p.shape = "box";
                p.size  = {200., 200., 0.};
              },
              2),
            "");
}

TEST(TissueParameters, RefusesListsOfWrongLength)
{
  using P = TissueParameters;
  EXPECT_TRUE(starts_with(refusal_after([](P &p) { p.center = {1., 2.}; }),
                          "Tissue/Center"));
  EXPECT_EQ(refusal_after([](P &p) { p.center = {1., 2.}; }, 2), "");
  EXPECT_TRUE(starts_with(refusal_after([](P &p) { p.center = {1.}; }, 2),
                          "Tissue/Center"));
  EXPECT_TRUE(starts_with(refusal_after(
                            [](P &p) { p.lattice_offset = {1., 2., 3., 4.}; }),
                          "Tissue/Lattice offset"));
  EXPECT_TRUE(starts_with(refusal_after([](P &p) {
                            p.shape = "ellipsoid";
                            p.size  = {1., 2.};
                          }),
                          "Tissue/Size"));
}

TEST(TissueParameters, RefusesShapesThatDoNotExist)
{
  for (const std::string shape : {"cylinder", "mesh", "cone", ""})
    EXPECT_TRUE(starts_with(
      refusal_after([&](TissueParameters &p) { p.shape = shape; }, 2),
      "Tissue/Shape = '" + shape + "'"));
  EXPECT_TRUE(
    starts_with(refusal_after([&](TissueParameters &p) { p.shape = "Sphere"; }),
                "Tissue/Shape = 'Sphere'"));
}

TEST(TissueParameters, RefusesMissingAndSuperfluousFiles)
{
  using P = TissueParameters;
  EXPECT_TRUE(starts_with(refusal_after([](P &p) { p.shape = "mesh"; }),
                          "Tissue/Surface mesh"));
  EXPECT_TRUE(starts_with(refusal_after([](P &p) { p.shape = "points"; }),
                          "Tissue/Points file"));
  EXPECT_TRUE(starts_with(refusal_after([](P &p) {
                            p.shape        = "mesh";
                            p.surface_mesh = "no/such/file.stl";
                          }),
                          "Tissue/Surface mesh = 'no/such/file.stl'"));
  EXPECT_TRUE(starts_with(refusal_after([](P &p) {
                            p.shape       = "points";
                            p.points_file = ::testing::TempDir();
                          }),
                          "Tissue/Points file"));

  const TemporaryFile file(".csv", "x,y,z\n0,0,0\n");
  EXPECT_EQ(refusal_after([&](P &p) {
              p.shape       = "points";
              p.points_file = file.path;
            }),
            "");
  EXPECT_TRUE(
    starts_with(refusal_after([&](P &p) { p.points_file = file.path; }),
                "Tissue/Points file"));
  EXPECT_TRUE(starts_with(refusal_after([&](P &p) {
                            p.shape           = "points";
                            p.points_file     = file.path;
                            p.points_surface  = "none";
                            p.boundary_points = 100;
                          }),
                          "Tissue/Boundary points = '100'"));
  EXPECT_TRUE(starts_with(refusal_after([&](P &p) {
                            p.shape          = "points";
                            p.points_file    = file.path;
                            p.points_surface = "none";
                            p.refine_surface = true;
                          }),
                          "Tissue/Refine surface"));
  EXPECT_EQ(refusal_after([&](P &p) {
              p.shape           = "points";
              p.points_file     = file.path;
              p.boundary_points = 100;
            }),
            "");
  EXPECT_TRUE(starts_with(refusal_after([&](P &p) {
                            p.shape        = "mesh";
                            p.surface_mesh = file.path;
                          }),
                          "Tissue/Surface mesh"));
}
