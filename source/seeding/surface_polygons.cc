// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/seeding/closed_surface.h>
#include <morula/seeding/seeding.h>
#include <morula/seeding/well_known_text.h>


namespace Morula
{
  namespace
  {
    /** The polygons of a file, valid and with their holes turned. */
    Wkt::Body
    read_polygons(const Key<std::string> &file)
    {
      auto body = Wkt::read<Wkt::Body>(file, "POLYGON");
      // Rings are turned and closed as Boost wants them.
      Wkt::geometry::correct(body);
      std::string reason;
      if (!Wkt::geometry::is_valid(body, reason))
        Wkt::refuse(file,
                    "POLYGON",
                    "It has none that can be used: " + reason + "." +
                      (boost::contains(reason, "spikes") ?
                         " A cut of no width is no part of a surface: write "
                         "it to the file of " +
                           TissueKeys::cuts + "." :
                         ""));
      if (body.empty())
        Wkt::refuse(file, "POLYGON", "It has none that can be used.");
      return body;
    }

    /** Appends a closed line: counter-clockwise, or clockwise that of a hole.
     */
    template <typename Ring>
    void
    append(const Ring &ring, ClosedSurface<2> &surface)
    {
      // The last point repeats the first one, so it makes no vertex.
      const auto begin = static_cast<unsigned int>(surface.vertices.size());
      const auto n     = static_cast<unsigned int>(ring.size() - 1);
      for (unsigned int i = 0; i < n; ++i)
        {
          surface.vertices.emplace_back(ring[i].x(), ring[i].y());
          surface.facets.push_back({{begin + i, begin + (i + 1) % n}});
        }
    }
  } // namespace


  ClosedSurface<2>
  read_surface(const Key<std::string> &file, const std::vector<Point<2>> &cells)
  {
    const Wkt::Body body = read_polygons(file);
    refuse_outside<2>(file, cells, [&body](const Point<2> &x) {
      return Wkt::geometry::within(Wkt::Place(x[0], x[1]), body);
    });
    ClosedSurface<2> surface;
    for (const Wkt::Polygon &polygon : body)
      {
        append(polygon.outer(), surface);
        for (const auto &hole : polygon.inners())
          append(hole, surface);
      }
    return surface;
  }
} // namespace Morula
