// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/seeding/surface_file.h>

#include <boost/algorithm/string.hpp>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/multi_polygon.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>

#include <algorithm>
#include <fstream>
#include <iterator>

namespace Morula
{
  namespace
  {
    namespace geometry = boost::geometry;

    using Place = geometry::model::d2::point_xy<double>;
    // Rings go counter-clockwise, and their last point is the first one again.
    using Polygon = geometry::model::polygon<Place, false>;
    using Body    = geometry::model::multi_polygon<Polygon>;

    /** The polygons of a file, valid and with their holes turned. */
    Body
    read_polygons(const Key<std::string> &file)
    {
      // The text is brought into the form that Boost reads, read as one polygon
      // or as many, and then put right or refused. One polygon becomes a list
      // of one, so that the rest knows a single kind.
      std::ifstream stream(file.value());
      std::string   text{std::istreambuf_iterator<char>(stream), {}};
      // Boost takes blanks for the ends of words, and no other white space.
      std::replace_if(text.begin(), text.end(), boost::is_space(), ' ');
      boost::trim(text);
      const auto refuse = [&file](const std::string &why) {
        file.refuse("a file with one POLYGON or MULTIPOLYGON of well-known "
                    "text (WKT) in um",
                    why + " Correct the file, or write it anew.");
      };
      Body body;
      try
        {
          if (boost::istarts_with(text, "polygon"))
            {
              body.resize(1);
              geometry::read_wkt(text, body[0]);
            }
          else
            geometry::read_wkt(text, body);
        }
      catch (const geometry::exception &error)
        {
          // What Boost says of the text, without the text itself, which may be
          // long.
          const std::string reason = error.what();
          refuse("It cannot be read as such: " +
                 reason.substr(0, reason.find(" in '")) + ".");
        }
      // Rings are turned and closed as Boost wants them.
      geometry::correct(body);
      std::string reason;
      if (!geometry::is_valid(body, reason))
        refuse("It has none that can be used: " + reason + ".");
      if (body.empty())
        refuse("It has none that can be used.");
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
    const Body body = read_polygons(file);
    refuse_outside<2>(file, cells, [&body](const Point<2> &x) {
      return geometry::within(Place(x[0], x[1]), body);
    });
    ClosedSurface<2> surface;
    for (const Polygon &polygon : body)
      {
        append(polygon.outer(), surface);
        for (const auto &hole : polygon.inners())
          append(hole, surface);
      }
    return surface;
  }
} // namespace Morula
