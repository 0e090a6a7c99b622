// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  template <int dim>
  GridBox<dim>
  unit_box(const double h)
  {
    return GridBox<dim>({}, {}, h, Point<dim>());
  }

  /** Cells of a lattice, turned by an angle about the first axes' plane. */
  template <int dim>
  std::vector<Point<dim>>
  turned_lattice(const double half, const double angle)
  {
    std::vector<Point<dim>> list;
    for (const Point<dim> &x :
         lattice_points<dim>(Point<dim>(), half, 1., [](const auto &) {
           return true;
         }))
      {
        Point<dim> y = x;
        y[0]         = std::cos(angle) * x[0] - std::sin(angle) * x[1];
        y[1]         = std::sin(angle) * x[0] + std::cos(angle) * x[1];
        list.push_back(y);
      }
    return list;
  }

  /** The tension of a flat interface at this angle over γ, with h = 5 cells,
   *  inside of a large tissue. Without smoothing this is its area by area. */
  template <int dim>
  double
  part_of_tension(const double angle, const double smoothing = 0.)
  {
    const double         h    = 5.;
    const double         half = dim == 2 ? 40. : 20.;
    const double         r    = dim == 2 ? 20. : 8.;
    TypeFractions<dim>   field(unit_box<dim>(h), 2);
    const Tensor<1, dim> normal = [&] {
      Tensor<1, dim> n;
      n[0] = std::cos(angle), n[1] = std::sin(angle);
      return n;
    }();
    const double along = 0.7; // the interface cuts the lattice anywhere
    const auto   cells = turned_lattice<dim>(half, 0.3);
    for (const Point<dim> &x : cells)
      field.add(x, 1., x * normal > along);
    double sum = 0.;
    for (const Point<dim> &x : cells)
      {
        // The part of the tissue that counts is a cylinder along the normal.
        const Tensor<1, dim> across = x - (x * normal) * normal;
        if (across.norm() < r && std::abs(x * normal) < 15.)
          {
            const double g = field.at(x).gradient[1].norm();
            sum += g > 0. ? g * g / std::hypot(g, smoothing / h) : 0.;
          }
      }
    return sum / (dim == 2 ? 2. * r : numbers::PI * r * r);
  }
} // namespace


TEST(TypeFractions, AddUpToOneAlsoBesideTheSurface)
{
  std::mt19937     generator(1);
  TypeFractions<3> field(unit_box<3>(3.), 3);
  const auto       cells = ball_points<3>(Point<3>(), 9., 1.);
  for (std::size_t i = 0; i < cells.size(); ++i)
    field.add(cells[i], 1. + 0.1 * (i % 4), generator() % 3);
  for (const Point<3> &x : cells)
    {
      const auto   at  = field.at(x);
      double       sum = 0.;
      Tensor<1, 3> slope;
      for (unsigned int type = 0; type < 3; ++type)
        sum += at.fraction[type], slope += at.gradient[type];
      EXPECT_NEAR(sum, 1., 1e-12);
      EXPECT_LT(slope.norm(), 1e-12);
    }
}


TEST(TypeTension, OfAFlatInterfaceIsTheSameInAllDirections)
{
  for (const double angle : {0., 0.2, 0.4, 0.7854})
    EXPECT_NEAR(part_of_tension<2>(angle), 1., 0.02) << angle;
  for (const double angle : {0.1, 0.6})
    EXPECT_NEAR(part_of_tension<3>(angle), 1., 0.04) << angle;
}


TEST(TypeTension, MakesUpForWhatSmoothingTakes)
{
  for (const double angle : {0., 0.2, 0.4, 0.7854})
    EXPECT_NEAR(part_of_tension<2>(angle, TypeTensionParameters::smoothing) /
                  part_of_tension<2>(angle),
                TypeTensionParameters::left_by_smoothing,
                0.005)
      << angle;
}


TEST(TypeFractions, FillGridCellsThatHaveNeighboursAllAround)
{
  TypeFractions<3> field(unit_box<3>(3.), 2);
  const auto       cells = ball_points<3>(Point<3>(), 9., 1.);
  for (const Point<3> &x : cells)
    field.add(x, 1., 0);
  const GridBox<3>                     box = unit_box<3>(3.);
  std::map<GridIndex<3>, unsigned int> counts;
  for (const Point<3> &x : cells)
    ++counts[box.locate(x)];
  unsigned int n_filled = 0;
  for (const auto &[index, n] : counts)
    {
      const bool filled = field.is_filled_by(n, index);
      n_filled += filled;
      // The ball contains a filled grid cell; another body's cells do not fill.
      for (unsigned int corner = 0; filled && corner < 8; ++corner)
        {
          Point<3> x = box.corner(index);
          for (unsigned int d = 0; d < 3; ++d)
            x[d] += 3. * (corner >> d & 1);
          EXPECT_LT(x.norm(), 9.);
        }
      EXPECT_FALSE(field.is_filled_by(n - 1, index));
    }
  EXPECT_GT(n_filled, 20u);
  EXPECT_LT(n_filled, counts.size() / 2);
}


TEST(TypeTension, StandsInOneOfTwoSections)
{
  const TypeTensions tensions =
    scene_of({"Dimension=2",
              "Cell types/Names=a, b, c",
              "Cell types/b/Tension/With a=0.5",
              "Cell types/a/Tension/With c=2",
              "Cell types/c/Tension/With surface=3"})
      .catalogue.tensions();
  const std::vector<std::vector<double>> expected = {{0., 0.5, 2.},
                                                     {0.5, 0., 0.},
                                                     {2., 0., 0.}};
  EXPECT_EQ(tensions.between, expected);
  EXPECT_EQ(tensions.with_surface, std::vector<double>({0., 0., 3.}));
}
