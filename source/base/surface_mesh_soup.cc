// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/near_tree.h>
#include <morula/base/surface_mesh.h>
#include <morula/base/surface_mesh_soup.h>

#include <CGAL/IO/OBJ.h>
#include <CGAL/IO/OFF.h>
#include <CGAL/IO/PLY.h>
#include <CGAL/IO/STL.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <locale>

namespace Morula
{
  using namespace dealii;
  namespace
  {
    namespace Processing = CGAL::Polygon_mesh_processing;
    using Kernel         = MeshSoup::Kernel;

    /** Whether @p word, a blank and something else stand in a line. */
    bool
    begins_with_word(const std::string &line, const std::string &word)
    {
      return line == word || boost::algorithm::starts_with(line, word + ' ');
    }

    /** Whether CGAL's reader of a format needs a line of a text. What is
     *  dropped are remarks, and what an OBJ file says besides the surface. */
    bool
    is_needed(const std::string &line, const std::string &ending)
    {
      if (line.empty() || line[0] == '#')
        return false;
      if (ending == ".obj")
        return begins_with_word(line, "v") || begins_with_word(line, "f");
      return ending != ".ply" || !(begins_with_word(line, "comment") ||
                                   begins_with_word(line, "obj_info"));
    }

    /**
     * A text without what CGAL's readers stumble over: byte order mark, line
     * ends with a carriage return, tabs, blanks around lines, blank lines,
     * remarks, and letters of the wrong case. Names of solids go, since they
     * may be words of the format.
     */
    std::string
    plain_text(std::string text, const std::string &ending)
    {
      // The order matters: line ends become newlines before lines are joined or
      // cut.
      if (boost::algorithm::starts_with(text, "\xEF\xBB\xBF"))
        text.erase(0, 3);
      std::replace(text.begin(), text.end(), '\t', ' ');
      boost::algorithm::replace_all(text, "\r\n", "\n");
      std::replace(text.begin(), text.end(), '\r', '\n');
      if (ending == ".obj")
        boost::algorithm::replace_all(text, "\\\n", " ");
      boost::algorithm::to_lower(text, std::locale::classic());

      std::istringstream stream(text);
      std::string        result;
      for (std::string line; std::getline(stream, line);)
        {
          boost::algorithm::trim(line);
          if (!is_needed(line, ending))
            continue;
          if (ending == ".off" && result.empty())
            boost::algorithm::to_upper(line);
          if (ending == ".stl" && line.find("outer loop") == std::string::npos)
            for (const std::string word : {"solid", "endsolid"})
              if (begins_with_word(line, word))
                line = word;
          result += line + '\n';
        }
      return result;
    }

    /** What a file holds, as CGAL's readers understand it. A binary file is
     * left as it is, but for the header of a PLY file, which is text. */
    std::string
    readable(const std::string &content, const std::string &ending)
    {
      const std::string last = "end_header";
      // A text has no byte 0, a binary file of any size has.
      if (content.find('\0') == std::string::npos)
        return plain_text(content, ending);
      const auto begin = content.find(last);
      if (ending != ".ply" || begin == std::string::npos)
        // A binary STL file has no header that could be improved.
        return content;
      const std::string header = content.substr(0, begin);
      const std::size_t line_end =
        header.find("\r\n") == std::string::npos ? 1 : 2;
      return plain_text(header, ending) + last + '\n' +
             content.substr(
               std::min(begin + last.size() + line_end, content.size()));
    }

    /** Refuses an STL file that ends before its last triangle. */
    void
    check_complete(const std::string &text, const MeshSoup &soup)
    {
      // A text has no null byte, whereas the coordinates and counts of a binary
      // file always have some. Both kinds are told apart by that, as also
      // binary files may begin with the word 'solid'.
      if (text.find('\0') == std::string::npos)
        {
          if (text.find("endsolid") == std::string::npos)
            soup.refuse(
              "The file is cut off: it has no 'endsolid'. Copy or export "
              "it again.");
          return;
        }
      // A binary STL file has 80 bytes of header, the number of triangles, and
      // 50 bytes for each.
      std::uint32_t n = 0;
      if (text.size() >= 84)
        std::memcpy(&n, text.data() + 80, sizeof(n));
      const std::size_t there = text.size() < 84 ? 0 : (text.size() - 84) / 50;
      if (text.size() < 84 || there < n)
        soup.refuse("The file is cut off: it has " + std::to_string(there) +
                    " whole triangles" +
                    (text.size() < 84 ?
                       "" :
                       ", and says that it has " + std::to_string(n)) +
                    ". Copy or export it again.");
    }

    /** Lets CGAL's reader of the format @p ending append to @p soup.
     *  @returns whether it could */
    bool
    read_polygons(const std::string &text,
                  const std::string &ending,
                  MeshSoup          &soup)
    {
      // These formats may be binary; the readers then find out by themselves.
      std::istringstream stream(text, std::ios::in | std::ios::binary);
      if (ending == ".stl" || ending == ".ply")
        CGAL::IO::set_mode(stream, CGAL::IO::BINARY);
      if (ending == ".stl")
        return CGAL::IO::read_STL(stream, soup.points, soup.polygons);
      if (ending == ".ply")
        return CGAL::IO::read_PLY(stream, soup.points, soup.polygons);
      if (ending == ".obj")
        return CGAL::IO::read_OBJ(stream, soup.points, soup.polygons);
      return ending == ".off" &&
             CGAL::IO::read_OFF(stream, soup.points, soup.polygons);
    }

