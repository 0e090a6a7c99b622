// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/near_tree.h>
#include <morula/effects/contact/fusion.h>
#include <morula/particles/nearest.h>

#include <deal.II/base/mpi.templates.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace Morula
{
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
  Fusions
  bodies_to_fuse(const Tissue<dim> &tissue, const double time)
  {
    // Points that have been touched long enough look for such points of other
    // bodies within half a grid spacing, also on other ranks. All ranks learn
    // all couples of bodies and join them alike: the lower number wins, and
    // couples are gone through until nothing changes, as three may meet at
    // once.
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
    const double        reach = 0.5 * tissue.grid().box().spacing();
    std::vector<std::pair<unsigned int, unsigned int>> couples;
    for (std::size_t k = 0; k < old.size(); ++k)
      {
        const unsigned int body = store.body(old[k]);
        for (const unsigned int i : tree.within(queries[k], reach))
          {
            const double *const row   = near.row(i).data();
            const auto          other = static_cast<unsigned int>(row[0]);
            if (other > body && row[1] >= time &&
                store.area_vector(old[k]) *
                    Flat<Tensor<1, dim>>::read(row + 2) <
                  0.)
              couples.emplace_back(body, other);
          }
      }
    std::sort(couples.begin(), couples.end());
    couples.erase(std::unique(couples.begin(), couples.end()), couples.end());
    std::vector<unsigned int> mine;
    for (const auto &[a, b] : couples)
      {
        mine.push_back(a);
        mine.push_back(b);
      }
    Fusions    into;
    const auto root = [&](unsigned int body) {
      while (into.count(body) > 0)
        body = into.at(body);
      return body;
    };
    for (const auto &list :
         Utilities::MPI::all_gather(tissue.communicator(), mine))
      for (std::size_t k = 0; k < list.size(); k += 2)
        {
          const unsigned int a = root(list[k]), b = root(list[k + 1]);
          if (a != b)
            into[std::max(a, b)] = std::min(a, b);
        }
    for (auto &[body, target] : into)
      target = root(target);
    return into;
  }


  template <int dim>
  void
  fuse(const Fusions &fusions, Tissue<dim> &tissue)
  {
    // The stores sort points by body, so that all are placed anew.
    const auto renamed = [&](PointList<dim>              points,
                             const Column<unsigned int> &column) {
      for (std::size_t i = 0; i < points.size(); ++i)
        if (const auto found = fusions.find(column.get(points.row(i)));
            found != fusions.end())
          column.set(points.row(i), found->second);
      return points;
    };
    PointList<dim> cells =
      renamed(tissue.cells().copy(), tissue.cells().columns().body);
    PointList<dim> points = renamed(tissue.boundary_points().copy(),
                                    tissue.boundary_points().columns().body);
    tissue.place(std::move(cells), std::move(points));
  }


#define INSTANTIATE(dim)                                              \
  template void    age_contact(Tissue<dim> &, const double);          \
  template Fusions bodies_to_fuse(const Tissue<dim> &, const double); \
  template void    fuse(const Fusions &, Tissue<dim> &);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
