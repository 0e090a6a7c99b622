// ranks: 1 2
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/particles/boundary_state.h>
#include <morula/particles/strays.h>

#include <gtest/gtest.h>

#include <cmath>

#include "common/body_on_grid.h"
#include "particles/random_points.h"

using namespace Morula;

namespace
{
  constexpr double L = 10.; // of the lattice, µm

  GridParameters
  grid(const double h)
  {
    GridParameters parameters;
    parameters.spacing = h;
    return parameters;
  }

  /** A lattice of cells around the origin, stretched by F. */
  template <int dim>
  PointList<dim>
  cells(const Tensor<2, dim> &F)
  {
    const CellSlots<dim> slots(false, false);
    PointList<dim>       list;
    list.n_slots = slots.n_slots;
    for (const Point<dim> &x :
         lattice_points<dim>(Point<dim>(), 40., L, [](const Point<dim> &) {
           return true;
         }))
      {
        list.ids.push_back(list.ids.size());
        list.positions.push_back(Point<dim>(F * x));
        std::vector<double>         properties(slots.n_slots, 0.);
        const CellView<dim, double> cell(ArrayView<double>(properties.data(),
                                                           slots.n_slots),
                                         slots);
        cell.set_scalar(slots.initial_volume, std::pow(L, dim));
        cell.set_tensor(slots.deformation, F);
        list.properties.insert(list.properties.end(),
                               properties.begin(),
                               properties.end());
      }
    return list;
  }

  /** One boundary point of each condition at the same place. */
  template <int dim>
  PointList<dim>
  boundary_points(const Point<dim> &x, const Tensor<1, dim> &N)
  {
    PointList<dim> list;
    list.n_slots = BoundarySlots<dim>::n_slots;
    for (const auto condition : {SurfaceCondition::free,
                                 SurfaceCondition::fixed,
                                 SurfaceCondition::slip,
                                 SurfaceCondition::loaded})
      {
        list.ids.push_back(list.ids.size());
        list.positions.push_back(x);
        const auto slots = initial_boundary_slots<dim>(x, N, 1., condition);
        list.properties.insert(list.properties.end(),
                               slots.begin(),
                               slots.end());
      }
    return list;
  }

  /** Taken back are the free, slip and loaded points, if any. */
  template <int dim>
  void
  check(const double distance, const double h, const unsigned int n_strays)
  {
    SCOPED_TRACE(distance);
    Tensor<2, dim> F = unit_tensor<dim>();
    F[0][0]          = 2.;
    // Out of the middle of the end, on a line with a row of cells.
    Point<dim> end, x;
    for (unsigned int d = 0; d < dim; ++d)
      end[d] = x[d] = 0.5 * L * F[d][d];
    const PointList<dim> all = cells<dim>(F);
    for (const Point<dim> &y : all.positions)
      end[0] = std::max(end[0], y[0]);
    x[0] = end[0] + distance;
    Tensor<1, dim> N; // the slip plane is oblique to the way back
    N[0] = 0.6;
    N[1] = 0.8;

    Tissue<dim> tissue(grid(h), CellSlots<dim>(false, false), MPI_COMM_WORLD);
    tissue.place(dealt(all), dealt(boundary_points<dim>(x, N)));
    EXPECT_EQ(take_back_strays(tissue), n_strays);

    const double reach = 4. / 3. * std::max(1.5 * 2. * L, 0.25 * h);
    for (const auto &particle : tissue.boundary_points().order())
      {
        const BoundaryView<dim> point(boundary_properties<dim>(particle));
        const Point<dim>        now = particle->get_location();
        if (n_strays == 0 || point.condition() == SurfaceCondition::fixed)
          {
            EXPECT_EQ(now.distance(x), 0.);
            EXPECT_EQ((point.deformation() - unit_tensor<dim>()).norm(), 0.);
            continue;
          }
        EXPECT_LE((point.deformation() - F).norm(), 1e-14);
        if (point.condition() == SurfaceCondition::slip)
          EXPECT_NEAR((now - x) * N, 0., 1e-12);
        else
          EXPECT_NEAR(now.distance(end), reach, 1e-10);
        EXPECT_LT(now.distance(end), distance);
      }
    EXPECT_EQ(Utilities::MPI::sum(static_cast<unsigned int>(
                                    tissue.boundary_points().order().size()),
                                  MPI_COMM_WORLD),
              4u);
  }

  /** A crowd at the surface is trusted; points beyond it by their distance. */
  template <int dim>
  void
  check_trust()
  {
    Tissue<dim> tissue(grid(25.), CellSlots<dim>(false, false), MPI_COMM_WORLD);
    const PointList<dim> all = cells<dim>(unit_tensor<dim>());
    Point<dim>           end;
    for (const Point<dim> &y : all.positions)
      if (y[0] > end[0])
        end = y;
    std::vector<Point<dim>> places(3, end);
    places[0][0] += 5.;
    places[1][0] += 17.5; // reach: 15
    places[2][0] += 40.;
    PointList<dim> surface;
    for (const Point<dim> &x : places)
      {
        Tensor<1, dim> N;
        N[0]            = 1.;
        auto one        = boundary_points<dim>(x, N);
        surface.n_slots = one.n_slots;
        surface.ids.push_back(surface.ids.size());
        surface.positions.push_back(x);
        surface.properties.insert(surface.properties.end(),
                                  one.properties.begin(),
                                  one.properties.begin() + one.n_slots);
      }
    tissue.place(dealt(all), dealt(surface));
    std::vector<Point<dim>> mine;
    std::vector<double>     expected;
    for (const auto &point : tissue.boundary_points().order())
      {
        mine.push_back(point->get_location());
        expected.push_back(std::vector<double>{1., 0.5, 0.}[point->get_id()]);
      }
    const auto found = trust_in_surface(mine, tissue);
    ASSERT_EQ(found.size(), expected.size());
    for (unsigned int k = 0; k < found.size(); ++k)
      EXPECT_NEAR(found[k], expected[k], 1e-12);
  }

  template <int dim>
  void
  check_reach()
  {
    check<dim>(39.9, 25., 0);
    check<dim>(40.1, 25., 3);
    check<dim>(200., 25., 3);
    check<dim>(66., 200., 0); // a third of a grid cell
    check<dim>(80., 200., 3);
  }
} // namespace


TEST(Strays, AreTakenBackToTheTissue){MORULA_BOTH_DIMENSIONS(check_reach)}


TEST(Strays, AreTrustedLess)
{
  MORULA_BOTH_DIMENSIONS(check_trust);
  EXPECT_EQ(trust_in_surface(0., 10.), 1.);
  EXPECT_EQ(trust_in_surface(10., 10.), 1.);
  EXPECT_NEAR(trust_in_surface(35. / 3., 10.), 0.5, 1e-14);
  EXPECT_NEAR(trust_in_surface(40. / 3., 10.), 0., 1e-14);
  EXPECT_EQ(trust_in_surface(1e3, 10.), 0.);
}


TEST(Strays, NeedASurface)
{
  Tissue<2>    tissue(grid(25.), CellSlots<2>(false, false), MPI_COMM_WORLD);
  PointList<2> none;
  none.n_slots = BoundarySlots<2>::n_slots;
  tissue.place(dealt(cells<2>(unit_tensor<2>())), none);
  EXPECT_EQ(take_back_strays(tissue), 0u);
}
