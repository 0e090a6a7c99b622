// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/near_tree.h>
#include <morula/particles/nearest.h>
#include <morula/particles/touching_points.h>

#include <algorithm>
#include <cmath>

namespace Morula
{
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
