// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  constexpr double h = 10., cell = 2.5, height = 15., width = 20.;

  /** Two blocks on each other that overlap by @p overlap (µm), with points on
   *  the faces that meet, which do not match. */
  template <int dim>
  std::unique_ptr<Tissue<dim>>
  two_blocks(const double overlap)
  {
    GridParameters grid;
    grid.spacing = h;
    CellColumns<dim> cells;
    cells.need_bodies();
    BoundaryColumns<dim> surface;
    surface.need_bodies();
    auto tissue =
      std::make_unique<Tissue<dim>>(grid, cells, MPI_COMM_WORLD, surface);
    PointList<dim> all_cells(cells.n_numbers()),
      all_points(surface.n_numbers());
    types::particle_index id = 0, point = 0;
    for (unsigned int body = 0; body < 2; ++body)
      {
        // The middle plane of the meeting is at 1 in the last direction, so
        // that it cuts grid cells.
        const double face = 1. + (body == 0 ? 0.5 : -0.5) * overlap;
        const double up   = body == 0 ? -1. : 1.;
        const auto   loop = [&](const double step, const auto &visit) {
          const int n = std::round(width / step);
          for (int i = 0; i < n; ++i)
            for (int j = 0; j < (dim == 3 ? n : 1); ++j)
              {
                Point<dim> x;
                x[0] = (i + 0.5) * step;
                if (dim == 3)
                  x[1] = (j + 0.5) * step;
                visit(x);
              }
        };
        loop(cell, [&](Point<dim> x) {
          for (int k = 0; k < height / cell; ++k)
            {
              x[dim - 1]              = face + up * (k + 0.5) * cell;
              std::vector<double> row = cells.founder(x, std::pow(cell, dim));
              cells.body.set(make_array_view(row), body);
              all_cells.add(id++, x, make_array_view(row));
            }
        });
        const double step = body == 0 ? 2.5 : 20. / 9.;
        loop(step, [&](Point<dim> x) {
          x[dim - 1] = face;
          Tensor<1, dim> n;
          n[dim - 1]              = -up;
          std::vector<double> row = surface.initial_point(
            x, n, std::pow(step, dim - 1), SurfaceCondition::free);
          surface.body.set(make_array_view(row), body);
          all_points.add(point++, x, make_array_view(row));
        });
      }
    tissue->place(all_cells, all_points);
    return tissue;
  }

  /** Small displacements at the relevant unknowns. */
  std::vector<double>
  random_values(const std::size_t n, const double size)
  {
    std::mt19937                           generator(7);
    std::uniform_real_distribution<double> uniform(-size, size);
    std::vector<double>                    u(n);
    for (double &value : u)
      value = uniform(generator);
    return u;
  }

  PairTerm::Sums
  sums_at(const PairTerm            &term,
          const std::vector<double> &u,
          std::vector<double>       &residual)
  {
    residual.assign(u.size(), 0.);
    PairTerm::Sums sums{residual};
    term.add_residual(u, sums);
    return sums;
  }
} // namespace


TEST_2D_3D(ContactPairs, ResidualAndTangentAreTheEnergysDerivatives)
{
  const auto               owner_of_tissue = two_blocks<dim>(0.1);
  const Tissue<dim>       &tissue          = *owner_of_tissue;
  SplineSpace<dim>         space           = tissue.splines();
  const ContactPoints<dim> points(tissue, space, h);
  ASSERT_TRUE(points.any());
  const ContactPairs<dim>   term(points, {10., 1., h, 3.});
  const std::size_t         n = dim * space.relevant().n_elements();
  const std::vector<double> u = random_values(n, 0.01);
  std::vector<double>       residual, ahead, behind;
  const double              energy = sums_at(term, u, residual).energy;
  EXPECT_GT(energy, 0.);

  // The derivative of the energy along a direction, and that of the residual.
  const std::vector<double> way     = random_values(n, 1.);
  constexpr double          epsilon = 1e-6;
  std::vector<double>       plus(u), minus(u);
  for (std::size_t i = 0; i < n; ++i)
    {
      plus[i] += epsilon * way[i];
      minus[i] -= epsilon * way[i];
    }
  const double slope =
    (sums_at(term, plus, ahead).energy - sums_at(term, minus, behind).energy) /
    (2. * epsilon);
  double by_residual = 0.;
  for (std::size_t i = 0; i < n; ++i)
    by_residual += residual[i] * way[i];
  EXPECT_NEAR(slope, by_residual, 1e-7 * std::abs(by_residual) + 1e-9);

  std::vector<double> product(n, 0.);
  term.add_tangent(
    u, [&](const unsigned int link, const std::vector<double> &matrix) {
      const UnknownLink &of     = term.links()[link];
      const unsigned int n_rows = of.rows.size(), m = of.columns.size();
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int s = 0; s < n_rows; ++s)
          for (unsigned int j = 0; j < dim; ++j)
            for (unsigned int t = 0; t < m; ++t)
              product[of.rows[s] * dim + i] +=
                matrix[((i * n_rows + s) * dim + j) * m + t] *
                way[of.columns[t] * dim + j];
    });
  double largest = 0., error = 0.;
  for (std::size_t i = 0; i < n; ++i)
    {
      const double expected = (ahead[i] - behind[i]) / (2. * epsilon);
      largest               = std::max(largest, std::abs(expected));
      error                 = std::max(error, std::abs(product[i] - expected));
    }
  EXPECT_GT(largest, 0.);
  EXPECT_LT(error, 1e-7 * largest);
}


