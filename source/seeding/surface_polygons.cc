// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/seeding/closed_surface.h>

#include <boost/algorithm/string.hpp>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/linestring.hpp>
#include <boost/geometry/geometries/multi_linestring.hpp>
#include <boost/geometry/geometries/multi_polygon.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <boost/lexical_cast.hpp>

#include <array>
#include <cctype>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace Morula
{
  /** Plane shapes of files as well-known text (WKT), which Boost.Geometry
   *  reads. Coordinates in µm. */
  namespace
  {
    namespace geometry = boost::geometry;

    using Place = geometry::model::d2::point_xy<double>;
    // Rings go counter-clockwise, and their last point is the first one again.
    using Polygon   = geometry::model::polygon<Place, false>;
    using Body      = geometry::model::multi_polygon<Polygon>;
    using Line      = geometry::model::linestring<Place>;
    using ManyLines = geometry::model::multi_linestring<Line>;

    /** Refuses the file. @param kind POLYGON, ... @param why and a full stop */
    [[noreturn]] void
    refuse(const Key<std::string> &file,
           const std::string      &kind,
           const std::string      &why)
    {
      file.refuse("a file with one " + kind + " or MULTI" + kind +
                    " of well-known text (WKT) in um",
                  why + " Correct the file, or write it anew.");
    }

    /** Refuses points without exactly two finite coordinates: Boost takes a
     *  third one for the next point's first. */
    void
    check_points(const Key<std::string> &file,
                 const std::string      &kind,
                 const std::string      &text)
    {
      // What stands between two signs is a point, or words without numbers.
      std::vector<std::string> points;
      boost::split(points, text, boost::is_any_of("(),"));
      for (std::string &point : points)
        {
          boost::trim(point);
          std::vector<std::string> numbers;
          boost::split(numbers,
                       point,
                       boost::is_space(),
                       boost::token_compress_on);
          const std::string wrong = "At '" + point.substr(0, 60) + "' ";
          if (point.empty() || std::isalpha(point[0]) != 0)
            {
              if (boost::istarts_with(point, "nan") ||
                  boost::istarts_with(point, "inf"))
                refuse(file, kind, wrong + "there is no number.");
              continue;
            }
          if (numbers.size() != 2)
            refuse(file, kind, wrong + "there are not two coordinates.");
          for (const std::string &number : numbers)
            {
              double value = 0.;
              if (!boost::conversion::try_lexical_convert(number, value) ||
                  !std::isfinite(value))
                refuse(file, kind, wrong + "there is no number.");
            }
        }
    }

    /** The shapes of a file, of which there may be one or many.
     *  @param kind POLYGON or LINESTRING
     *  @throws InputError if the text is none */
    template <typename Many>
    Many
    read_shapes(const Key<std::string> &file, const std::string &kind)
    {
      // The text is brought into the form that Boost reads, read as one shape
      // or as many. One shape becomes a list of one, so that the rest knows a
      // single kind.
      std::ifstream stream(file.value());
      std::string   text{std::istreambuf_iterator<char>(stream), {}};
      // Boost takes blanks for the ends of words, and no other white space.
      std::replace_if(text.begin(), text.end(), boost::is_space(), ' ');
      boost::trim(text);
      check_points(file, kind, text);
      Many shapes;
      try
        {
          if (boost::istarts_with(text, kind))
            {
              shapes.resize(1);
              geometry::read_wkt(text, shapes[0]);
            }
          else
            geometry::read_wkt(text, shapes);
        }
      catch (const geometry::exception &error)
        {
          // What Boost says of the text, without the text itself, which may be
          // long.
          const std::string reason = error.what();
          refuse(file,
                 kind,
                 "It cannot be read as such: " +
                   reason.substr(0, reason.find(" in '")) + ".");
        }
      return shapes;
    }

    /** The polygons of a file, valid and with their holes turned. */
    Body
    read_polygons(const Key<std::string> &file)
    {
      auto body = read_shapes<Body>(file, "POLYGON");
      // Rings are turned and closed as Boost wants them.
      geometry::correct(body);
      std::string reason;
      if (!geometry::is_valid(body, reason))
        refuse(file,
               "POLYGON",
               "It has none that can be used: " + reason + "." +
                 (boost::contains(reason, "spikes") ?
                    " A cut of no width is no part of a surface: write "
                    "it to the file of " +
                      TissueKeys::cuts + "." :
                    ""));
      if (body.empty())
        refuse(file, "POLYGON", "It has none that can be used.");
      return body;
    }

    template <typename Ring>
    std::vector<Point<2>>
    points_of(const Ring &ring)
    {
      std::vector<Point<2>> points;
      for (const Place &place : ring)
        points.emplace_back(place.x(), place.y());
      return points;
    }
  } // namespace


  std::vector<SurfacePatch<2>>
  patches_of_file(const Key<std::string> &file,
                  const Founders<2>      &founders,
                  const double            n_wished,
                  const MPI_Comm          comm)
  {
    Body body;
    everywhere(comm, [&]() { body = read_polygons(file); });
    std::vector<std::vector<Point<2>>> lines;
    for (const Polygon &polygon : body)
      {
        lines.push_back(points_of(polygon.outer()));
        for (const auto &hole : polygon.inners())
          lines.push_back(points_of(hole));
      }
    const double length = geometry::perimeter(body);
    const double n      = n_patches<2>(
      file,
      founders,
      [&](const Point<2> &x) {
        return geometry::within(Place(x[0], x[1]), body);
      },
      length,
      n_wished,
      comm);
    return cut_into_patches(lines, length / n);
  }


  std::vector<std::array<Point<2>, 2>>
  read_segments(const Key<std::string> &file)
  {
    std::vector<std::array<Point<2>, 2>> segments;
    for (const Line &line : read_shapes<ManyLines>(file, "LINESTRING"))
      {
        const std::vector<Point<2>> points = points_of(line);
        for (std::size_t i = 0; i + 1 < points.size(); ++i)
          segments.push_back({{points[i], points[i + 1]}});
      }
    return segments;
  }
} // namespace Morula
