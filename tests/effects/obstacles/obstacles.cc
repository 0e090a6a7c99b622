// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  using Values = std::map<std::string, std::string>;

  /** The keys of an obstacle with these values. */
  ObstacleKeys
  one_obstacle(const Values &values)
  {
    ObstacleKeys keys("wall");
    for (AnyKey *key : keys.list())
      if (const auto value =
            values.find(key->path().substr(key->path().rfind('/') + 1));
          value != values.end())
        key->assign(value->second);
    return keys;
  }

  template <int dim>
  Body<dim>
  body(const Values &values)
  {
    return make_body<dim>(one_obstacle(values));
  }

  /** All shapes, about the grid cell [0, 50]^dim. */
  template <int dim>
  std::vector<Values>
  shapes()
  {
    std::vector<Values> list = {
      {{"Shape", "plane"}, {"Center", "20, 25, 25"}, {"Normal", "1, 2, 0.5"}},
      {{"Shape", "sphere"}, {"Center", "20, 30, 25"}, {"Radius", "17"}},
      {{"Shape", "box"}, {"Center", "20, 30, 25"}, {"Size", "30, 20, 24"}}};
    if (dim == 3)
      list.push_back({{"Shape", "cylinder"},
                      {"Center", "20, 30, 25"},
                      {"Radius", "15"},
                      {"Axis", "0.2, 1, -0.5"}});
    return list;
  }

  /** Depth by the term's energy of one point of area 1 on a plane that goes to
   *  +x with this velocity, κ = 100 E/h, E = 2, h = 50. */
  double
  depth_after(const std::string &velocity, const double t, const double x)
  {
    const SceneEffects<2> effects =
      effects_of<2>(scene_of({"Dimension=2",
                              "Obstacles/Names=wall",
                              "Obstacles/wall/Shape=plane",
                              "Obstacles/wall/Normal=1, 0",
                              "Obstacles/wall/Velocity=" + velocity}));
    LoadedPoints<2> points;
    points.offsets        = {0, 1};
    points.xi             = {Point<2>(x / 50., 0.5)};
    points.h              = 50.;
    points.time           = t - 0.1;
    points.youngs_modulus = 2.;
    points.points.push_back(
      {{}, {}, {}, Point<2>(x, 25.), 1., Tensor<1, 2>({0., 1.})});
    const auto term = effects.conditions.at(0).condition->term(points, t);
    return std::sqrt(
      TermOnOneCell<2>(*term, GrowthAt::current).energy(LocalField<2>{}) / 2.);
  }
} // namespace


/** Gradient and curvature are the derivatives of the distance. */
TEST_2D_3D(Body, GradientAndCurvatureAreDerivatives)
{
  std::mt19937 generator(1);
  const double eps = 1e-5;
  for (const Values &values : shapes<dim>())
    for (unsigned int i = 0; i < 50; ++i)
      {
        SCOPED_TRACE(values.at("Shape"));
        const auto at = body<dim>(values);
        Point<dim> x;
        for (unsigned int d = 0; d < dim; ++d)
          x[d] = std::uniform_real_distribution<double>(0., 50.)(generator);
        const Distance<dim> here = at(x);
        EXPECT_NEAR(here.gradient.norm(), 1., 1e-12);
        for (unsigned int d = 0; d < dim; ++d)
          {
            Point<dim> left = x, right = x;
            left[d] -= eps;
            right[d] += eps;
            const auto l = at(left), r = at(right);
            EXPECT_NEAR((r.value - l.value) / (2. * eps),
                        here.gradient[d],
                        1e-6);
            const Tensor<1, dim> change =
              (r.gradient - l.gradient) / (2. * eps);
            for (unsigned int e = 0; e < dim; ++e)
              EXPECT_NEAR(change[e], here.curvature[e][d], 1e-5);
          }
      }
}


TEST(Obstacles, MoveByTheIntegralOfTheirVelocity)
{
  EXPECT_NEAR(depth_after("0; 0", 2., -1.), 1., 1e-12);
  EXPECT_EQ(depth_after("0; 0", 2., 1.), 0.);
  EXPECT_NEAR(depth_after("3; 8", 2., 4.), 2., 1e-12);
  EXPECT_NEAR(depth_after("3*t^2; 0", 2., 5.), 3., 1e-9);
  // stands still from t = 1 on
  EXPECT_NEAR(depth_after("if(t < 1, 5, 0); 0", 2., 2.), 3., 1e-2);
}


TEST(Obstacles, SayWhereAStepIsTooLong)
{
  const auto complaint = [](const std::string &velocity, const double x) {
    try
      {
        depth_after(velocity, 2., x);
      }
    catch (const StepFailed &failure)
      {
        return std::string(failure.what());
      }
    return std::string();
  };
  expect_parts(complaint("501; 0", 40.),
               {"'wall' moves by 50.1 um in a step", "grid spacing"});
  expect_parts(complaint("0; 0", -51.),
               {"(-51 25) um is 51 um deep in the obstacle 'wall'"});
  EXPECT_EQ(complaint("0; 0", -49.), "");
}


/** What has touched is held on both sides, by one energy; the rest is pushed
 *  only. Its force and its tangent are the derivatives. */
TEST_2D_3D(Obstacles, TwoSidedOnesHoldWhatHasTouched)
{
  std::mt19937 generator(1);
  for (const Values &values : shapes<dim>())
    {
      SCOPED_TRACE(values.at("Shape"));
      std::vector<std::string> keys{"Dimension=" + std::to_string(dim),
                                    "Obstacles/Names=wall",
                                    "Obstacles/wall/Two-sided=true"};
      for (const auto &[key, value] : values)
        keys.push_back("Obstacles/wall/" + key + "=" + value);
      const SceneEffects<dim> effects = effects_of<dim>(scene_of(keys));
      const auto             &walls   = *effects.conditions.at(0).condition;
      BoundaryColumns<dim>    columns;
      walls.add_columns(columns);
      EXPECT_TRUE(columns.touched.exists());
      const auto        at = body<dim>(values);
      LoadedPoints<dim> points;
      static_cast<GroupedPoints<dim> &>(points) =
        random_points_in_cell<dim>(generator, 8);
      points.youngs_modulus = 2.;
      double       expected = 0.;
      unsigned int n_held   = 0;
      for (unsigned int p = 0; p < 8; ++p)
        {
          const Point<dim>   x       = Point<dim>(50. * points.xi[p]);
          const unsigned int touched = p % 2;
          Tensor<1, dim>     area;
          area[0] = 1.5;
          points.points.push_back({{}, {}, {}, x, 1., area, touched});
          const double phi = at(x).value;
          n_held += phi > 0. && touched == 1;
          if (phi < 0. || touched == 1)
            expected += 0.5 * 1.5 * 100. * 2. / 50. * phi * phi;
        }
      ASSERT_GT(n_held, 0u);
      const auto               term = walls.term(points, 0.);
      const TermOnOneCell<dim> cell(*term, GrowthAt::current);
      EXPECT_NEAR(cell.energy(LocalField<dim>{}), expected, 1e-12 * expected);
      expect_derivatives(*term, random_field<dim>(generator, 0.02));
    }
}
