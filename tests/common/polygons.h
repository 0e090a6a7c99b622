// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_common_polygons_h
#define morula_tests_common_polygons_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** Polygons to be written as an OFF file. */
  struct Polygons
  {
    std::vector<Point<3>>                  points;
    std::vector<std::vector<unsigned int>> faces;

    std::string
    off() const
    {
      std::ostringstream out;
      out.precision(17);
      out << "OFF\n" << points.size() << ' ' << faces.size() << " 0\n";
      for (const Point<3> &p : points)
        out << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
      for (const auto &face : faces)
        {
          out << face.size();
          for (const unsigned int i : face)
            out << ' ' << i;
          out << '\n';
        }
      return out.str();
    }

    void
    append(const Polygons &other)
    {
      for (auto face : other.faces)
        {
          for (unsigned int &i : face)
            i += points.size();
          faces.push_back(face);
        }
      points.insert(points.end(), other.points.begin(), other.points.end());
    }
  };

  /** A cube with six square faces. */
  inline Polygons
  cube(const Point<3> &corner, const double edge)
  {
    Polygons cube;
    for (unsigned int i = 0; i < 8; ++i)
      cube.points.push_back(
        corner + edge * Tensor<1, 3>(
                          {1. * (i & 1), 1. * ((i >> 1) & 1), 1. * (i >> 2)}));
    cube.faces = {{0, 2, 3, 1},
                  {4, 5, 7, 6},
                  {0, 1, 5, 4},
                  {2, 6, 7, 3},
                  {0, 4, 6, 2},
                  {1, 3, 7, 5}};
    return cube;
  }

  /** An octahedron whose faces are cut in four again and again, on a sphere. */
  inline Polygons
  sphere(const double radius, const unsigned int n_cuts)
  {
    Polygons result;
    result.points = {
      {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    result.faces = {{0, 2, 4},
                    {2, 1, 4},
                    {1, 3, 4},
                    {3, 0, 4},
                    {2, 0, 5},
                    {1, 2, 5},
                    {3, 1, 5},
                    {0, 3, 5}};
    for (unsigned int cut = 0; cut < n_cuts; ++cut)
      {
        std::map<std::pair<unsigned int, unsigned int>, unsigned int> middles;
        const auto middle = [&](const unsigned int i, const unsigned int j) {
          const auto [place, is_new] =
            middles.emplace(std::minmax(i, j), result.points.size());
          if (is_new)
            {
              const Tensor<1, 3> m =
                result.points[i] + result.points[j] - Point<3>();
              result.points.push_back(Point<3>(m / m.norm()));
            }
          return place->second;
        };
        std::vector<std::vector<unsigned int>> finer;
        for (const auto &f : result.faces)
          {
            const unsigned int a = middle(f[0], f[1]);
            const unsigned int b = middle(f[1], f[2]);
            const unsigned int c = middle(f[2], f[0]);
            finer.insert(finer.end(),
                         {{f[0], a, c}, {a, f[1], b}, {c, b, f[2]}, {a, b, c}});
          }
        result.faces = finer;
      }
    for (Point<3> &p : result.points)
      p *= radius;
    return result;
  }
} // namespace Morula

#endif
