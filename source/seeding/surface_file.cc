// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/surface_mesh.h>
#include <morula/seeding/surface_file.h>

#include <array>
#include <map>
#include <sstream>

namespace Morula
{
  template <int dim>
  void
  refuse_outside(const Key<std::string>                        &file,
                 const std::vector<Point<dim>>                 &cells,
                 const std::function<bool(const Point<dim> &)> &is_inside)
  {
    std::size_t        n = 0;
    std::ostringstream first;
    // The message names the first of them and says how many there are: that
    // tells a shift from a cell or two that stand astray.
    for (const Point<dim> &x : cells)
      if (!is_inside(x) && n++ == 0)
        first << x;
    if (n > 0)
      file.refuse("a surface in um with all cells of Tissue/Points file "
                  "inside",
                  std::to_string(n) + " of " + std::to_string(cells.size()) +
                    " cells stand outside, the first at (" + first.str() +
                    ") um: do both files have the same origin and unit? Else "
                    "remove these cells, or widen the surface.");
  }


  ClosedSurface<3>
  read_surface(const Key<std::string> &file, const std::vector<Point<3>> &cells)
  {
    const SurfaceMesh mesh(file.path(), file);
    refuse_outside<3>(file, cells, [&mesh](const Point<3> &x) {
      return mesh.contains(x, 0.);
    });
    // Triangles have points, the surface has numbers of vertices: equal
    // coordinates are one vertex.
    ClosedSurface<3>                              surface;
    std::map<std::array<double, 3>, unsigned int> number_of;
    for (const SurfaceTriangle &triangle : mesh.triangles())
      {
        std::array<unsigned int, 3> facet;
        for (unsigned int i = 0; i < 3; ++i)
          {
            const Point<3> &x = triangle.vertices[i];
            const auto [found, is_new] =
              number_of.emplace(std::array<double, 3>{{x[0], x[1], x[2]}},
                                static_cast<unsigned int>(number_of.size()));
            if (is_new)
              surface.vertices.push_back(x);
            facet[i] = found->second;
          }
        surface.facets.push_back(facet);
      }
    return surface;
  }


  MORULA_INSTANTIATE(refuse_outside);
} // namespace Morula
