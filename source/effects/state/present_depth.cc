// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/expression_key.h>
#include <morula/effects/state/present_depth.h>
#include <morula/effects/state/surface_distance.h>

#include <vector>

namespace Morula
{
  void
  PresentDepthParameters::see(const SceneKeys &,
                              const std::vector<ExpressionKey *> &keys)
  {
    // Whether the variable is really read is known when the expressions are
    // parsed: then the column is there. The word may stand in a key of an
    // effect that is off.
    for (const ExpressionKey *key : keys)
      is_used =
        is_used || key->text().find("present_depth") != std::string::npos;
  }


  template <int dim>
  void
  PresentDepth<dim>::surfaced(Tissue<dim>            &tissue,
                              const MomentOfRun<dim> &moment) const
  {
    // All ranks have the column or none has, so that all come to the search,
    // which gathers the surface on every rank.
    const Column<double> column = moment.reader.columns.present_depth;
    if (!column.exists())
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
      tissue.cell(p).set(column, near[p].depth);
  }


  template class PresentDepth<2>;
  template class PresentDepth<3>;
} // namespace Morula
