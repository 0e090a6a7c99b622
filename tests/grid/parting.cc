// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "grid/room.h"

constexpr double l = 0.2; // of cells, in units of h

/**
 * Two arms along x, joined at x < 0, with a gap between them; lengths in
 * units of h. The surface is known along the gap, which is all that the
 * parting needs.
 */
template <int dim>
struct Hairpin
{
  std::vector<PartedCell<dim>>  cells;
  std::vector<PartedPatch<dim>> patches;

  Hairpin(const double thickness,
          const double gap,
          const double noise,
          const double y)
  {
    std::mt19937                           generator(1);
    std::uniform_real_distribution<double> uniform(-1., 1.);
    const int    n_across = static_cast<int>(std::round(thickness / l));
    const int    n_deep   = dim == 3 ? 5 : 1;
    const double joint    = 1.;
    const auto   add      = [&](const double a, const double b, const int k) {
      Point<dim> x;
      x[0] = a + noise * l * uniform(generator);
      x[1] = y + b + noise * l * uniform(generator);
      if (dim == 3)
        x[dim - 1] = (k + 0.5) * l;
      const ParticleDomain<dim> cube(x, std::pow(l, dim));
      cells.push_back({static_cast<types::particle_index>(cells.size()),
                       0,
                       x,
                       invert(cube.edge_vectors()),
                       cube.lower(),
                       cube.upper()});
    };
    for (int k = 0; k < n_deep; ++k)
      for (int i = -static_cast<int>(joint / l); i < 25; ++i)
        {
          for (const double arm : {-1., 1.})
            for (int j = 0; j < n_across; ++j)
              add((i + 0.5) * l,
                  arm * (gap / 2. + (j + 0.5) * thickness / n_across),
                  k);
          if (i < 0)
            for (double b = -gap / 2. + l / 2.; b < gap / 2.; b += l)
              add((i + 0.5) * l, b, k);
        }
    const double spacing = 0.25;
    for (double z = spacing / 2.; z < (dim == 3 ? n_deep * l : spacing);
         z += spacing)
      {
        const auto patch = [&](const Point<2> &at, const Point<2> &n) {
          PartedPatch<dim> one;
          one.id   = patches.size();
          one.body = 0;
          for (unsigned int d = 0; d < 2; ++d)
            {
              one.x[d] = at[d];
              one.n[d] = n[d];
            }
          if (dim == 3)
            one.x[dim - 1] = z;
          one.spacing = spacing;
          patches.push_back(one);
        };
        for (double a = 0.05; a < 5.; a += spacing)
          for (const double arm : {-1., 1.})
            patch({a, y + arm * gap / 2.}, {0., -arm});
        for (double b = -gap / 2. + spacing / 2.; b < gap / 2.; b += spacing)
          patch({0., y + b}, {1., 0.});
      }
  }
};

/** Which of the space's grid cells each cell belongs to, and whether two of
 *  these share an unknown. */
struct Sharing
{
  std::vector<unsigned int>              entries;
  std::vector<std::vector<unsigned int>> unknowns; // of entries, sorted
  std::map<std::pair<unsigned int, unsigned int>, bool> known;

  bool
  operator()(const std::size_t i, const std::size_t j)
  {
    const auto pair  = std::minmax(entries[i], entries[j]);
    const auto found = known.find(pair);
    if (found != known.end())
      return found->second;
    const auto &a = unknowns[pair.first], &b = unknowns[pair.second];
    return known[pair] =
             std::any_of(a.begin(), a.end(), [&](const unsigned int one) {
               return std::binary_search(b.begin(), b.end(), one);
             });
  }
};

template <int dim>
std::vector<Point<dim>>
places_of(const Hairpin<dim> &body)
{
  std::vector<Point<dim>> places;
  for (const PartedCell<dim> &cell : body.cells)
    places.push_back(cell.x);
  return places;
}

template <int dim>
Sharing
sharing(const Hairpin<dim> &body, const SharedParting<dim> &parting)
{
  const std::vector<Point<dim>> places = places_of(body);
  BackgroundGrid<dim>           grid(grid_of_spacing(1.), MPI_COMM_SELF);
  const auto [first, last] = extent<dim>({&places}, grid);
  grid.enclose(first, last);
  GridCellCounts weights;
  for (const Point<dim> &x : places)
    weights.push_back({grid.box().number(grid.box().locate(x)), 1});
  grid.partition(weights);

  const auto     domains = domains_of(places, std::pow(l, dim));
  Occupancy<dim> occupancy(GridWindow<dim>(grid, ranges_of(domains, grid)),
                           1,
                           false,
                           parting);
  occupy(occupancy, grid, domains);
  const SplineSpace<dim> space(grid, occupancy, grid_of_spacing(1.));
  Sharing                result;
  for (const auto &entry : space.grid_cells())
    {
      result.unknowns.push_back(entry.unknowns);
      std::sort(result.unknowns.back().begin(), result.unknowns.back().end());
    }
  for (const PartedCell<dim> &cell : body.cells)
    {
      const unsigned int number = grid.box().number(grid.box().locate(cell.x));
      result.entries.push_back(
        space.entry(number, space.part_of_cell(cell.id, 0, number)));
    }
  return result;
}

/** The box around a body, with room for its surroundings. */
template <int dim>
GridBox<dim>
box_around(const Hairpin<dim> &body)
{
  const std::vector<Point<dim>> places = places_of(body);
  BackgroundGrid<dim>           grid(grid_of_spacing(1.), MPI_COMM_SELF);
  const auto [first, last] = extent<dim>({&places}, grid);
  grid.enclose(first, last);
  return grid.box();
}

