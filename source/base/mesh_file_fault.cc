// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/mesh_file_fault.h>

#include <boost/algorithm/string.hpp>
#include <boost/lexical_cast/try_lexical_convert.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <sstream>
#include <vector>

namespace Morula::MeshFile
{
  namespace
  {
    /** A line of a text that is neither blank nor a remark. */
    struct Line
    {
      std::size_t              number; // from 1
      std::string              text;
      std::vector<std::string> words; // in small letters
    };

    std::vector<Line>
    lines_of(std::string text, const bool joins)
    {
      // Line ends of all systems become one kind first. A line that ends with a
      // backslash goes on in the next one, where the format has that.
      if (boost::algorithm::starts_with(text, "\xEF\xBB\xBF"))
        text.erase(0, 3);
      boost::algorithm::replace_all(text, "\r\n", "\n");
      std::replace(text.begin(), text.end(), '\r', '\n');
      std::vector<Line>  lines;
      std::istringstream stream(text);
      std::size_t        number = 0;
      for (std::string line; std::getline(stream, line);)
        {
          const std::size_t first = ++number;
          std::string       more;
          while (joins && boost::algorithm::ends_with(line, "\\") &&
                 std::getline(stream, more))
            {
              line.back() = ' ';
              line += more;
              ++number;
            }
          line = boost::algorithm::trim_copy(line.substr(0, line.find('#')));
          if (line.empty())
            continue;
          Line found{first, line, {}};
          boost::algorithm::split(found.words,
                                  boost::algorithm::to_lower_copy(line),
                                  boost::algorithm::is_space(),
                                  boost::algorithm::token_compress_on);
          lines.push_back(std::move(found));
        }
      return lines;
    }

    std::string
    begin_of(const Line &line)
    {
      constexpr std::size_t longest = 60;
      return "line " + std::to_string(line.number) + ", '" +
             line.text.substr(0, longest) +
             (line.text.size() > longest ? "...'" : "'");
    }

    std::string
    no_vertex(const Line &line)
    {
      return begin_of(line) + ", is no vertex of three finite numbers.";
    }

    std::string
    no_face(const Line &line)
    {
      return begin_of(line) + ", is no polygon of three vertices or more.";
    }

    std::string
    no_such_vertex(const std::string &where,
                   const std::string &vertex,
                   const std::size_t  n)
    {
      return where + ", names vertex " + vertex + ", which is none of the " +
             std::to_string(n) + " there.";
    }

    std::string
    ends_early(const std::size_t  done,
               const std::size_t  n,
               const std::string &records)
    {
      return "it ends after " + std::to_string(done) + " of the " +
             std::to_string(n) + " records '" + records +
             "' that its beginning promises: copy or export it again.";
    }

    bool
    is_finite(const std::string &word)
    {
      double value = 0.;
      return boost::conversion::try_lexical_convert(word, value) &&
             std::isfinite(value);
    }

    std::optional<std::int64_t>
    whole(const std::string &word)
    {
      std::int64_t value = 0;
      if (boost::conversion::try_lexical_convert(word, value))
        return value;
      return {};
    }

    /** Whether three finite numbers stand in a line, from a word on. */
    bool
    is_vertex(const Line &line, const std::size_t first)
    {
      const auto &words = line.words;
      return words.size() >= first + 3 &&
             std::all_of(words.begin() + static_cast<std::ptrdiff_t>(first),
                         words.begin() + static_cast<std::ptrdiff_t>(first + 3),
                         is_finite);
    }

    /** The fault of a line with the number of corners and the corners, from a
     *  word on. */
    std::string
    fault_of_polygon(const Line       &line,
                     const std::size_t first,
                     const std::size_t n_vertices)
    {
      const std::optional<std::int64_t> n =
        line.words.size() > first ? whole(line.words[first]) : std::nullopt;
      if (!n || *n < 3 ||
          line.words.size() < first + 1 + static_cast<std::size_t>(*n))
        return no_face(line);
      for (std::size_t i = 1; i <= static_cast<std::size_t>(*n); ++i)
        {
          const auto vertex = whole(line.words[first + i]);
          if (!vertex)
            return no_face(line);
          if (*vertex < 0 || static_cast<std::size_t>(*vertex) >= n_vertices)
            return no_such_vertex(begin_of(line),
                                  line.words[first + i] + " (from 0)",
                                  n_vertices);
        }
      return "";
    }

    std::string
    fault_in_obj(const std::string &content)
    {
      // Polygons may name vertices that come later, so these are counted first.
      // A negative number counts back from the line.
      const std::vector<Line> lines = lines_of(content, true);
      std::int64_t            n     = 0;
      for (const Line &line : lines)
        if (line.words[0] == "v")
          {
            if (!is_vertex(line, 1))
              return no_vertex(line);
            ++n;
          }
      std::int64_t so_far = 0;
      for (const Line &line : lines)
        if (line.words[0] == "v")
          ++so_far;
        else if (line.words[0] == "f")
          {
            if (line.words.size() < 4)
              return no_face(line);
            for (std::size_t i = 1; i < line.words.size(); ++i)
              {
                const std::string &word = line.words[i];
                const auto vertex       = whole(word.substr(0, word.find('/')));
                if (!vertex)
                  return no_face(line);
                if (*vertex == 0 || *vertex > n || *vertex < -so_far)
                  return no_such_vertex(begin_of(line),
                                        std::to_string(*vertex) + " (from 1)",
                                        static_cast<std::size_t>(n));
              }
          }
      return "";
    }