    /** Refuses polygons with a vertex that the file does not have, which CGAL
     *  reads in silence, and coordinates that are no numbers, or so large that
     *  areas and volumes would overflow. */
    void
    check_numbers(const MeshSoup &soup)
    {
      for (std::size_t i = 0; i < soup.polygons.size(); ++i)
        for (const std::size_t vertex : soup.polygons[i])
          if (vertex >= soup.points.size())
            soup.refuse(
              "Polygon " + std::to_string(i) +
              " (counted from 0) names a vertex that is none of the " +
              std::to_string(soup.points.size()) +
              " there: copy or export the file again.");
      for (std::size_t i = 0; i < soup.points.size(); ++i)
        {
          const Kernel::Point_3 &p = soup.points[i];
          const double           largest =
            std::max({std::abs(p.x()), std::abs(p.y()), std::abs(p.z())});
          if (std::isnan(p.x() + p.y() + p.z()) || !(largest < 1e100))
            soup.refuse("Vertex " + std::to_string(i) +
                        " (counted from 0) is at " + place(p) +
                        " um: export the surface again, in um.");
        }
    }

    /**
     * Merges vertices that differ by rounding only. Most files have been
     * through single precision, in which a vertex that was computed in two ways
     * differs by some 1e-7 of its coordinates; the digits that others write are
     * as many or more. No cell is as small. A vertex goes to the first one in
     * the file that it is near to, so that the result does not depend on the
     * order of a search.
     * @returns whether any has gone
     */
    bool
    merge_vertices(MeshSoup &soup)
    {
      std::vector<Point<3>> points;
      double                largest = 0.;
      for (const Kernel::Point_3 &p : soup.points)
        {
          points.emplace_back(p.x(), p.y(), p.z());
          for (unsigned int d = 0; d < 3; ++d)
            largest = std::max(largest, std::abs(points.back()[d]));
        }
      // Four steps of single precision, relative to the largest coordinate, as
      // that is what rounding is relative to.
      const double near = 4. * std::numeric_limits<float>::epsilon() * largest;

      const NearTree<3>        tree(points);
      std::vector<std::size_t> first(points.size());
      bool                     merged = false;
      for (std::size_t i = 0; i < points.size(); ++i)
        {
          first[i] = i;
          // Only a vertex that stays itself can be gone to.
          for (const unsigned int k : tree.within(points[i], near))
            if (k < first[i] && first[k] == k)
              first[i] = k;
          merged = merged || first[i] != i;
        }
      for (std::vector<std::size_t> &polygon : soup.polygons)
        for (std::size_t &vertex : polygon)
          vertex = first[vertex];
      return merged;
    }
  } // namespace

  void
  MeshSoup::refuse(const std::string &remedy) const
  {
    throw InputError(key,
                     name,
                     "a closed surface that does not intersect itself, as an "
                     "STL, OFF, PLY or OBJ file",
                     remedy);
  }

  MeshSoup::MeshSoup(const std::string &key, const std::string &name)
    : key(key)
    , name(name)
  {
    // CGAL reads the file and repairs the polygons, which drops what is there
    // twice or has no three corners. In between is refused what would make the
    // repair undefined: numbers of vertices that do not exist, coordinates that
    // are no numbers. Only a surface with open edges has its vertices merged:
    // one that is closed stays as it is.
    const std::string ending = boost::algorithm::to_lower_copy(
      name.substr(std::min(name.rfind('.'), name.size())));
    std::ifstream     stream(name, std::ios::binary);
    const std::string content{std::istreambuf_iterator<char>(stream), {}};
    bool              good = false;
    if (std::ifstream(name) &&
        content.find_first_not_of(" \t\r\n") == std::string::npos)
      refuse("The file is empty: copy or export it again.");
    const std::string text = readable(content, ending);
    if (ending == ".stl" && !content.empty())
      check_complete(text, *this);
    try
      {
        good = read_polygons(text, ending, *this);
      }
    catch (const std::exception &)
      {
        // A file that could not be parsed is reported below.
      }
    if (!good)
      refuse(
        "The file cannot be read: check that it exists, that its name ends "
        "with .stl, .off, .ply or .obj, that it is whole, and that it "
        "holds numbers only, with decimal points.");
    check_numbers(*this);

    Processing::repair_polygon_soup(points, polygons);
    if (polygons.empty())
      refuse("The file has no polygons: export the surface again.");
    const auto all = edges();
    if (std::any_of(all.begin(),
                    all.end(),
                    [](const auto &edge) { return edge.second < 2; }) &&
        merge_vertices(*this))
      Processing::repair_polygon_soup(points, polygons);
  }

  std::vector<std::array<Point<3>, 3>>
  read_triangles(const std::string &key, const std::string &file)
  {
    const MeshSoup soup(key, file);
    const auto     point = [&soup](const std::size_t i) {
      const Kernel::Point_3 &p = soup.points[i];
      return Point<3>(p.x(), p.y(), p.z());
    };
    std::vector<std::array<Point<3>, 3>> triangles;
    for (const std::vector<std::size_t> &polygon : soup.polygons)
      for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
        triangles.push_back(
          {{point(polygon[0]), point(polygon[i]), point(polygon[i + 1])}});
    return triangles;
  }
} // namespace Morula
