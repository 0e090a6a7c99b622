// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/send_records.h>
#include <morula/grid/grid_box.h>
#include <morula/particles/nearest.h>
#include <morula/particles/neighbours.h>
#include <morula/particles/point_exchange.h>
#include <morula/particles/surface_around.h>
#include <morula/particles/voronoi_facets.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace Morula
{
  namespace
  {
    /** Cells farther away than this, in spacings, change no facet of a cell
     * that counts (doc/theory.md, section 12.1). */
    constexpr double ring = 3.;
    /** A facet of a lattice is not larger than a^(dim-1). */
    constexpr double rounding = 1e-6;

    /** The pairs of cells within a distance, with one area for all. */
    template <int dim>
    std::vector<VoronoiFacet>
    pairs_within(const std::vector<Point<dim>> &positions,
                 const double                   reach,
                 const double                   area)
    {
      // The bins are as wide as the reach: grid cells would hold far more
      // cells than those to be found.
      std::vector<VoronoiFacet> pairs;
      if (positions.empty())
        return pairs;
      const GridBox<dim>   box = box_around(positions, reach);
      const PointBins<dim> bins(box, positions);
      for (unsigned int a = 0; a < positions.size(); ++a)
        bins.visit_within(positions[a], reach, [&](const unsigned int b) {
          if (b > a)
            pairs.push_back({a, b, area, positions[a].distance(positions[b])});
        });
      return pairs;
    }
  } // namespace


  template <int dim>
  double
  mean_cell_volume(const Tissue<dim> &tissue)
  {
    // A sum of integers does not depend on who adds up what.
    constexpr int bits = 12;
    std::uint64_t sum = 0, n = tissue.cells().size();
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      sum += static_cast<std::uint64_t>(
        std::llround(std::ldexp(tissue.cells().volume(p), bits)));
    sum = Utilities::MPI::sum(sum, tissue.communicator());
    n   = Utilities::MPI::sum(n, tissue.communicator());
    return n == 0 ? 0. : std::ldexp(static_cast<double>(sum), -bits) / n;
  }


  template <int dim>
  NeighbourGraph<dim>
  neighbours(const Tissue<dim>     &tissue,
             const PointList<dim>  &cells,
             const NeighbourSearch &search)
  {
    // The cells of other ranks come first, so that all pairs with a cell of
    // this rank can be found here. Pairs of which both belong to others are not
    // needed. Each pair that counts is then entered with both of its cells, and
    // the neighbours of each are sorted by their ids, which are the same on all
    // ranks. Facets end at half the ring from their cells, so that none belongs
    // to cells farther apart than the ring. At the surface they go on into the
    // open; there one counts as a^(d-1) at most.
    NeighbourGraph<dim> graph;
    graph.spacing      = std::pow(mean_cell_volume(tissue), 1. / dim);
    graph.n_own        = cells.size();
    graph.points       = cells;
    const double a     = graph.spacing;
    const double reach = search.reach * a;
    graph.points.append(
      halo(cells, tissue.grid(), search.by_facets ? ring * a : reach));
    const double                    face = std::pow(a, dim - 1);
    const std::vector<VoronoiFacet> pairs =
      search.by_facets ? voronoi_facets(graph.points.positions,
                                        graph.points.ids,
                                        ring * a,
                                        0.5 * ring * a) :
                         pairs_within(graph.points.positions,
                                      reach,
                                      face * (dim == 2 ? 2. / 3. : 0.5));

    std::vector<std::vector<typename NeighbourGraph<dim>::Edge>> of_cells(
      graph.n_own);
    const double             least = search.least_part * 2. * dim * face;
    const SurfaceAround<dim> surface(tissue, ring * a);
    const auto              &x = graph.points.positions;
    for (const VoronoiFacet &pair : pairs)
      {
        if (pair.area < least ||
            (pair.a >= graph.n_own && pair.b >= graph.n_own) ||
            (pair.distance > reach && surface.is_between(x[pair.a], x[pair.b])))
          continue;
        graph.longest = std::max(graph.longest, pair.distance);
        const bool is_cut =
          pair.area > (1. + rounding) * face &&
          surface.is_within(surface.middle(x[pair.a], x[pair.b]),
                            0.5 * ring * a);
        const double area = is_cut ? face : pair.area;
        if (pair.a < graph.n_own)
          of_cells[pair.a].push_back({pair.b, area, pair.distance});
        if (pair.b < graph.n_own)
          of_cells[pair.b].push_back({pair.a, area, pair.distance});
      }
    graph.longest = Utilities::MPI::max(graph.longest, tissue.communicator());
    graph.offsets.push_back(0);
    for (auto &list : of_cells)
      {
        std::sort(list.begin(), list.end(), [&](const auto &e, const auto &f) {
          return graph.points.ids[e.other] < graph.points.ids[f.other];
        });
        graph.edges.insert(graph.edges.end(), list.begin(), list.end());
        graph.offsets.push_back(graph.edges.size());
      }
    return graph;
  }


  template <int dim>
  std::vector<double>
  free_surfaces(const Tissue<dim> &tissue)
  {
    // A boundary point may be on another rank than its nearest cell. It is told
    // the cell's rank and place, and tells its own area there. The areas of a
    // cell are added up in the order of their sizes, which is the same on any
    // ranks.
    struct Patch
    {
      unsigned int p;
      double       area;
    };
    const unsigned int rank =
      Utilities::MPI::this_mpi_process(tissue.communicator());
    const BoundaryPoints<dim> &store = tissue.boundary_points();
    std::vector<double>        areas(tissue.cells().size(), 0.);
    if (Utilities::MPI::sum(areas.size(), tissue.communicator()) == 0)
      return areas; // all cells are dead
    const auto nearest = nearest_values(
      store.positions(),
      tissue.cells(),
      [&](const unsigned int p) {
        return std::tuple<unsigned int, unsigned int>(rank, p);
      },
      Ties::lowest_id,
      tissue.grid(),
      store.sides());
    std::map<unsigned int, std::vector<Patch>> patches_of;
    for (unsigned int k = 0; k < store.size(); ++k)
      patches_of[std::get<0>(nearest[k])].push_back(
        {std::get<1>(nearest[k]), store.area_vector(k).norm()});
    std::vector<Patch> patches;
    for (const auto &[sender, list] :
         send_records(patches_of, tissue.communicator()))
      patches.insert(patches.end(), list.begin(), list.end());
    std::sort(patches.begin(), patches.end(), [](const auto &a, const auto &b) {
      return std::make_pair(a.p, a.area) < std::make_pair(b.p, b.area);
    });
    for (const Patch &patch : patches)
      areas[patch.p] += patch.area;
    return areas;
  }


#define INSTANTIATE(dim)                                              \
  template double              mean_cell_volume(const Tissue<dim> &); \
  template NeighbourGraph<dim> neighbours(const Tissue<dim> &,        \
                                          const PointList<dim> &,     \
                                          const NeighbourSearch &);   \
  template std::vector<double> free_surfaces(const Tissue<dim> &);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