    std::string
    fault_in_off(const std::string &content)
    {
      // The first line is the word OFF, which may have letters before it, and
      // perhaps the numbers of vertices and polygons; these come next.
      const std::vector<Line> lines = lines_of(content, false);
      std::size_t             at = 0, word = 0;
      if (!lines.empty() &&
          boost::algorithm::ends_with(lines[0].words[0], "off"))
        {
          word = lines[0].words.size() > 1 ? 1 : 0;
          at   = 1 - word;
        }
      if (at >= lines.size() || lines[at].words.size() < word + 2)
        return "it does not say how many vertices and polygons it has.";
      const auto n_vertices = whole(lines[at].words[word]);
      const auto n_polygons = whole(lines[at].words[word + 1]);
      if (!n_vertices || !n_polygons || *n_vertices < 0 || *n_polygons < 0)
        return begin_of(lines[at]) +
               ", does not say how many vertices and polygons there are.";
      const auto nv = static_cast<std::size_t>(*n_vertices),
                 nf = static_cast<std::size_t>(*n_polygons);
      ++at;
      for (std::size_t i = 0; i < nv + nf; ++i, ++at)
        {
          if (at >= lines.size())
            return i < nv ? ends_early(i, nv, "vertex") :
                            ends_early(i - nv, nf, "face");
          if (i < nv && !is_vertex(lines[at], 0))
            return no_vertex(lines[at]);
          if (i < nv)
            continue;
          if (const auto fault = fault_of_polygon(lines[at], 0, nv);
              !fault.empty())
            return fault;
        }
      return "";
    }

    std::string
    fault_in_stl(const std::string &content)
    {
      std::size_t n = 0;
      for (const Line &line : lines_of(content, false))
        {
          const std::string &word = line.words[0];
          if (word == "vertex" && !is_vertex(line, 1))
            return no_vertex(line);
          if (word == "endloop" && n != 3)
            return begin_of(line) + ", ends a polygon of " + std::to_string(n) +
                   " vertices, and STL has triangles only.";
          n = word == "vertex" ? n + 1 : word == "outer" ? 0 : n;
        }
      return "";
    }

    /** A property of a PLY file's element: a number, or a list of numbers. */
    struct Property
    {
      std::string name;
      std::size_t bytes;  // of a number
      std::size_t counts; // bytes of the number of entries; 0: no list
    };

    struct Element
    {
      std::string           name;
      std::size_t           n = 0;
      std::vector<Property> properties;
    };

    struct PlyHeader
    {
      std::string          format;
      std::vector<Element> elements;
      std::string          fault;
    };

    /** The bytes of a number of a PLY file; 0 for another word. */
    std::size_t
    bytes_of(const std::string &type)
    {
      static const std::map<std::string, std::size_t> bytes = {{"char", 1},
                                                               {"uchar", 1},
                                                               {"int8", 1},
                                                               {"uint8", 1},
                                                               {"short", 2},
                                                               {"ushort", 2},
                                                               {"int16", 2},
                                                               {"uint16", 2},
                                                               {"int", 4},
                                                               {"uint", 4},
                                                               {"int32", 4},
                                                               {"uint32", 4},
                                                               {"float", 4},
                                                               {"float32", 4},
                                                               {"double", 8},
                                                               {"float64", 8},
                                                               {"int64", 8},
                                                               {"uint64", 8}};
      const auto                                      found = bytes.find(type);
      return found == bytes.end() ? 0 : found->second;
    }

    PlyHeader
    ply_header(const std::vector<Line> &lines)
    {
      // A header lists elements, each with a line of its own, and then the
      // properties of the last one, in the order of their values in a row. A
      // list says the type of its length before that of its entries. What is
      // no such line ends the reading, as the rest cannot be trusted.
      PlyHeader header;
      for (const Line &line : lines)
        {
          const auto &words = line.words;
          const auto  n     = words.size();
          if (words[0] == "end_header")
            return header;
          if (words[0] == "format" && n > 1)
            header.format = words[1];
          else if (words[0] == "element" && n > 2 && whole(words[2]) &&
                   *whole(words[2]) >= 0)
            header.elements.push_back(
              {words[1], static_cast<std::size_t>(*whole(words[2])), {}});
          else if (words[0] == "property" && !header.elements.empty() &&
                   n == 3 && bytes_of(words[1]) > 0)
            header.elements.back().properties.push_back(
              {words[2], bytes_of(words[1]), 0});
          else if (words[0] == "property" && !header.elements.empty() &&
                   n == 5 && words[1] == "list" && bytes_of(words[2]) > 0 &&
                   bytes_of(words[3]) > 0)
            header.elements.back().properties.push_back(
              {words[4], bytes_of(words[3]), bytes_of(words[2])});
          else if (words[0] != "ply" && words[0] != "comment" &&
                   words[0] != "obj_info")
            {
              header.fault = begin_of(line) + ", is no line of a PLY header.";
              return header;
            }
        }
      header.fault = "its header has no end: there is no line 'end_header'.";
      return header;
    }

