// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/grid/point_bins.h>
#include <morula/particles/nearest.h>
#include <morula/simulation/gap_watch.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <limits>
#include <sstream>
#include <vector>

namespace Morula
{
  namespace
  {
    /** The least cosine of the angle between a normal and the way to the other
     *  side, and of that between one normal and the other one turned round:
     *  the two sides need not be quite parallel. Neighbours on one side never
     *  count, as their normals point the same way. */
    constexpr double least_cosine = 0.8;

    /** The width of the widest gap across which the splines of one copy reach,
     *  in grid spacings. */
    constexpr double widest = 2.;

    /** Whether two boundary points look at each other through empty space. */
    template <int dim>
    bool
    face(const Point<dim>     &x,
         const Tensor<1, dim> &n,
         const Point<dim>     &y,
         const Tensor<1, dim> &m)
    {
      const Tensor<1, dim> way    = y - x;
      const double         length = way.norm();
      return way * n > least_cosine * length &&
             way * m < -least_cosine * length && n * m < -least_cosine;
    }

    /** A boundary point that may be one side of a gap. */
    template <int dim>
    struct SidePoint
    {
      Point<dim>     x; // µm
      Tensor<1, dim> n; // outward unit normal
      unsigned int   body;
    };

    /** The unknowns of a grid cell of this rank, or null if it is another
     *  rank's. */
    template <int dim>
    const std::vector<unsigned int> *
    unknowns_at(const SidePoint<dim> &point, const SplineSpace<dim> &space)
    {
      const auto key =
        std::make_pair(space.box().number(space.box().locate(point.x)),
                       point.body);
      const auto found =
        std::lower_bound(space.grid_cells().begin(),
                         space.grid_cells().end(),
                         key,
                         [](const auto &grid_cell, const auto &key) {
                           return std::make_pair(grid_cell.number,
                                                 grid_cell.part) < key;
                         });
      return found != space.grid_cells().end() && found->number == key.first &&
                 found->part == key.second ?
               &found->unknowns :
               nullptr;
    }

    /** Whether splines reach from one point to the other. */
    template <int dim>
    bool
    stick(const SidePoint<dim>   &one,
          const SidePoint<dim>   &other,
          const SplineSpace<dim> &space)
    {
      // That two points are of one piece does not say that they stick together,
      // since the splines between them may be parted. The unknowns of a grid
      // cell are known to its owner only: where the other point is on another
      // rank, only a gap below one grid spacing counts.
      const auto *const here  = unknowns_at(one, space);
      const auto *const there = unknowns_at(other, space);
      if (here == nullptr || there == nullptr)
        return one.x.distance(other.x) < space.box().spacing();
      return std::find_first_of(here->begin(),
                                here->end(),
                                there->begin(),
                                there->end()) != here->end();
    }
  } // namespace


  template <int dim>
  std::optional<Gap<dim>>
  narrowest_gap(const Tissue<dim> &tissue, const SplineSpace<dim> &space)
  {
    // Each rank looks around its own boundary points, at those of all ranks
    // within two grid cells, and finds its nearest pair; then the nearest of
    // all ranks counts. All points are those of the configuration at t.
    const BoundaryPoints<dim> &store = tissue.boundary_points();
    const MPI_Comm             comm  = tissue.communicator();
    const unsigned int         rank  = Utilities::MPI::this_mpi_process(comm);
    const auto append = [&](const unsigned int p, std::vector<double> &list) {
      const Tensor<1, dim> area = store.area_vector(p);
      append_flat(list, Tensor<1, dim>(area / area.norm()));
      list.push_back(store.body(p));
    };
    const PointList<dim> near = near_points(store.positions(),
                                            store,
                                            {dim + 1, append, Ties::lowest_id},
                                            tissue.grid(),
                                            static_cast<int>(widest));
    const PointBins<dim> bins(tissue.grid().box(), near.positions);
    const auto           side = [&](const unsigned int i) {
      return SidePoint<dim>{near.positions[i],
                            near.template value<Tensor<1, dim>>(i),
                            static_cast<unsigned int>(near.row(i)[dim])};
    };
    // The place and the width stand in one array of numbers, so that ranks can
    // exchange it.
    std::array<double, dim + 1> best;
    best.fill(0.);
    best[dim]          = std::numeric_limits<double>::max();
    const double reach = widest * space.box().spacing();
    for (unsigned int i = 0; i < near.size(); ++i)
      {
        const SidePoint<dim> one   = side(i);
        const auto           visit = [&](const unsigned int j) {
          const SidePoint<dim> other = side(j);
          const double         width = one.x.distance(other.x);
          // Bodies with splines of their own do not stick together.
          if (other.body != one.body || width >= best[dim] ||
              !face(one.x, one.n, other.x, other.n) ||
              !stick(one, other, space))
            return;
          for (unsigned int d = 0; d < dim; ++d)
            best[d] = 0.5 * (one.x[d] + other.x[d]);
          best[dim] = width;
        };
        if (tissue.grid().owner(space.box().locate(one.x)) == rank)
          bins.visit_within(one.x, std::min(reach, best[dim]), visit);
      }
    // Equal widths, as in a symmetric tissue, are told apart by the place: all
    // ranks choose the same gap.
    for (const auto &other : Utilities::MPI::all_gather(comm, best))
      if (other[dim] < best[dim] || (other[dim] == best[dim] && other < best))
        best = other;
    if (best[dim] == std::numeric_limits<double>::max())
      return {};
    Gap<dim> gap;
    gap.width = best[dim];
    for (unsigned int d = 0; d < dim; ++d)
      gap.place[d] = best[d];
    return gap;
  }


  template <int dim>
  GapWatch<dim>::GapWatch(const Announce &announce)
    : announce(announce)
  {}


  template <int dim>
  void
  GapWatch<dim>::look(const Tissue<dim>      &tissue,
                      const SplineSpace<dim> &space,
                      const double            t)
  {
    // A gap closes in many steps, so that not each of them has to search.
    // Without a surface, or when the user knows, no rank searches. All this is
    // the same on all ranks, so that none waits in the search.
    constexpr unsigned int every = 10;
    if (has_told || n_looks++ % every != 0 ||
        Utilities::MPI::sum<double>(tissue.boundary_points().size(),
                                    tissue.communicator()) == 0.)
      return;
    const auto gap = narrowest_gap(tissue, space);
    if (!gap)
      return;
    has_told = true;
    std::ostringstream text;
    text << "Warning: from t = " << t
         << " day on the surface faces itself at a distance of " << gap->width
         << " um near (" << gap->place
         << ") um, and the splines reach across: the grid cannot see so narrow "
            "a hole, or a gap between two parts of the tissue. Its sides stick "
            "together, though their cells do not touch, and it hardly closes "
            "any further (doc/faq.md, bodies that stick). A smaller "
            "Grid/Spacing follows it down to two spacings. Later ones are not "
            "told of.";
    announce(text.str());
  }


  MORULA_INSTANTIATE(narrowest_gap);
  template class GapWatch<2>;
  template class GapWatch<3>;
} // namespace Morula