/** The force of flat faces is κ times overlap times area; forces of both
 * sides are opposite. */
TEST_2D_3D(ContactPairs, FlatFacesPressByTheirOverlapAndForcesAreOpposite)
{
  constexpr double          overlap = 0.05, kappa = 10.;
  const auto                owner_of_tissue = two_blocks<dim>(overlap);
  const Tissue<dim>        &tissue          = *owner_of_tissue;
  SplineSpace<dim>          space           = tissue.splines();
  const ContactPoints<dim>  points(tissue, space, h);
  const ContactPairs<dim>   term(points, {kappa, 1., h, 0.});
  const std::vector<double> rest(dim * space.relevant().n_elements(), 0.);
  Tensor<1, dim>            on_upper, on_lower;
  for (const auto &one :
       contact_forces(points, term.forces(rest), MPI_COMM_WORLD))
    (one.body == 0 ? on_lower : on_upper) += one.force;
  EXPECT_NEAR((on_upper + on_lower).norm(), 0., 1e-12);
  // At the edges of the faces the kernel reaches beyond the partner.
  const double exact = kappa * overlap * std::pow(width, dim - 1);
  EXPECT_NEAR(on_upper[dim - 1], exact, 0.1 * exact);
  EXPECT_GT(on_upper[dim - 1], 0.);

  std::vector<double> residual;
  sums_at(term, rest, residual);
  Tensor<1, dim> sum;
  for (std::size_t i = 0; i < residual.size(); ++i)
    sum[i % dim] += residual[i];
  EXPECT_NEAR(sum.norm(), 0., 1e-12);
}


/** Bodies that do not overlap do not act on each other, and see no other
 *  body's unknowns. */
TEST_2D_3D(ContactPairs, BodiesThatDoNotTouchShareNothing)
{
  const auto         owner_of_tissue = two_blocks<dim>(-1.);
  const Tissue<dim> &tissue          = *owner_of_tissue;
  SplineSpace<dim>   space           = tissue.splines();
  EXPECT_EQ(space.n_bodies(), 2u);
  EXPECT_EQ(space.n_pieces(), 2u);
  EXPECT_EQ(tissue.unparted_splines().n_pieces(), 1u);
  std::vector<int> owner(space.relevant().n_elements(), -1);
  for (const auto &grid_cell : space.grid_cells())
    for (const unsigned int unknown : grid_cell.unknowns)
      {
        const int body = grid_cell.part;
        EXPECT_TRUE(owner[unknown] == -1 || owner[unknown] == body);
        owner[unknown] = body;
      }
  const ContactPoints<dim>  points(tissue, space, h);
  const ContactPairs<dim>   term(points, {10., 1., h, 3.});
  std::vector<double>       residual;
  const std::vector<double> rest(dim * space.relevant().n_elements(), 0.);
  EXPECT_EQ(sums_at(term, rest, residual).energy, 0.);
  EXPECT_EQ(*std::max_element(residual.begin(), residual.end()), 0.);
}


/** A body that is pushed through another one has crossed it, by how far both
 *  overlap then. */
TEST_2D_3D(ContactPairs, ABodyThatPassesThroughAnotherHasCrossedIt)
{
  const auto               owner_of_tissue = two_blocks<dim>(-1.);
  const Tissue<dim>       &tissue          = *owner_of_tissue;
  SplineSpace<dim>         space           = tissue.splines();
  const ContactPoints<dim> points(tissue, space, h);
  ContactPairs<dim>        term(points, {10., 1., h, 3.});
  for (const auto &[way, crossed] :
       {std::pair(4., 0.), std::pair(5.5, 4.5), std::pair(8., 7.)})
    {
      Tensor<1, dim> down;
      down[dim - 1] = -way;
      const auto u  = affine_displacement(space, 1, down, Tensor<2, dim>());
      EXPECT_NEAR(term.look(u).crossed, crossed, 1e-9);
    }
}
