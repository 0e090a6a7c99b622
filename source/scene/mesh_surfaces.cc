// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/scene/mesh_surfaces.h>

#include <deal.II/base/tensor.h>

#include <sstream>

namespace Morula
{
  namespace
  {
    /** Six times the volume of the tetrahedron of a triangle and @p apex. */
    double
    tetrahedron(const SurfaceTriangle &triangle, const Point<3> &apex)
    {
      return (triangle.vertices[0] - apex) *
             cross_product_3d(triangle.vertices[1] - apex,
                              triangle.vertices[2] - apex);
    }
  } // namespace


  std::vector<double>
  volumes_of_surfaces(const std::vector<SurfaceTriangle> &triangles)
  {
    // Each round takes a triangle that was not seen and walks over its
    // neighbours until the closed surface is complete. The volume is a sum of
    // tetrahedra with one apex; it is negative where the normals point inwards,
    // as those of a cavity do.
    std::vector<double> volumes;
    std::vector<bool>   seen(triangles.size(), false);
    for (std::size_t first = 0; first < triangles.size(); ++first)
      {
        if (seen[first])
          continue;
        // The apex lies on the surface itself: far from the origin that loses
        // fewer digits.
        const Point<3>           apex = triangles[first].vertices[0];
        std::vector<std::size_t> open = {first};
        seen[first]                   = true;
        double sum                    = 0.;
        while (!open.empty())
          {
            const SurfaceTriangle &triangle = triangles[open.back()];
            open.pop_back();
            sum += tetrahedron(triangle, apex);
            for (const std::size_t neighbor : triangle.neighbors)
              if (!seen[neighbor])
                {
                  seen[neighbor] = true;
                  open.push_back(neighbor);
                }
          }
        volumes.push_back(sum / 6.);
      }
    return volumes;
  }


  std::string
  surfaces_text(const std::vector<double> &volumes)
  {
    unsigned int n_cavities = 0;
    double       cavities   = 0.;
    for (const double volume : volumes)
      if (volume < 0.)
        {
          ++n_cavities;
          cavities -= volume;
        }
    std::ostringstream text;
    text.precision(4);
    text << volumes.size()
         << (volumes.size() == 1 ? " closed surface" : " closed surfaces");
    if (n_cavities == 1)
      text << ", 1 of them the wall of a cavity of " << cavities << " um^3";
    if (n_cavities > 1)
      text << ", " << n_cavities << " of them the walls of cavities, together "
           << cavities << " um^3";
    return text.str();
  }
} // namespace Morula
