// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/near_tree.h>
#include <morula/base/send_records.h>
#include <morula/particles/point_exchange.h>
#include <morula/particles/surface_refinement.h>

#include <array>
#include <cmath>
#include <unordered_map>
#include <utility>

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

    /** Cosine of the largest angle between the normals of patches that merge,
     *  or that tell each other's curvature. Sides of a box differ by a right
     *  angle, so no patch reaches across an edge of the body. */
    constexpr double least_cosine = 0.5;

    /** Largest angle by which the parts of a patch that is split turn. */
    constexpr double largest_bend = 0.25;


    /** φ of doc/theory.md (4.12a): the angle by which the normal turns from the
     *  middle of a patch at @p x towards that of its half at the end of @p edge
     *  (µm).
     *  @param all patches of all ranks, by id, that @p tree finds */
    template <int dim>
    double
    bend_of(const BoundaryView<dim>    &point,
            const Point<dim>           &x,
            const Tensor<1, dim>       &edge,
            const PointList<dim>       &all,
            const BoundaryColumns<dim> &columns,
            const NearTree<dim>        &tree)
    {
      // The nearest patches of the same face on both sides tell the curvature
      // along the edge. The smaller one counts: none at the edge of a face, and
      // where the surface is curved to and fro. What is held keeps the shape of
      // its wall.
      if (point.condition() == SurfaceCondition::fixed ||
          point.condition() == SurfaceCondition::slip)
        return 0.;
      const Tensor<1, dim>  area   = point.area_vector();
      const double          length = edge.norm();
      std::array<double, 2> bends{}, nearest{{2. * length, 2. * length}};
      for (const unsigned int j : tree.within(x, 2. * length))
        {
          const Tensor<1, dim> other =
            BoundaryView<dim>(all.row(j), columns).area_vector();
          const Tensor<1, dim> away = all.positions[j] - x;
          const double         s    = away * edge / length;
          if (area * other < least_cosine * area.norm() * other.norm() ||
              std::abs(s) < std::max(0.25 * length, 0.7 * away.norm()) ||
              away.norm() >= nearest[s > 0.])
            continue;
          nearest[s > 0.] = away.norm();
          bends[s > 0.]   = 0.25 * (other * edge) / (other.norm() * s);
        }
      if (bends[0] * bends[1] <= 0.)
        return 0.;
      return std::clamp(std::abs(bends[0]) < std::abs(bends[1]) ? bends[0] :
                                                                  bends[1],
                        -largest_bend,
                        largest_bend);
    }

    /** f of doc/theory.md (4.12a). */
    template <int dim>
    Tensor<2, dim>
    bend(const Tensor<1, dim> &n, const Tensor<1, dim> &t, const double angle)
    {
      return Tensor<2, dim>(unit_symmetric_tensor<dim>()) +
             outer_product(std::sin(angle) * t + (std::cos(angle) - 1.) * n,
                           n) -
             std::tan(angle) * outer_product(n, t);
    }
  } // namespace


  template <int dim>
  bool
  has_torn_patch(const PointList<dim>                          &points,
                 const BoundaryColumns<dim>                    &columns,
                 const double                                   longest_edge,
                 const std::function<bool(const Point<dim> &)> &crowded,
                 const MPI_Comm                                 comm)
  {
    bool is_torn = false;
    for (std::size_t i = 0; i < points.size(); ++i)
      is_torn =
        is_torn || (longest(BoundaryView<dim>(points.row(i), columns)).second >
                      longest_split * longest_edge &&
                    !crowded(points.positions[i]));
    return Utilities::MPI::logical_or(is_torn, comm);
  }


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
    // the other half. Both are bent as the surface was before the round. Halves
    // that are still too large are split in the next round.
    std::vector<bool> leave;
    for (const Point<dim> &x : points.positions)
      leave.push_back(crowded(x));
    const auto view = [&](const std::size_t i) {
      return BoundaryView<dim, double>(points.row(i), columns);
    };
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

        const PointList<dim> all = of_all_ranks(points, comm);
        const NearTree<dim>  tree(all.positions);
        for (std::size_t s = 0; s < split.size(); ++s)
          {
            const std::size_t    i    = split[s];
            const unsigned int   k    = longest<dim>(view(i)).first;
            const Tensor<1, dim> edge = view(i).F() * view(i).initial_edge(k),
                                 area = view(i).area_vector(),
                                 n = area / area.norm(), quarter = 0.25 * edge;
            const double angle = bend_of<dim>(
              view(i), points.positions[i], edge, all, columns, tree);
            const Tensor<1, dim> drop = quarter.norm() * std::tan(angle) * n;
            const std::vector<double> row(points.row(i).begin(),
                                          points.row(i).end());
            // A new point is in the surroundings of one that was not crowded.
            leave.push_back(false);
            points.add(next_id + order.places[s],
                       points.positions[i] + quarter - drop,
                       make_array_view(row));
            points.positions[i] -= quarter + drop;
            for (const auto &[part, sign] :
                 {std::make_pair(i, -1.),
                  std::make_pair(points.size() - 1, 1.)})
              {
                view(part).halve(k, sign);
                if (angle != 0.)
                  view(part).deform(bend(n, edge / edge.norm(), sign * angle));
                if (const auto &p = columns.contact_pressure; p.exists())
                  view(part).set(p,
                                 view(part).get(p) * 0.5 * area.norm() /
                                   view(part).area_vector().norm());
              }
          }
        next_id += order.n_keys;
      }
  }

  MORULA_INSTANTIATE(has_torn_patch);
  MORULA_INSTANTIATE(refine_surface);


  namespace
  {
    namespace bgi = boost::geometry::index;

    /** Areas in units of the reference area: patches below the first merge, and
     *  give none above the second. The second is below two, at which refinement
     *  would split the result again. */
    constexpr double too_small = 0.5, largest_merged = 1.6;

    /** The shift of doc/theory.md (4.12d) of the patch that two become, along
     *  its normal, from their area vectors and the way from one to the other.
     */
    template <int dim>
    Tensor<1, dim>
    shift_of(const Tensor<1, dim> &a,
             const Tensor<1, dim> &b,
             const Tensor<1, dim> &apart)
    {
      const Tensor<1, dim> area = a + b;
      const double w_a = a.norm() / (a.norm() + b.norm()), w_b = 1. - w_a;
      return (w_a * (b * apart) - w_b * (a * apart)) / area.norm_square() *
             area;
    }

    /** F, turned so that it takes patches with the normal @p N to ones with the
     *  area vector @p area. */
    template <int dim>
    Tensor<2, dim>
    turned(const Tensor<2, dim> &F,
           const Tensor<1, dim> &N,
           const Tensor<1, dim> &area)
    {
      // The turn K = n ⊗ m - m ⊗ n from the unit vector m to n, in their plane.
      Tensor<1, dim> m = N * invert(F);
      m /= m.norm();
      const Tensor<1, dim> n = area / area.norm();
      const double         c = m * n;
      if (!(c > 0.))
        return F;
      const Tensor<2, dim> K = outer_product(n, m) - outer_product(m, n);
      return (Tensor<2, dim>(unit_symmetric_tensor<dim>()) + K +
              K * K / (1. + c)) *
             F;
    }

    /** Patches that may merge, of all ranks, by id. */
    template <int dim>
    class Candidates
    {
    public:
      Candidates(const PointList<dim>       &points,
                 const BoundaryColumns<dim> &columns,
                 const double                longest_edge,
                 const std::function<bool(const BoundaryView<dim> &,
                                          const BoundaryView<dim> &)> &alike)
        : points(points)
        , columns(columns)
        , alike(alike)
      {
        // More than this would be split again.
        for (std::size_t i = 0; i < points.size(); ++i)
          {
            areas.push_back(view(i).area_vector());
            wanted.push_back(view(i).wanted_area(longest_edge));
            // More would be split again.
            largest.push_back(std::min(largest_merged * wanted.back(),
                                       std::pow(longest_edge, dim - 1)));
          }
      }

      /** The patches that are too small, each with the one that it merges with.
       *  No patch is in two pairs. */
      std::vector<std::pair<std::size_t, std::size_t>>
      pairs() const
      {
        std::vector<std::pair<std::size_t, std::size_t>> list;
        // Patches are taken by id, each that is too small and still free with
        // the nearest that fits. The list of candidates is the same on all
        // ranks, and so are the pairs.
        std::vector<bool> taken(points.size());
        const auto        tree = pack_rtree_of_indices(points.positions);
        for (std::size_t i = 0; i < points.size(); ++i)
          {
            if (taken[i] || !(areas[i].norm() < too_small * wanted[i]))
              continue;
            std::vector<std::size_t> nearest;
            tree.query(bgi::nearest(points.positions[i], 1) &&
                         bgi::satisfies([&](const std::size_t j) {
                           return j != i && !taken[j] && fit(i, j);
                         }),
                       std::back_inserter(nearest));
            if (nearest.empty())
              continue;
            // No patch is in two pairs of one round.
            taken[i] = taken[nearest[0]] = true;
            list.emplace_back(std::min(i, nearest[0]), std::max(i, nearest[0]));
          }
        return list;
      }

      /** Adds the patch that two become to a list. */
      void
      merge(const std::size_t i,
            const std::size_t j,
            PointList<dim>   &list) const
      {
        // What two patches become has the sum of their area vectors and keeps
        // the enclosed volume: doc/theory.md (4.12c), (4.12d). Means are
        // weighted by area. The larger patch gives all that is not a mean, as
        // its condition.
        const double         total = areas[i].norm() + areas[j].norm();
        const double         w_i = areas[i].norm() / total, w_j = 1. - w_i;
        const Tensor<1, dim> area   = areas[i] + areas[j];
        const Tensor<1, dim> apart  = points.positions[j] - points.positions[i];
        const Point<dim>     middle = points.positions[i] + w_j * apart;
        const Tensor<1, dim> shift  = shift_of(areas[i], areas[j], apart);
        const std::size_t    main   = w_j > w_i ? j : i;
        std::vector<double>  row(points.row(main).begin(),
                                points.row(main).end());
        const BoundaryView<dim, double> merged(make_array_view(row), columns);
        // A mean of very different deformations may have no volume.
        Tensor<2, dim> F = w_i * view(i).F() + w_j * view(j).F();
        if (!(determinant(F) > 0.))
          F = view(main).F();
        const Point<dim> X = Point<dim>(w_i * view(i).initial_position() +
                                        w_j * view(j).initial_position());
        // The gap of a fixed point is x - X, which must remain the mean of both
        // gaps: so X is shifted as x is. What a slip point is held to is the
        // wall through X, which stays where it is: X is shifted as the two
        // patches of the wall say, and the normal is theirs.
        Tensor<1, dim> area_of_wall;
        if (merged.condition() == SurfaceCondition::fixed)
          merged.set(columns.initial_position, X + shift);
        else if (merged.condition() == SurfaceCondition::slip)
          {
            const Tensor<1, dim> wall_i =
              areas[i].norm() * view(i).initial_normal();
            const Tensor<1, dim> wall_j =
              areas[j].norm() * view(j).initial_normal();
            area_of_wall = wall_i + wall_j;
            merged.set(columns.initial_position,
                       X + shift_of(wall_i,
                                    wall_j,
                                    view(j).initial_position() -
                                      view(i).initial_position()));
            F = turned(F, area_of_wall, area);
          }
        else
          merged.set(columns.initial_position, X);
        merged.set(columns.reference_area,
                   w_i * view(i).get(columns.reference_area) +
                     w_j * view(j).get(columns.reference_area));
        if (columns.force.exists())
          merged.set(columns.force,
                     view(i).get(columns.force) + view(j).get(columns.force));
        if (const auto &p = columns.contact_pressure; p.exists())
          merged.set(p,
                     (areas[i].norm() * view(i).get(p) +
                      areas[j].norm() * view(j).get(p)) /
                       area.norm());
        columns.set_square_patch(make_array_view(row), F, area);
        if (area_of_wall != Tensor<1, dim>())
          merged.set(columns.initial_normal,
                     area_of_wall / area_of_wall.norm());
        list.add(points.ids[i], middle + shift, make_array_view(row));
      }

    private:
      BoundaryView<dim>
      view(const std::size_t i) const
      {
        return {points.row(i), columns};
      }

      /** Whether two may become one. */
      bool
      fit(const std::size_t i, const std::size_t j) const
      {
        const double a_i = areas[i].norm(), a_j = areas[j].norm();
        // The conditions of doc/theory.md, section 4.5: small enough together,
        // not across an edge of the body or of the walls on which it slips,
        // near, and with the same condition and loads.
        const double sides =
          std::pow(a_i, 1. / (dim - 1)) + std::pow(a_j, 1. / (dim - 1));
        return a_i + a_j <= std::min(largest[i], largest[j]) &&
               areas[i] * areas[j] >= least_cosine * a_i * a_j &&
               points.positions[i].distance(points.positions[j]) <= sides &&
               view(i).condition() == view(j).condition() &&
               (view(i).condition() != SurfaceCondition::slip ||
                view(i).initial_normal() * view(j).initial_normal() >=
                  least_cosine) &&
               alike(view(i), view(j));
      }

      const PointList<dim>                                 &points;
      const BoundaryColumns<dim>                           &columns;
      const std::function<bool(const BoundaryView<dim> &,
                               const BoundaryView<dim> &)> &alike;
      std::vector<Tensor<1, dim>>                           areas;
      std::vector<double>                                   wanted, largest;
    };

    /** Takes the merged patches in place of both; those that are this rank's
     *  are where the first of the two was. */
    template <int dim>
    void
    replace(const PointList<dim>                                   &candidates,
            const std::vector<std::pair<std::size_t, std::size_t>> &pairs,
            const Candidates<dim>                                  &merging,
            PointList<dim>                                         &points)
    {
      // Every rank knows all pairs. The owner of the first patch puts the
      // merged one in its place; the owner of the second drops it. Points are
      // in another grid cell afterwards, perhaps: the caller places them anew.
      std::unordered_map<types::particle_index, std::size_t> first, second;
      for (std::size_t k = 0; k < pairs.size(); ++k)
        {
          first[candidates.ids[pairs[k].first]]   = k;
          second[candidates.ids[pairs[k].second]] = k;
        }
      PointList<dim> kept(points.n_numbers);
      kept.reserve(points.size());
      for (std::size_t i = 0; i < points.size(); ++i)
        {
          const auto pair = first.find(points.ids[i]);
          if (pair != first.end())
            merging.merge(pairs[pair->second].first,
                          pairs[pair->second].second,
                          kept);
          else if (second.count(points.ids[i]) == 0)
            kept.add(points.ids[i],
                     points.positions[i],
                     ArrayView<const double>(points.row(i)));
        }
      points = std::move(kept);
    }
  } // namespace


  template <int dim>
  bool
  coarsen_surface(PointList<dim>             &points,
                  const BoundaryColumns<dim> &columns,
                  const double                longest_edge,
                  const std::function<bool(const BoundaryView<dim> &,
                                           const BoundaryView<dim> &)> &alike,
                  const MPI_Comm                                        comm)
  {
    for (bool any = false;; any = true)
      {
        // Each round merges pairs that are disjoint, until no rank has a patch
        // that is too small, or none of them fits another. In most steps the
        // first test ends it, with one reduction. Only patches that may take
        // part are shown to all ranks.
        bool           small = false;
        PointList<dim> own(points.n_numbers);
        for (std::size_t i = 0; i < points.size(); ++i)
          {
            const ArrayView<const double> row(points.row(i));
            const BoundaryView<dim>       point(row, columns);
            const double                  share =
              point.area_vector().norm() / point.wanted_area(longest_edge);
            small = small || share < too_small;
            if (share < largest_merged)
              own.add(points.ids[i], points.positions[i], row);
          }
        if (!Utilities::MPI::logical_or(small, comm))
          return any;
        const PointList<dim>  all = of_all_ranks(own, comm);
        const Candidates<dim> candidates(all, columns, longest_edge, alike);
        const auto            pairs = candidates.pairs();
        if (pairs.empty())
          return any;
        replace(all, pairs, candidates, points);
      }
  }

  MORULA_INSTANTIATE(coarsen_surface);
} // namespace Morula
