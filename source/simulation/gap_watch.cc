// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/particles/nearest.h>
#include <morula/simulation/gap_watch.h>

#include <deal.II/base/mpi.h>
#include <deal.II/boost_adaptors/bounding_box.h>
#include <deal.II/boost_adaptors/point.h>
#include <deal.II/numerics/rtree.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
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

    /** The box of all places that a point at @p x with the normal @p n may face
     *  within a distance: that of a cone around the normal. */
    template <int dim>
    BoundingBox<dim>
    box_of_view(const Point<dim>     &x,
                const Tensor<1, dim> &n,
                const double          reach)
    {
      // Of the directions in the cone, the one that goes farthest along an axis
      // is the axis itself or stands on the rim.
      const auto farthest = [](const double cosine) {
        if (cosine >= least_cosine)
          return 1.;
        const auto sine = [](const double c) {
          return std::sqrt(std::max(0., 1. - c * c));
        };
        return std::max(0.,
                        cosine * least_cosine +
                          sine(cosine) * sine(least_cosine));
      };
      // Rounding must not leave out a point on the rim.
      const double margin = 1e-9 * reach;
      Point<dim>   lower, upper;
      for (unsigned int d = 0; d < dim; ++d)
        {
          lower[d] = x[d] - reach * farthest(-n[d]) - margin;
          upper[d] = x[d] + reach * farthest(n[d]) + margin;
        }
      return BoundingBox<dim>({lower, upper});
    }

    /** A grid cell, by its number, and one of the bodies in it. */
    using Entry = std::pair<unsigned int, unsigned int>;

    /** The unknowns of this rank's grid cells and bodies, sorted to be
     * intersected. */
    template <int dim>
    class Unknowns
    {
    public:
      explicit Unknowns(const SplineSpace<dim> &space)
      {
        for (const auto &grid_cell : space.grid_cells())
          {
            auto &list = of[{grid_cell.number, grid_cell.part}] =
              grid_cell.unknowns;
            std::sort(list.begin(), list.end());
          }
      }

      bool
      has(const Entry &entry) const
      {
        return of.count(entry) > 0;
      }

      bool
      are_shared(const Entry &one, const Entry &other) const
      {
        std::vector<unsigned int> both;
        const auto               &a = of.at(one), &b = of.at(other);
        std::set_intersection(
          a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
        return !both.empty();
      }

    private:
      std::map<Entry, std::vector<unsigned int>> of;
    };
  } // namespace


  template <int dim>
  std::optional<Gap<dim>>
  narrowest_gap(const Tissue<dim> &tissue, const SplineSpace<dim> &space)
  {
    // Each rank looks around its own boundary points, at those of other ranks
    // as well, and finds its nearest pair; then the nearest of all ranks
    // counts. That two points are of one piece does not say that they stick
    // together, since the splines between them may be parted. So the unknowns
    // of both grid cells are compared. All points are those of the
    // configuration at t.
    const BoundaryPoints<dim> &store = tissue.boundary_points();
    const GridBox<dim>        &box   = space.box();
    const double               h     = box.spacing();
    const MPI_Comm             comm  = tissue.communicator();
    std::vector<Point<dim>>    queries;
    for (unsigned int p = 0; p < store.size(); ++p)
      queries.push_back(store.position(p));
    const auto normal = [&](const unsigned int p, std::vector<double> &list) {
      const Tensor<1, dim> area = store.area_vector(p);
      append_flat(list, Tensor<1, dim>(area / area.norm()));
      list.push_back(store.body(p));
    };
    // Each rank gets the points of all ranks that lie within two grid cells of
    // its own, with their normals. An R-tree over them finds the few that are
    // near one point.
    const PointList<dim> near = near_points(queries,
                                            store,
                                            {dim + 1, normal, Ties::lowest_id},
                                            tissue.grid(),
                                            static_cast<int>(widest));
    const auto           tree = pack_rtree_of_indices(near.positions);
    const Unknowns<dim>  unknowns(space);

    // The place and the width stand in one array of numbers, so that ranks can
    // exchange it.
    std::array<double, dim + 1> best;
    best.fill(0.);
    best[dim] = std::numeric_limits<double>::max();
    for (unsigned int p = 0; p < store.size(); ++p)
      {
        const Point<dim>    x = queries[p];
        std::vector<double> numbers;
        normal(p, numbers);
        const auto         n    = Flat<Tensor<1, dim>>::read(numbers.data());
        const unsigned int body = store.body(p);
        const Entry        here{box.number(box.locate(x)), body};
        const auto         faces = [&](const auto i) {
          const Point<dim> &y     = near.positions[i];
          const double      width = x.distance(y);
          // Bodies with splines of their own do not stick together.
          if (near.row(i)[dim] != body ||
              width >= std::min(widest * h, best[dim]) || width == 0. ||
              !face(x, n, y, near.template value<Tensor<1, dim>>(i)))
            return false;
          const Entry there{box.number(box.locate(y)), body};
          // The unknowns of a grid cell are known to its owner only. Where the
          // other point is on another rank, only a gap below one grid spacing
          // counts.
          return unknowns.has(here) && unknowns.has(there) ?
                           unknowns.are_shared(here, there) :
                           width < h;
        };
        namespace bgi = boost::geometry::index;
        for (auto found =
               tree.qbegin(bgi::intersects(box_of_view(x, n, widest * h)) &&
                           bgi::satisfies(faces));
             found != tree.qend();
             ++found)
          {
            // The search excludes pairs that are farther than the best one when
            // it comes to them. The best one may have changed since then.
            const Point<dim> &y     = near.positions[*found];
            const double      width = x.distance(y);
            if (width >= best[dim])
              continue;
            for (unsigned int d = 0; d < dim; ++d)
              best[d] = 0.5 * (x[d] + y[d]);
            best[dim] = width;
          }
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
    // Without a surface, or when the user knows, no rank searches. Both are the
    // same on all ranks, so that none waits in the search.
    if (has_told || Utilities::MPI::sum<double>(tissue.boundary_points().size(),
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
