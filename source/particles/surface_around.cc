// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/particles/point_exchange.h>
#include <morula/particles/surface_around.h>

#include <algorithm>

namespace Morula
{
  template <int dim>
  GridBox<dim>
  box_around(const std::vector<Point<dim>> &positions, const double spacing)
  {
    Point<dim> lower = positions.at(0), upper = positions.at(0);
    for (const Point<dim> &x : positions)
      for (unsigned int d = 0; d < dim; ++d)
        {
          lower[d] = std::min(lower[d], x[d]);
          upper[d] = std::max(upper[d], x[d]);
        }
    GridIndex<dim> n;
    for (unsigned int d = 0; d < dim; ++d)
      n[d] = static_cast<int>((upper[d] - lower[d]) / spacing) + 1;
    return {{}, n, spacing, lower};
  }


  template <int dim>
  SurfaceAround<dim>::SurfaceAround(const Tissue<dim> &tissue,
                                    const double       reach)
  {
    const BoundaryPoints<dim> &store = tissue.boundary_points();
    PointList<dim>             list;
    for (unsigned int k = 0; k < store.size(); ++k)
      list.add(store.id(k), store.position(k), {});
    list.append(halo(list, tissue.grid(), reach));
    points = list.positions;
    if (points.empty())
      return;
    box  = std::make_unique<const GridBox<dim>>(box_around(points, reach));
    bins = std::make_unique<const PointBins<dim>>(*box, points);
  }


  template <int dim>
  bool
  SurfaceAround<dim>::is_within(const Point<dim> &x, const double radius) const
  {
    bool found = false;
    if (bins)
      bins->visit_within(x, radius, [&](const unsigned int) { found = true; });
    return found;
  }


  MORULA_INSTANTIATE(box_around);
  template class SurfaceAround<2>;
  template class SurfaceAround<3>;
} // namespace Morula