    std::size_t
    vertices_of(const PlyHeader &header)
    {
      for (const Element &element : header.elements)
        if (element.name == "vertex")
          return element.n;
      return 0;
    }

    /** The place of a property among those of an element; that of no list. */
    std::optional<std::size_t>
    place_of(const Element &element, const std::string &name)
    {
      for (std::size_t i = 0; i < element.properties.size(); ++i)
        if (element.properties[i].name == name)
          return i;
      return {};
    }

    std::string
    fault_in_ply_text(const PlyHeader         &header,
                      const std::vector<Line> &lines,
                      std::size_t              at)
    {
      for (const Element &element : header.elements)
        for (std::size_t i = 0; i < element.n; ++i, ++at)
          {
            if (at >= lines.size())
              return ends_early(i, element.n, element.name);
            if (element.name == "vertex")
              for (const std::string name : {"x", "y", "z"})
                {
                  const auto place = place_of(element, name);
                  if (!place || *place >= lines[at].words.size() ||
                      !is_finite(lines[at].words[*place]))
                    return no_vertex(lines[at]);
                }
            // Only where the list comes first is its place known.
            if (element.name == "face" && !element.properties.empty() &&
                element.properties[0].counts > 0)
              if (const auto fault =
                    fault_of_polygon(lines[at], 0, vertices_of(header));
                  !fault.empty())
                return fault;
          }
      return "";
    }

    /** A whole number of a binary file. */
    std::uint64_t
    number_at(const std::string &content,
              const std::size_t  at,
              const std::size_t  bytes,
              const bool         big_end)
    {
      std::uint64_t value = 0;
      for (std::size_t i = 0; i < bytes; ++i)
        value = 256 * value + static_cast<unsigned char>(
                                content[big_end ? at + i : at + bytes - 1 - i]);
      return value;
    }

    std::string
    fault_in_ply_bytes(const PlyHeader   &header,
                       const std::string &content,
                       std::size_t        at)
    {
      // Records are walked through one by one, as lists have lengths of their
      // own. Vertices that are no numbers are found by the caller.
      const bool  big = header.format == "binary_big_endian";
      const auto  n   = vertices_of(header);
      std::size_t end = at;
      for (const Element &element : header.elements)
        for (std::size_t i = 0; i < element.n; ++i)
          for (const Property &property : element.properties)
            {
              std::size_t entries = 1;
              if ((end = at + property.counts) > content.size())
                return ends_early(i, element.n, element.name);
              if (property.counts > 0)
                entries = number_at(content, at, property.counts, big);
              at = end;
              if (entries > (content.size() - at) / property.bytes)
                return ends_early(i, element.n, element.name);
              end = at + entries * property.bytes;
              for (; at < end; at += property.bytes)
                if (element.name == "face" && property.counts > 0 &&
                    boost::algorithm::starts_with(property.name, "vertex_ind"))
                  if (const auto vertex =
                        number_at(content, at, property.bytes, big);
                      vertex >= n)
                    return no_such_vertex("face " + std::to_string(i) +
                                            " (from 0)",
                                          std::to_string(vertex) + " (from 0)",
                                          n);
            }
      return "";
    }

    std::string
    fault_in_ply(const std::string &content)
    {
      // The header is a text in both kinds, and says which one it is.
      const std::string last = "end_header";
      const auto        end  = content.find(last);
      const auto        length =
        end == std::string::npos ? content.size() : end + last.size();
      const auto      lines  = lines_of(content.substr(0, length), false);
      const PlyHeader header = ply_header(lines);
      if (!header.fault.empty())
        return header.fault;
      if (header.format == "ascii")
        return fault_in_ply_text(header,
                                 lines_of(content, false),
                                 lines.size());
      if (header.format.rfind("binary", 0) != 0)
        return "its header names no format that is known: ascii, "
               "binary_little_endian or binary_big_endian.";
      const std::size_t begin =
        length + (content.compare(length, 2, "\r\n") == 0 ? 2 : 1);
      return fault_in_ply_bytes(header,
                                content,
                                std::min(begin, content.size()));
    }
  } // namespace


  std::string
  fault_in(const std::string &content, const std::string &ending)
  {
    // A binary file has a byte 0 somewhere. Only PLY files of that kind are
    // looked into: those of STL have no numbers of vertices, and their length
    // is compared elsewhere.
    const bool is_text = content.find('\0') == std::string::npos;
    if (ending == ".ply")
      return fault_in_ply(content);
    if (!is_text)
      return "";
    if (ending == ".obj")
      return fault_in_obj(content);
    if (ending == ".off")
      return fault_in_off(content);
    return ending == ".stl" ? fault_in_stl(content) : "";
  }
} // namespace Morula::MeshFile
