// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/global_order.h>
#include <morula/base/instantiate.h>
#include <morula/particles/surface_refinement.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** Which edge of a patch is the longest now, and how long, µm. */
    template <int dim>
    std::pair<unsigned int, double>
    longest(const BoundaryView<dim> &point)
    {
      const Tensor<2, dim>            F = point.F();
      std::pair<unsigned int, double> best(0, 0.);
      for (unsigned int k = 0; k < dim - 1; ++k)
        {
          const double length = (F * point.initial_edge(k)).norm();
          if (length > best.second)
            best = {k, length};
        }
      return best;
    }

    /** Whether a patch is split. */
    template <int dim>
    bool
    too_large(const BoundaryView<dim>    &point,
              const BoundaryColumns<dim> &columns,
              const double                longest_edge)
    {
      return longest(point).second > longest_edge ||
             (columns.reference_area.exists() &&
              point.area_vector().norm() >
                2. * point.wanted_area(longest_edge));
    }

    /** Longest edge that is split, in units of what an edge may have. It would
     *  take six halvings in one step: no growth does that, so the points have
     *  left the tissue. */
    constexpr double longest_split = 64.;

    /** Throws on all ranks if any has a patch that is too long to be split. */
    template <int dim>
    void
    check_lengths(const PointList<dim>       &points,
                  const BoundaryColumns<dim> &columns,
                  const std::vector<bool>    &crowded,
                  const double                longest_edge,
                  const MPI_Comm              comm)
    {
      // Each rank finds its longest patch, and the longest of all decides. The
      // rank that has it writes the message; of several the lowest one. All
      // ranks throw it.
      double                length = 0.;
      types::particle_index id     = 0;
      Point<dim>            where;
      for (std::size_t i = 0; i < points.size(); ++i)
        {
          const BoundaryView<dim> point(points.row(i), columns);
          const double edge = crowded[i] ? 0. : longest(point).second;
          if (edge > length)
            {
              length = edge;
              id     = points.ids[i];
              where  = points.positions[i];
            }
        }
      const double of_all = Utilities::MPI::max(length, comm);
      if (!(of_all > longest_split * longest_edge))
        return;
      const unsigned int rank =
        Utilities::MPI::min(length == of_all ?
                              Utilities::MPI::this_mpi_process(comm) :
                              numbers::invalid_unsigned_int,
                            comm);
      std::ostringstream text;
      text << "the patch of boundary point " << id << " at (" << where
           << ") um has become " << length << " um long, which is more than "
           << longest_split << " times the " << longest_edge
           << " um beyond which it is split: the point has left the tissue. "
              "Choose a shape without corners that stand off from the cells, "
              "a smaller Tissue/Cell spacing or Grid/Spacing, or "
              "Tissue/Refine surface = false";
      throw SurfaceTorn(Utilities::MPI::broadcast(comm, text.str(), rank));
    }
  } // namespace


  template <int dim>
  bool
  refine_surface(PointList<dim>                                &points,
                 const BoundaryColumns<dim>                    &columns,
                 const double                                   longest_edge,
                 const std::function<bool(const Point<dim> &)> &crowded,
                 types::particle_index                         &next_id,
                 const MPI_Comm                                 comm)
  {
    // Where the surface is crowded nothing is split. Each round finds the
    // patches of this rank that are too large; all ranks' are put into one
    // order by id, which gives the new points their ids, the same for any
    // number of ranks. A patch is halved across its longest edge, doc/theory.md
    // (4.12): the new point takes the half at the end of the edge, the old one
    // the other half. Halves that are still too large are split in the next
    // round.
    std::vector<bool> leave;
    for (const Point<dim> &x : points.positions)
      leave.push_back(crowded(x));
    const auto view = [&](const std::size_t i) {
      return BoundaryView<dim, double>(points.row(i), columns);
    };
    check_lengths(points, columns, leave, longest_edge, comm);
    for (bool any = false;; any = true)
      {
        std::vector<std::size_t>           split;
        std::vector<types::particle_index> ids;
        for (std::size_t i = 0; i < points.size(); ++i)
          if (!leave[i] && too_large<dim>(view(i), columns, longest_edge))
            {
              split.push_back(i);
              ids.push_back(points.ids[i]);
            }
        // Collective: all ranks know how many are split, and end together.
        const GlobalOrder order = global_order(ids, comm);
        if (order.n_keys == 0)
          return any;

        for (std::size_t s = 0; s < split.size(); ++s)
          {
            const std::size_t    i       = split[s];
            const unsigned int   k       = longest<dim>(view(i)).first;
            const Tensor<1, dim> quarter = // of the present edge
              0.25 * (view(i).F() * view(i).initial_edge(k));
            const std::vector<double> row(points.row(i).begin(),
                                          points.row(i).end());
            // A new point is in the surroundings of one that was not crowded.
            leave.push_back(false);
            points.add(next_id + order.places[s],
                       points.positions[i] + quarter,
                       make_array_view(row));
            points.positions[i] -= quarter;
            view(i).halve(k, -1.);
            view(points.size() - 1).halve(k, 1.);
          }
        next_id += order.n_keys;
      }
  }

  MORULA_INSTANTIATE(refine_surface);
} // namespace Morula
