// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  template <int dim>
  std::unique_ptr<Term<dim>>
  random_pressure(std::mt19937 &generator)
  {
    std::vector<AreaLoad<dim>> loads;
    for (unsigned int p = 0; p < 3; ++p)
      loads.push_back({1.5 - p, 40. * random_tensor<1, dim>(generator)});
    return following_pressure(random_points_in_cell<dim>(generator, 3), loads);
  }

  /**
   * The pressure on the faces of the box [0.1, 0.8]^dim of the grid cell. The
   * cofactor of a B-spline's deformation gradient is a polynomial that Gauss
   * quadrature integrates exactly.
   */
  template <int dim>
  std::unique_ptr<Term<dim>>
  closed_surface(const double pressure, const double h)
  {
    const double               lower = 0.1, side = 0.7;
    const QGauss<dim - 1>      quadrature(4);
    GroupedPoints<dim>         points;
    std::vector<AreaLoad<dim>> loads;
    points.h = h;
    for (unsigned int d = 0; d < dim; ++d)
      for (const int sign : {-1, 1})
        for (unsigned int q = 0; q < quadrature.size(); ++q)
          {
            Point<dim>     xi;
            Tensor<1, dim> area;
            xi[d] = sign < 0 ? lower : lower + side;
            for (unsigned int e = 0, k = 0; e < dim; ++e)
              if (e != d)
                xi[e] = lower + side * quadrature.point(q)[k++];
            area[d] = sign * quadrature.weight(q) *
                      Utilities::fixed_power<dim - 1>(side * h);
            points.xi.push_back(xi);
            loads.push_back({pressure, area});
          }
    points.offsets = {0, static_cast<unsigned int>(loads.size())};
    return following_pressure(points, loads);
  }

  /** Current volume of that box. */
  template <int dim>
  double
  box_volume(const LocalField<dim> &field, const double h)
  {
    const QGauss<dim> quadrature(5);
    double            sum = 0.;
    for (unsigned int q = 0; q < quadrature.size(); ++q)
      {
        Point<dim> xi;
        for (unsigned int d = 0; d < dim; ++d)
          xi[d] = 0.1 + 0.7 * quadrature.point(q)[d];
        sum += quadrature.weight(q) *
               determinant(field.step_deformation(SplineValues<dim>(xi, h)));
      }
    return sum * Utilities::fixed_power<dim>(0.7 * h);
  }

  template <int dim>
  std::unique_ptr<Term<dim>>
  random_tension(std::mt19937 &generator)
  {
    std::vector<AreaLoad<dim>> loads;
    for (unsigned int p = 0; p < 3; ++p)
      loads.push_back({1.5 * p, 40. * random_tensor<1, dim>(generator)});
    return surface_energy(random_points_in_cell<dim>(generator, 3), loads);
  }
} // namespace


TEST_2D_3D(FollowingPressure,
           OnAClosedSurfaceHasNoResultantAndDoesWorkOnTheVolume)
{
  constexpr unsigned int n = BSpline<dim>::n;
  const double           h = 50., pressure = 1.3;
  std::mt19937           generator(3);
  const auto             term     = closed_surface<dim>(pressure, h);
  const auto             field    = random_field<dim>(generator, 0.2);
  const auto             velocity = random_field<dim>(generator, 0.2);
  const auto             residual =
    TermOnOneCell<dim>(*term, GrowthAt::current).residual(field);
  double largest = 0.;
  for (const double force : residual)
    largest = std::max(largest, std::abs(force));
  ASSERT_GT(largest, 0.);
  double power = 0.;
  for (unsigned int i = 0; i < dim; ++i)
    {
      double sum = 0.; // splines sum up to 1: the resultant
      for (unsigned int a = 0; a < n; ++a)
        {
          sum += residual[i * n + a];
          power += residual[i * n + a] * velocity.coefficient[i][a];
        }
      EXPECT_NEAR(sum, 0., 1e-12 * largest);
    }

  // R·v = p dV/dt: the residual has the loads with a minus.
  const double eps   = 1e-3;
  const auto   moved = [&](const double by) {
    LocalField<dim> result = field;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int a = 0; a < n; ++a)
        result.coefficient[i][a] += by * velocity.coefficient[i][a];
    return result;
  };
  const double rate =
    (box_volume(moved(eps), h) - box_volume(moved(-eps), h)) / (2. * eps);
  EXPECT_NEAR(power, pressure * rate, 1e-6 * std::abs(power));
}


/** A patch under an affine map: the energy is that of the area gained. */
TEST_2D_3D(SurfaceEnergy, IsThatOfTheAreaGained)
{
  const double       tension = 3., area = 7.;
  GroupedPoints<dim> points{{0, 1}, {Point<dim>()}, 50.};
  points.xi[0][0] = 0.3;
  Tensor<1, dim> a;
  a[0]                          = area;
  const auto               term = surface_energy<dim>(points, {{tension, a}});
  const TermOnOneCell<dim> at(*term, GrowthAt::current);
  Tensor<2, dim>           A; // stretches of 1.5, 1.2 (and 1.1), a shear
  A[0][0]                 = 0.5;
  A[1][1]                 = 0.2;
  A[dim - 1][dim - 1]     = dim == 3 ? 0.1 : 0.2;
  const double in_plane   = dim == 3 ? 1.2 * 1.1 : 1.2;
  const auto   displaced  = affine_field(Tensor<1, dim>(), A, 50.);
  const double difference = tension * area * (in_plane - 1.);
  EXPECT_NEAR(at.energy(displaced), difference, 1e-12 * area);
  // Along its normal a patch feels nothing.
  const auto residual = at.residual(displaced);
  double     largest  = 0.;
  for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
    {
      EXPECT_NEAR(residual[a], 0., 1e-12);
      largest = std::max(largest, std::abs(residual[BSpline<dim>::n + a]));
    }
  EXPECT_GT(largest, 0.01);
}


TEST_2D_3D(SurfaceLoads, NoticeInversion)
{
  std::mt19937   generator(4);
  const auto     term    = random_pressure<dim>(generator);
  const auto     tension = random_tension<dim>(generator);
  Tensor<2, dim> mirror;
  mirror[0][0] = -2.5;
  for (const auto wanted :
       {LocalSystem<dim>::energy_and_residual, LocalSystem<dim>::tangent})
    for (const Term<dim> *load :
         std::vector<const Term<dim> *>{term.get(), tension.get()})
      EXPECT_TRUE(
        TermOnOneCell<dim>(*load, GrowthAt::current)
          .inverted(affine_field(Tensor<1, dim>(), mirror, 50.), wanted));
}
