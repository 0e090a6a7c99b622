// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/near_tree.h>
#include <morula/grid/grid_box.h>
#include <morula/particles/nearest.h>
#include <morula/particles/neighbours.h>
#include <morula/particles/point_exchange.h>

#include <tuple>

namespace Morula
{
  namespace
  {
    /** Boundary points of the tissue, on any rank, within @p reach (µm) of this
     *  rank's grid cells. Collective. */
    template <int dim>
    std::vector<Point<dim>>
    surface_around(const Tissue<dim> &tissue, const double reach)
    {
      const BoundaryPoints<dim> &store = tissue.boundary_points();
      PointList<dim>             list;
      for (unsigned int k = 0; k < store.size(); ++k)
        list.add(store.id(k), store.position(k), {});
      list.append(halo(list, tissue.grid(), reach));
      return list.positions;
    }

    /** Where the surface of the tissue is, to be asked near this rank's cells.
     */
    template <int dim>
    class SurfaceAround
    {
    public:
      /** See surface_around(). */
      SurfaceAround(const Tissue<dim> &tissue, const double reach)
        : points(surface_around(tissue, reach))
        , tree(points)
      {}

      /** Midway, the same bits for both orders. */
      static Point<dim>
      middle(const Point<dim> &x, const Point<dim> &y)
      {
        Point<dim> found;
        for (unsigned int d = 0; d < dim; ++d)
          found[d] = 0.5 * (x[d] + y[d]);
        return found;
      }

      /** Whether a boundary point is that near to a place, which may look no
       *  farther than the reach of a grid cell of this rank. Radius in µm. */
      bool
      is_within(const Point<dim> &x, const double radius) const
      {
        return !tree.within(x, radius).empty();
      }

      /** Whether the surface passes between two places, one of which is in a
       * grid cell of this rank: a boundary point lies in the ball that has them
       * at its ends. In full tissue there is none; across a gap, and outside of
       * a concave surface, there are some, as long as boundary points stand no
       *  farther apart than cells do. */
      bool
      is_between(const Point<dim> &x, const Point<dim> &y) const
      {
        return is_within(middle(x, y), 0.5 * x.distance(y));
      }

    private:
      const std::vector<Point<dim>> points;
      const NearTree<dim>           tree;
    };

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
    std::vector<Patch> patches =
      in_one(send_records(patches_of, tissue.communicator()));
    std::sort(patches.begin(), patches.end(), [](const auto &a, const auto &b) {
      return std::make_pair(a.p, a.area) < std::make_pair(b.p, b.area);
    });
    for (const Patch &patch : patches)
      areas[patch.p] += patch.area;
    return areas;
  }


  MORULA_INSTANTIATE(mean_cell_volume);
  MORULA_INSTANTIATE(neighbours);
  MORULA_INSTANTIATE(free_surfaces);


  namespace
  {
    /** Surfaces touch up to this gap, and down to this overlap, in grid
     *  spacings: a facetted contact has gaps of a few hundredths. */
    constexpr double touching_gap = 0.1;

    /** So far beside each other points of surfaces that touch may be, in units
     *  of the larger of their spacings: as far as contact sees, (4.8k). */
    constexpr double beside_each_other = 1.5;
  } // namespace


  template <int dim>
  std::vector<char>
  touching_points(const Tissue<dim> &tissue)
  {
    // Each point looks at those of all ranks around it, as contact does: at
    // their normals, the gap across both surfaces, and the distance along them.
    const BoundaryPoints<dim> &store  = tissue.boundary_points();
    const double               h      = tissue.grid().box().spacing();
    double                     widest = 0.;
    for (unsigned int p = 0; p < store.size(); ++p)
      widest = std::max(widest, store[p].spacing());
    widest = Utilities::MPI::max(widest, tissue.communicator());
    const double reach =
      std::hypot(beside_each_other * widest, touching_gap * h);
    const auto numbers = [&](const unsigned int p, std::vector<double> &list) {
      append_flat(list, store.area_vector(p));
      list.push_back(store[p].spacing());
      list.push_back(store.body(p));
    };
    const PointList<dim> near =
      near_points(store.positions(),
                  store,
                  {dim + 2, numbers, Ties::lowest_id},
                  tissue.grid(),
                  static_cast<int>(std::ceil(reach / h)));
    const NearTree<dim> tree(near.positions);
    std::vector<char>   touch(store.size(), 0);
    for (unsigned int p = 0; p < store.size(); ++p)
      {
        const Point<dim>     x = store.position(p);
        const Tensor<1, dim> n =
          store.area_vector(p) / store.area_vector(p).norm();
        const auto around = tree.within(x, reach);
        touch[p] =
          std::any_of(around.begin(), around.end(), [&](const unsigned int i) {
            const double *const  row      = near.row(i).data();
            const auto           area     = Flat<Tensor<1, dim>>::read(row);
            const Tensor<1, dim> across   = 0.5 * (area / area.norm() - n);
            const Tensor<1, dim> distance = x - near.positions[i];
            const double         gap      = across * distance;
            if ((!store.has_parts() && row[dim + 1] == store.body(p)) ||
                n * area >= Parting<dim>::facing * area.norm() ||
                std::abs(gap) > touching_gap * h)
              return false;
            return (distance - gap / across.norm_square() * across).norm() <
                   beside_each_other * std::max(store[p].spacing(), row[dim]);
          });
      }
    return touch;
  }


  MORULA_INSTANTIATE(touching_points);
} // namespace Morula
