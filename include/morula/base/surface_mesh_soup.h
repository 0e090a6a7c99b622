// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_surface_mesh_soup_h
#define morula_base_surface_mesh_soup_h

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace Morula
{
  /** The polygons of a mesh's file, which does not say which ones are
   *  neighbours. Only surface_mesh.cc uses it, as this header includes CGAL's.
   */
  struct MeshSoup
  {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

    /**
     * Reads STL, OFF, PLY or OBJ, by the file's ending. Coinciding vertices are
     * merged; if the surface is open otherwise, also those that differ by
     * rounding.
     * @param key path of the key that names the file
     * @throws InputError for a file that cannot be read, is cut off or empty,
     * or has coordinates that are no finite numbers
     */
    MeshSoup(const std::string &key, const std::string &name);

    /** Throws an InputError that says what a mesh must be.
     *  @param remedy what is wrong with this one, and what to do */
    [[noreturn]] void
    refuse(const std::string &remedy) const;

    /** How often each edge belongs to a polygon; 2 if the surface is closed. */
    std::map<std::pair<std::size_t, std::size_t>, unsigned int>
    edges() const
    {
      std::map<std::pair<std::size_t, std::size_t>, unsigned int> found;
      for (const std::vector<std::size_t> &polygon : polygons)
        for (std::size_t i = 0; i < polygon.size(); ++i)
          ++found[std::minmax(polygon[i], polygon[(i + 1) % polygon.size()])];
      return found;
    }

    const std::string                     key, name;
    std::vector<Kernel::Point_3>          points;
    std::vector<std::vector<std::size_t>> polygons;
  };

  /** Coordinates in µm, for messages. */
  template <typename Position>
  std::string
  place(const Position &p)
  {
    std::ostringstream text;
    text << '(' << p.x() << ", " << p.y() << ", " << p.z() << ')';
    return text.str();
  }
} // namespace Morula

#endif
