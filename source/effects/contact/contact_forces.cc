// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/near_tree.h>
#include <morula/base/send_records.h>
#include <morula/effects/contact/contact_forces.h>
#include <morula/particles/nearest.h>

#include <algorithm>
#include <map>

namespace Morula
{
  template <int dim>
  std::vector<ContactForce<dim>>
  contact_forces(const ContactPoints<dim>  &points,
                 const ContactPairs<dim>   &pairs,
                 const std::vector<double> &u,
                 const MPI_Comm             comm)
  {
    // A rank knows the forces of its pairs, also on points of other ranks. They
    // go to the owners of the points, which add up what comes from several
    // ranks in the order of these.
    std::map<unsigned int, std::vector<ContactForce<dim>>> by_owner;
    for (const ContactForce<dim> &one : pairs.forces(u))
      {
        const ContactPoint<dim> &point = points.points()[one.p];
        by_owner[point.owner].push_back(one);
        by_owner[point.owner].back().p = point.p;
      }
    std::map<std::pair<unsigned int, unsigned int>, ContactForce<dim>> sums;
    for (const auto &[rank, list] : send_records(by_owner, comm))
      for (const ContactForce<dim> &one : list)
        {
          const auto [sum, is_new] =
            sums.emplace(std::make_pair(one.p, one.other), one);
          if (!is_new)
            {
              sum->second.force += one.force;
              sum->second.touches |= one.touches;
            }
        }
    std::vector<ContactForce<dim>> result;
    for (const auto &[key, sum] : sums)
      result.push_back(sum);
    return result;
  }


  template <int dim>
  std::vector<double>
  contact_pressures(const Tissue<dim>                    &tissue,
                    const std::vector<ContactForce<dim>> &forces)
  {
    // Every point tells its area and the normal force on it. A tree finds those
    // around a point, which are summed by id, so that nothing depends on ranks.
    // The areas are those at t, which a step of growth changes: what the
    // point's own patch has become since then stands for its surroundings.
    const BoundaryPoints<dim> &store = tissue.boundary_points();
    std::vector<double>        of_points(store.size(), 0.);
    for (const ContactForce<dim> &one : forces)
      of_points[one.p] -= one.force * one.area / one.area.norm();
    std::vector<Point<dim>>   queries;
    std::vector<unsigned int> loaded;
    std::vector<double>       widening;
    for (const ContactForce<dim> &one : forces)
      if (loaded.empty() || loaded.back() != one.p)
        {
          loaded.push_back(one.p);
          widening.push_back(one.area.norm() / store.area_vector(one.p).norm());
          queries.push_back(store.position(one.p));
        }
    const auto numbers = [&](const unsigned int p, std::vector<double> &list) {
      list.push_back(of_points[p]);
      append_flat(list, store.area_vector(p));
      list.push_back(store.body(p));
    };
    const PointList<dim> near = near_points(
      queries, store, {2 + dim, numbers, Ties::lowest_id}, tissue.grid(), 1);
    const NearTree<dim> tree(near.positions);
    const double        radius = 0.5 * tissue.grid().box().spacing();

    std::vector<double> pressures(store.size(), 0.);
    for (std::size_t k = 0; k < loaded.size(); ++k)
      {
        std::vector<unsigned int> around = tree.within(queries[k], radius);
        std::sort(around.begin(),
                  around.end(),
                  [&](const unsigned int i, const unsigned int j) {
                    return near.ids[i] < near.ids[j];
                  });
        double force = 0., area = 0.;
        for (const unsigned int i : around)
          if (const auto around = Flat<Tensor<1, dim>>::read(&near.row(i)[1]);
              near.row(i)[1 + dim] == store.body(loaded[k]) &&
              (!store.has_parts() ||
               around * store.area_vector(loaded[k]) > 0.))
            {
              force += near.row(i)[0];
              area += around.norm();
            }
        pressures[loaded[k]] = force / (area * widening[k]);
      }
    return pressures;
  }


#define INSTANTIATE(dim)                                  \
  template std::vector<ContactForce<dim>> contact_forces( \
    const ContactPoints<dim> &,                           \
    const ContactPairs<dim> &,                            \
    const std::vector<double> &,                          \
    const MPI_Comm);                                      \
  template std::vector<double> contact_pressures(         \
    const Tissue<dim> &, const std::vector<ContactForce<dim>> &);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
