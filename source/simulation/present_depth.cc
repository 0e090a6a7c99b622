// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/state/surface_distance.h>
#include <morula/simulation/present_depth.h>

#include <vector>

namespace Morula
{
  template <int dim>
  void
  set_present_depth(Tissue<dim> &tissue, const StateColumns<dim> &state)
  {
    // All ranks have the column or none has, so that all come to the search,
    // which gathers the surface on every rank.
    if (!state.present_depth.exists())
      return;
    const Cells<dim>           &cells  = tissue.cells();
    const BoundaryPoints<dim>  &points = tissue.boundary_points();
    std::vector<Point<dim>>     places, at;
    std::vector<Tensor<1, dim>> normals;
    for (unsigned int p = 0; p < cells.size(); ++p)
      places.push_back(cells.position(p));
    for (unsigned int p = 0; p < points.size(); ++p)
      {
        const Tensor<1, dim> area = points[p].area_vector();
        at.push_back(points.position(p));
        normals.push_back(area / area.norm());
      }
    const auto near = near_surface(places, at, normals, tissue.communicator());
    for (unsigned int p = 0; p < cells.size(); ++p)
      tissue.cell(p).set(state.present_depth, near[p].depth);
  }


  template void
  set_present_depth(Tissue<2> &, const StateColumns<2> &);
  template void
  set_present_depth(Tissue<3> &, const StateColumns<3> &);
} // namespace Morula