template <int dim>
SharedParting<dim>
parting_of(const Hairpin<dim> &body)
{
  const GridBox<dim> box = box_around(body);
  return std::make_shared<const Parting<dim>>(box,
                                              contested_grid_cells(box,
                                                                   body.patches,
                                                                   0.4),
                                              body.cells,
                                              body.patches);
}


// Arms of one body that touch have no unknown in common away from where they
// are joined, and neither of them is torn.
TEST_2D_3D(Parting, PartsTheArmsOfAHairpin)
{
  // What counts is where the gap lies in the grid, how thick the arms are,
  // and whether cells stand on a lattice.
  for (const double thickness : {0.4, 0.6, 1., 2.})
    for (const double gap : {0., 0.02, 0.5})
      for (const double noise : {0., 0.2})
        for (const double y : {0., 0.13, 0.5})
          {
            SCOPED_TRACE(std::to_string(thickness) + " thick, gap " +
                         std::to_string(gap) + ", at " + std::to_string(y));
            const Hairpin<dim>       body(thickness, gap, noise, y);
            const SharedParting<dim> parting = parting_of(body);
            ASSERT_FALSE(parting->is_trivial());
            Sharing      share    = sharing(body, parting);
            unsigned int n_joined = 0, n_torn = 0, n_joint = 0;
            for (std::size_t i = 0; i < body.cells.size(); ++i)
              for (std::size_t j = 0; j < i; ++j)
                {
                  const auto  &a = body.cells[i].x, &b = body.cells[j].x;
                  const bool   same     = (a[1] < y) == (b[1] < y);
                  const double distance = a.distance(b);
                  if (same)
                    n_torn += distance < 1.5 * l && !share(i, j);
                  // Splines reach 1.5 h from the joint, and thin arms may
                  // continue theirs from there.
                  else if (a[0] > 3. && b[0] > 3.)
                    n_joined += share(i, j);
                  else if (a[0] < 0. && b[0] < 0.)
                    n_joint += distance < 1.5 && share(i, j);
                }
            EXPECT_EQ(n_joined, 0u);
            EXPECT_EQ(n_torn, 0u);
            EXPECT_GT(n_joint, 0u);
          }
}


// Points that face each other across the gap belong to two strands, except
// around its end, where the cells behind them are connected.
TEST(Parting, KnowsWhichPointsAreConnected)
{
  const Hairpin<2>       body(1., 0.02, 0., 0.);
  const SharedParting<2> parting = parting_of(body);
  unsigned int           n_pairs = 0;
  constexpr double radius = 1.5 * l + 0.06; // see Parting::are_connected()
  for (const PartedPatch<2> &a : body.patches)
    for (const PartedPatch<2> &b : body.patches)
      if (a.id < b.id && a.n * b.n < -0.9 && std::abs(a.x[0] - b.x[0]) < 0.1)
        {
          // A path around the end needs room for a cell or two.
          if (a.x[0] > radius || a.x[0] < radius - 2. * l)
            {
              EXPECT_EQ(parting->are_connected(a.id, b.id), a.x[0] < radius)
                << "at " << a.x[0];
            }
          ++n_pairs;
        }
  EXPECT_GT(n_pairs, 15u);
}


// The sides of a sheet face each other through the tissue, which is no gap.
TEST(Parting, LeavesASheetInOnePart)
{
  std::vector<PartedPatch<2>> patches;
  for (int i = 0; i < 20; ++i)
    for (const double side : {-1., 1.})
      patches.push_back({static_cast<types::particle_index>(patches.size()),
                         0,
                         Point<2>(0.25 * i, 1.5 + 0.25 * side),
                         Tensor<1, 2>({0., side}),
                         0.25});
  const GridBox<2> box({{{0, 0}}}, {{{6, 4}}}, 1., Point<2>());
  EXPECT_TRUE(contested_grid_cells(box, patches, 0.4).empty());
}


// A cell that patches surround, as those of a crumpled surface do, shares
// unknowns with the arm next to it, and joins it to nothing else.
TEST_2D_3D(Parting, HoldsACellThatASurfaceCutsOff)
{
  Hairpin<dim>              body(1., 0.5, 0., 0.);
  const ParticleDomain<dim> cube(body.cells.back().x, std::pow(l, dim));
  PartedCell<dim>           lost = body.cells.back();
  Point<dim>                x;
  x[0] = 4.1;
  x[1] = 0.15;
  for (unsigned int d = 2; d < dim; ++d)
    x[d] = 0.5;
  lost.id    = body.cells.size();
  lost.x     = x;
  lost.lower = x - (cube.upper() - cube.lower()) / 2.;
  lost.upper = x + (cube.upper() - cube.lower()) / 2.;
  for (unsigned int d = 0; d < dim; ++d)
    for (const double side : {-1., 1.})
      {
        PartedPatch<dim> patch;
        patch.id   = body.patches.size();
        patch.body = 0;
        patch.x    = x;
        patch.x[d] += 0.05 * side;
        patch.n[d]    = side;
        patch.spacing = 0.25;
        body.patches.push_back(patch);
      }
  body.cells.push_back(lost);
  Sharing      share = sharing(body, parting_of(body));
  unsigned int n_own = 0, n_across = 0;
  for (std::size_t i = 0; i < body.cells.size() - 1; ++i)
    if (const auto &y = body.cells[i].x; y[0] > 3. && y.distance(x) < 1.)
      (y[1] > 0. ? n_own : n_across) += share(i, body.cells.size() - 1);
  EXPECT_GT(n_own, 0u);
  EXPECT_EQ(n_across, 0u);
}
