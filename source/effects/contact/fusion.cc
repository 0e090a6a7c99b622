// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/near_tree.h>
#include <morula/effects/contact/fusion.h>
#include <morula/particles/nearest.h>

#include <deal.II/base/mpi.templates.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace Morula
{
  namespace
  {
    /** Points that are deeper in each other than this, in units of h, are those
     *  of a sheet's two faces. */
    constexpr double behind_another = 0.1;

    /** Bodies in couples of this rank, the lower number first. */
    using Couples = std::vector<std::pair<unsigned int, unsigned int>>;

    /** What each body becomes part of, by the couples of all ranks.
     *  Collective. */
    std::map<unsigned int, unsigned int>
    joined(Couples couples, const MPI_Comm comm)
    {
      // All ranks learn all couples and join them alike: the lower number wins,
      // and couples are followed to their end, as three may meet at once.
      std::sort(couples.begin(), couples.end());
      couples.erase(std::unique(couples.begin(), couples.end()), couples.end());
      std::map<unsigned int, unsigned int> into;
      const auto                           root = [&](unsigned int body) {
        while (into.count(body) > 0)
          body = into.at(body);
        return body;
      };
      for (const Couples &list : Utilities::MPI::all_gather(comm, couples))
        for (const auto &[one, other] : list)
          {
            const unsigned int a = root(one), b = root(other);
            if (a != b)
              into[std::max(a, b)] = std::min(a, b);
          }
      for (auto &[body, target] : into)
        target = root(target);
      return into;
    }
  } // namespace


  template <int dim>
  void
  age_contact(Tissue<dim> &tissue, const double dt)
  {
    const auto &columns = tissue.boundary_points().columns();
    for (unsigned int p = 0; p < tissue.boundary_points().size(); ++p)
      {
        const BoundaryView<dim, double> point = tissue.boundary_point(p);
        point.set(columns.contact_age,
                  point.get(columns.contact_pressure) > 0. ?
                    point.get(columns.contact_age) + dt :
                    0.);
      }
  }


  template <int dim>
  Fusion
  find_fusion(const Tissue<dim> &tissue, const double time)
  {
    // Points that have been touched long enough look for such points in front
    // of them within half a grid spacing, also on other ranks.
    const BoundaryPoints<dim> &store = tissue.boundary_points();
    std::vector<Point<dim>>    queries;
    std::vector<unsigned int>  old;
    for (unsigned int p = 0; p < store.size(); ++p)
      if (store[p].get(store.columns().contact_age) >= time)
        {
          old.push_back(p);
          queries.push_back(store.position(p));
        }
    const auto numbers = [&](const unsigned int p, std::vector<double> &list) {
      list.push_back(store.body(p));
      list.push_back(store[p].get(store.columns().contact_age));
      append_flat(list, store.area_vector(p));
    };
    const PointList<dim> near = near_points(
      queries, store, {2 + dim, numbers, Ties::lowest_id}, tissue.grid(), 1);
    const NearTree<dim> tree(near.positions);
    const double        h = tissue.grid().box().spacing();
    Fusion              fusion;
    Couples             couples;
    for (std::size_t k = 0; k < old.size(); ++k)
      {
        const unsigned int   body = store.body(old[k]);
        const Tensor<1, dim> area = store.area_vector(old[k]);
        bool                 met  = false;
        for (const unsigned int i : tree.within(queries[k], 0.5 * h))
          {
            const double *const row   = near.row(i).data();
            const auto          other = static_cast<unsigned int>(row[0]);
            const auto          there = Flat<Tensor<1, dim>>::read(row + 2);
            // The two faces of a sheet are behind each other.
            const double gap =
              0.5 * ((there / there.norm() - area / area.norm()) *
                     (queries[k] - near.positions[i]));
            if (row[1] < time || area * there >= 0. ||
                gap < -behind_another * h)
              continue;
            met = true;
            if (other > body)
              couples.emplace_back(body, other);
          }
        if (met)
          fusion.points.push_back(old[k]);
      }
    fusion.into = joined(couples, tissue.communicator());
    return fusion;
  }


#define INSTANTIATE(dim)                                    \
  template void   age_contact(Tissue<dim> &, const double); \
  template Fusion find_fusion(const Tissue<dim> &, const double);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
