// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/grid/grid_box.h>
#include <morula/particles/nearest.h>
#include <morula/simulation/watches.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <sstream>
#include <vector>

namespace Morula
{


  template <int dim>
  std::map<std::string, std::uint64_t>
  Watches<dim>::count_points(const Tissue<dim> &tissue) const
  {
    // Points keep the place and normal by which conditions choose them. The
    // names follow from the scene, so that all ranks add up the same ones.
    // Obstacles act where they touch and hold nothing.
    const BoundaryPoints<dim>           &points = tissue.boundary_points();
    std::map<std::string, std::uint64_t> n;
    const auto add = [&](const std::string &name, const auto &acts_on) {
      std::uint64_t mine = 0;
      for (unsigned int p = 0; p < points.size(); ++p)
        mine += acts_on(points[p].seed_position(), points[p].initial_normal());
      n[name] = Utilities::MPI::sum(mine, tissue.communicator());
    };
    for (const auto &named : model.boundary_conditions.list())
      if (!named.condition->only_pushes())
        add(named.name, [&](const Point<dim> &X, const Tensor<1, dim> &N) {
          return named.condition->acts_on(X, N);
        });
    for (const EffectKeys *const keys : model.scene.keys_in_use())
      for (const ExpressionKey *const where : keys->facts().places)
        add(where->path(), [&](const Point<dim> &X, const Tensor<1, dim> &) {
          return where->expression(dim).value(X, 0.) > 0.;
        });
    return n;
  }


  template <int dim>
  void
  Watches<dim>::look_at_conditions(const Tissue<dim> &tissue, const double t)
  {
    // Some points may go with their cells, and forces.csv has their number.
    // Once the last one is gone the scene is another one. Where all cells are
    // gone nothing is left to be told of.
    const auto now = count_points(tissue);
    const bool has_cells =
      Utilities::MPI::sum<std::uint64_t>(tissue.cells().size(),
                                         tissue.communicator()) > 0;
    for (const auto &[name, n] : now)
      if (points_before[name] > 0 && n == 0 && has_cells)
        {
          std::ostringstream text;
          text << "Warning: from t = " << t << " day on " << name
               << " acts on no boundary point any more, and did on "
               << points_before[name]
               << " before: the cells near them are gone. What it held, loaded "
                  "or fed goes on without it. Keep these cells alive, or "
                  "choose a place that stays.";
          announce(text.str());
        }
    points_before = now;
  }


  template <int dim>
  void
  Watches<dim>::look_at_pieces(const SplineSpace<dim>    &space,
                               const BackgroundGrid<dim> &grid,
                               const double               t)
  {
    // The user is told of the first place only. After that no step looks for
    // another one, which would cost a search; all ranks know the same.
    const auto place = has_joined ? std::nullopt : watch.joined(space, grid);
    if (place)
      {
        has_joined = true;
        std::ostringstream text;
        text << "Warning: at t = " << t
             << " day two parts of the tissue have come within a grid spacing "
                "of each other near ("
             << *place
             << ") um. From now on they stick together there, though their "
                "cells may not touch yet (doc/faq.md, bodies that stick). A "
                "smaller Grid/Spacing lets them come closer. Later ones are "
                "not told of.";
        announce(text.str());
      }
    count_pieces(space, grid.communicator(), t);
  }


  template <int dim>
  void
  Watches<dim>::count_pieces(const SplineSpace<dim> &space,
                             const MPI_Comm          comm,
                             const double            t)
  {
    // Only pieces with cells count. The count of the first step has nothing to
    // be compared with.
    if (!model.development.is_mortal())
      return;
    const unsigned int n = pieces_with_cells(space, comm);
    if (n_pieces_ > 0 && n > n_pieces_ && !has_parted)
      {
        has_parted = true;
        std::ostringstream text;
        text << "Warning: at t = " << t << " day the tissue has parted: it has "
             << n << " pieces now, and had " << n_pieces_
             << ". Each of them moves on its own. The column pieces of "
                "statistics.csv has their number; later ones are not told of.";
        announce(text.str());
      }
    n_pieces_ = n;
  }


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

    /** A place at which a surface faces itself. */
    template <int dim>
    struct Gap
    {
      /** The distance between the two boundary points, µm. */
      double width;
      /** The middle between the two boundary points, µm. */
      Point<dim> place;
    };

    /**
     * The narrowest gap of the tissue across which splines reach: two boundary
     * points look at each other through empty space, and their grid cells share
     * unknowns. Two arms of one piece, or the rims of a hole, stick together
     * there. The function returns nothing where there is no such gap. Two
     * points on two ranks count if they are nearer than a grid spacing, since
     * neither rank knows the unknowns of both grid cells. Collective.
     */
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
      const PointList<dim> near =
        near_points(store.positions(),
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
      // The place and the width stand in one array of numbers, so that ranks
      // can exchange it.
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
            if (other.body != one.body || width >= std::min(reach, best[dim]) ||
                !face(one.x, one.n, other.x, other.n) ||
                !stick(one, other, space))
              return;
            for (unsigned int d = 0; d < dim; ++d)
              best[d] = 0.5 * (one.x[d] + other.x[d]);
            best[dim] = width;
          };
          if (tissue.grid().owner(space.box().locate(one.x)) == rank)
            {
              // All that a point faces lies in a ball before it that touches
              // it.
              const double radius =
                std::min(reach, best[dim]) / (2. * least_cosine);
              bins.visit_within(one.x + radius * one.n,
                                radius * (1. + 1e-9),
                                visit);
            }
        }
      // Equal widths, as in a symmetric tissue, are told apart by the place:
      // all ranks choose the same gap.
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
  } // namespace


  template <int dim>
  void
  Watches<dim>::look_at_gaps(const Tissue<dim>      &tissue,
                             const SplineSpace<dim> &space,
                             const double            t)
  {
    // A gap closes in many steps, so that not each of them has to search.
    // Without a surface, or when the user knows, no rank searches. All this is
    // the same on all ranks, so that none waits in the search.
    constexpr unsigned int every = 10;
    if (has_told_of_gap || n_looks++ % every != 0 ||
        Utilities::MPI::sum<double>(tissue.boundary_points().size(),
                                    tissue.communicator()) == 0.)
      return;
    const auto gap = narrowest_gap(tissue, space);
    if (!gap)
      return;
    has_told_of_gap = true;
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

  template class Watches<2>;
  template class Watches<3>;
} // namespace Morula
