// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/particles/boundary_state.h>
#include <morula/particles/surface_refinement.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** An orthonormal basis of the plane normal to @p N (2-D: line). */
    template <int dim>
    std::vector<Tensor<1, dim>>
    tangents(const Tensor<1, dim> &N)
    {
      if constexpr (dim == 2)
        return {cross_product_2d(N)};
      else
        {
          // the axis that is the most tangential
          unsigned int axis = 0;
          for (unsigned int d = 1; d < dim; ++d)
            if (std::abs(N[d]) < std::abs(N[axis]))
              axis = d;
          Tensor<1, dim> first = -N[axis] * N;
          first[axis] += 1.;
          first /= first.norm();
          return {first, cross_product_3d(N, first)};
        }
    }

    /** Which edge of a patch is the longest now, and how long, µm. */
    template <int dim>
    std::pair<unsigned int, double>
    longest(const BoundaryView<dim> &point)
    {
      const Tensor<2, dim>            F = point.deformation();
      std::pair<unsigned int, double> best(0, 0.);
      for (unsigned int k = 0; k < dim - 1; ++k)
        {
          const double length = (F * point.initial_edge(k)).norm();
          if (length > best.second)
            best = {k, length};
        }
      return best;
    }

    /** Longest edge that is split, in units of what an edge may have. */
    constexpr double longest_split = 64.;

    /** Throws on all ranks if any has a patch that is too long to be split. */
    template <int dim>
    void
    check_lengths(const PointList<dim>    &points,
                  const std::vector<bool> &crowded,
                  const double             longest_edge,
                  const MPI_Comm           comm)
    {
      double                length = 0.;
      types::particle_index id     = 0;
      Point<dim>            where;
      for (std::size_t i = 0; i < points.size(); ++i)
        {
          const BoundaryView<dim> point(
            ArrayView<const double>(&points.properties[i * points.n_slots],
                                    points.n_slots));
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

    /** Takes half of the patch of a point: from its middle by E/4 in the
     *  direction of @p sign. */
    template <int dim>
    void
    halve(const double             sign,
          const unsigned int       k,
          Point<dim>              &position,
          const ArrayView<double> &slots)
    {
      using Slots = BoundarySlots<dim>;
      const BoundaryView<dim> point(slots);
      const Tensor<1, dim>    E = point.initial_edge(k);
      position += 0.25 * sign * (point.deformation() * E);
      for (unsigned int d = 0; d < dim; ++d)
        {
          slots[Slots::initial_position + d] += 0.25 * sign * E[d];
          slots[Slots::edges + k * dim + d] = 0.5 * E[d];
        }
      slots[Slots::initial_area] *= 0.5;
    }

    /** Position of each of this rank's @p ids among those of all ranks. */
    std::vector<types::particle_index>
    ranks_of(const std::vector<types::particle_index> &ids, const MPI_Comm comm)
    {
      std::vector<types::particle_index> all;
      for (const auto &part : Utilities::MPI::all_gather(comm, ids))
        all.insert(all.end(), part.begin(), part.end());
      std::sort(all.begin(), all.end());
      std::vector<types::particle_index> places;
      for (const types::particle_index id : ids)
        places.push_back(std::lower_bound(all.begin(), all.end(), id) -
                         all.begin());
      return places;
    }
  } // namespace


  template <int dim>
  std::vector<double>
  with_patch(std::vector<double> slots)
  {
    using Slots = BoundarySlots<dim>;
    AssertDimension(slots.size(), Slots::n_slots);
    const BoundaryView<dim> point(make_array_view(slots));
    const Point<dim>        X = point.initial_position();
    const double side         = std::pow(point.initial_area(), 1. / (dim - 1));
    const auto   t            = tangents(point.initial_normal());
    slots.resize(Slots::n_slots_with_patch);
    for (unsigned int d = 0; d < dim; ++d)
      {
        slots[Slots::seed_position + d] = X[d];
        for (unsigned int k = 0; k < dim - 1; ++k)
          slots[Slots::edges + k * dim + d] = side * t[k][d];
      }
    return slots;
  }


  template <int dim>
  bool
  refine_surface(PointList<dim>                                &points,
                 const double                                   longest_edge,
                 const std::function<bool(const Point<dim> &)> &crowded,
                 types::particle_index                         &next_id,
                 const MPI_Comm                                 comm)
  {
    std::vector<bool> leave;
    for (const Point<dim> &x : points.positions)
      leave.push_back(crowded(x));
    const auto slots_of = [&points](const std::size_t i) {
      return ArrayView<double>(&points.properties[i * points.n_slots],
                               points.n_slots);
    };
    check_lengths(points, leave, longest_edge, comm);
    for (bool any = false;; any = true)
      {
        std::vector<std::size_t>           split;
        std::vector<types::particle_index> ids;
        for (std::size_t i = 0; i < points.size(); ++i)
          if (!leave[i] &&
              longest(BoundaryView<dim>(slots_of(i))).second > longest_edge)
            {
              split.push_back(i);
              ids.push_back(points.ids[i]);
            }
        const auto n = Utilities::MPI::sum<std::uint64_t>(split.size(), comm);
        if (n == 0)
          return any;

        const auto places = ranks_of(ids, comm);
        for (std::size_t s = 0; s < split.size(); ++s)
          {
            const std::size_t  i = split[s];
            const unsigned int k =
              longest(BoundaryView<dim>(slots_of(i))).first;
            const std::vector<double> mother(slots_of(i).begin(),
                                             slots_of(i).end());
            leave.push_back(false);
            points.ids.push_back(next_id + places[s]);
            points.positions.push_back(points.positions[i]);
            points.properties.insert(points.properties.end(),
                                     mother.begin(),
                                     mother.end());
            halve(-1., k, points.positions[i], slots_of(i));
            halve(1., k, points.positions.back(), slots_of(points.size() - 1));
          }
        next_id += n;
      }
  }

#define INSTANTIATE(dim)                                             \
  template std::vector<double> with_patch<dim>(std::vector<double>); \
  template bool                refine_surface(                       \
                   PointList<dim> &,                                 \
                   const double,                                     \
                   const std::function<bool(const Point<dim> &)> &,  \
                   types::particle_index &,                          \
                   const MPI_Comm);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
