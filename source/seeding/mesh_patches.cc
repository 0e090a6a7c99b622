// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/seeding/closed_surface.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <queue>
#include <string>
#include <utility>

namespace Morula
{
  namespace
  {
    using Triangle = std::array<Point<3>, 3>;

    Point<3>
    centroid(const Triangle &triangle)
    {
      return Point<3>(
        (triangle[0] + Tensor<1, 3>(triangle[1]) + Tensor<1, 3>(triangle[2])) /
        3.);
    }

    /** A part of the surface: a whole triangle, a part of one, or several
     *  merged ones. */
    struct Piece
    {
      std::vector<Triangle> triangles;
      double                area = 0.;
      Tensor<1, 3>          moment; // area times centroid
      Tensor<1, 3>          vector; // sum of the area vectors
      // The pieces next to this one. They may have been merged since: see
      // current().
      std::vector<std::size_t> neighbors;
      std::size_t              merged_into;

      Point<3>
      center() const
      {
        return Point<3>(moment / area);
      }
    };

    Piece
    make_piece(const Triangle &triangle, const std::size_t number)
    {
      Piece piece;
      piece.triangles   = {triangle};
      piece.vector      = area_vector(triangle);
      piece.area        = piece.vector.norm();
      piece.moment      = piece.area * centroid(triangle);
      piece.merged_into = number;
      return piece;
    }

    /**
     * How many pieces to cut each triangle into. A triangle at least as large
     * as the mean patch gets its share, rounded such that the rounding errors
     * do not add up. Smaller triangles stay whole.
     */
    std::vector<std::uint64_t>
    count_pieces(const std::vector<SurfaceTriangle> &triangles,
                 const std::uint64_t                 n_wished)
    {
      // The share of a triangle is its area in patches. Rounding the running
      // sum rather than each share keeps the total near the wish.
      double total = 0.;
      for (const SurfaceTriangle &triangle : triangles)
        total += area_vector(triangle.vertices).norm();

      std::vector<std::uint64_t> counts;
      double                     share_so_far = 0.;
      for (const SurfaceTriangle &triangle : triangles)
        {
          const double share = area_vector(triangle.vertices).norm() / total *
                               static_cast<double>(n_wished);
          counts.push_back(1);
          if (share < 1.)
            continue;
          const double before = std::round(share_so_far);
          share_so_far += share;
          counts.back() = static_cast<std::uint64_t>(
            std::max(1., std::round(share_so_far) - before));
        }
      return counts;
    }

    /** The pieces of all triangles. Only whole triangles know their neighbours,
     *  since only they are merged. */
    std::vector<Piece>
    cut(const std::vector<SurfaceTriangle> &triangles,
        const std::vector<std::uint64_t>   &counts)
    {
      std::vector<Piece>       pieces;
      std::vector<std::size_t> first;
      // The first piece of each triangle is remembered, so that neighbours can
      // be found by triangle.
      for (std::size_t t = 0; t < triangles.size(); ++t)
        {
          std::vector<Triangle> parts;
          cut_triangle(triangles[t].vertices, counts[t], parts);
          first.push_back(pieces.size());
          for (const Triangle &part : parts)
            pieces.push_back(make_piece(part, pieces.size()));
        }

      for (std::size_t t = 0; t < triangles.size(); ++t)
        if (counts[t] == 1)
          for (const unsigned int neighbor : triangles[t].neighbors)
            {
              // A neighbour that was cut is represented by its nearest piece.
              Piece     &own   = pieces[first[t]];
              const auto begin = pieces.begin() + first[neighbor];
              const auto nearest =
                std::min_element(begin,
                                 begin + counts[neighbor],
                                 [center = own.center()](const Piece &a,
                                                         const Piece &b) {
                                   return a.center().distance_square(center) <
                                          b.center().distance_square(center);
                                 });
              own.neighbors.push_back(nearest - pieces.begin());
              nearest->neighbors.push_back(first[t]);
            }
      return pieces;
    }

    /** The piece that a merged piece is part of now. */
    std::size_t
    current(std::vector<Piece> &pieces, std::size_t number)
    {
      // On the way the path is shortened to half, so that later searches are
      // short.
      while (pieces[number].merged_into != number)
        {
          pieces[number].merged_into =
            pieces[pieces[number].merged_into].merged_into;
          number = pieces[number].merged_into;
        }
      return number;
    }

    /**
     * The neighbour to merge the piece @p number with: the one whose centre is
     * nearest. It is @p number itself if all its edges are sharp.
     */
    std::size_t
    best_neighbor(std::vector<Piece> &pieces, const std::size_t number)
    {
      // Triangles that meet at more than 30 degrees are sides of an edge of the
      // body: a patch across it would have a normal that neither has.
      constexpr double cosine_of_sharp_edge = 0.86602540378443865; // 30 degrees

      std::vector<std::size_t> &neighbors = pieces[number].neighbors;
      // Neighbours may have been merged since. Their list is brought up to date
      // first.
      for (std::size_t &neighbor : neighbors)
        neighbor = current(pieces, neighbor);
      std::sort(neighbors.begin(), neighbors.end());
      neighbors.erase(std::unique(neighbors.begin(), neighbors.end()),
                      neighbors.end());

      const Piece &piece    = pieces[number];
      std::size_t  best     = number;
      double       distance = std::numeric_limits<double>::max();
      for (const std::size_t neighbor : neighbors)
        {
          const Piece &other = pieces[neighbor];
          const double to_other =
            piece.center().distance_square(other.center());
          if (neighbor != number && to_other < distance &&
              piece.vector * other.vector >= cosine_of_sharp_edge *
                                               piece.vector.norm() *
                                               other.vector.norm())
            {
              best     = neighbor;
              distance = to_other;
            }
        }
      return best;
    }

    void
    merge(std::vector<Piece> &pieces,
          const std::size_t   to,
          const std::size_t   from)
    {
      Piece &kept = pieces[to];
      Piece &gone = pieces[from];
      kept.area += gone.area;
      kept.moment += gone.moment;
      kept.vector += gone.vector;
      // The smaller list is moved to the larger one, so that many merges stay
      // cheap.
      const auto move_all = [](auto &into, auto &out_of) {
        if (into.size() < out_of.size())
          std::swap(into, out_of);
        into.insert(into.end(), out_of.begin(), out_of.end());
        out_of = {};
      };
      move_all(kept.triangles, gone.triangles);
      move_all(kept.neighbors, gone.neighbors);
      gone.merged_into = to;
    }

    /** Merges the smallest pieces until @p n_wished are left, or until no more
     *  can be merged. */
    void
    merge_smallest(std::vector<Piece> &pieces, const std::uint64_t n_wished)
    {
      // The queue has an entry for each state of a piece. Old entries are not
      // removed but recognised: by a piece that is merged, or by another area.
      using Entry = std::pair<double, std::size_t>; // area, number
      std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
      for (std::size_t i = 0; i < pieces.size(); ++i)
        queue.emplace(pieces[i].area, i);

      std::uint64_t n = pieces.size();
      while (n > n_wished && !queue.empty())
        {
          const auto [area, number] = queue.top();
          queue.pop();
          if (current(pieces, number) != number || pieces[number].area != area)
            continue; // merged since it was queued
          const std::size_t other = best_neighbor(pieces, number);
          if (other == number)
            continue;
          const std::size_t kept = std::min(number, other);
          merge(pieces, kept, std::max(number, other));
          queue.emplace(pieces[kept].area, kept);
          --n;
        }
    }

    /**
     * The point of the triangle's plane nearest to @p x, kept inside the
     * triangle and off its edges.
     */
    Point<3>
    move_into(const Triangle &triangle, const Point<3> &x)
    {
      constexpr double   least  = 0.1; // of a barycentric coordinate
      const Tensor<1, 3> normal = area_vector(triangle);
      double             weights[3], sum = 0.;
      // Barycentric coordinates of the projection of x, with a least value so
      // that the point is inside and off the edges.
      for (unsigned int i = 0; i < 3; ++i)
        {
          const Tensor<1, 3> part =
            area_vector({{x, triangle[(i + 1) % 3], triangle[(i + 2) % 3]}});
          weights[i] = std::max(least, part * normal / normal.norm_square());
          sum += weights[i];
        }
      Point<3> moved;
      for (unsigned int i = 0; i < 3; ++i)
        moved += (weights[i] / sum) * triangle[i];
      return moved;
    }

    SurfacePatch<3>
    make_patch(const Piece &piece, const bool projected)
    {
      SurfacePatch<3> patch;
      patch.area     = projected ? piece.vector.norm() : piece.area;
      patch.normal   = piece.vector / piece.vector.norm();
      patch.position = piece.center();
      // A centre of several triangles may lie off the surface, so it is moved
      // into the triangle that it is nearest to.
      if (piece.triangles.size() == 1)
        return patch;

      double distance = std::numeric_limits<double>::max();
      for (const Triangle &triangle : piece.triangles)
        {
          const Point<3> moved = move_into(triangle, piece.center());
          if (moved.distance(piece.center()) < distance)
            {
              patch.position = moved;
              distance       = moved.distance(piece.center());
            }
        }
      return patch;
    }
  } // namespace

  Tensor<1, 3>
  area_vector(const std::array<Point<3>, 3> &triangle)
  {
    return 0.5 * cross_product_3d(triangle[1] - triangle[0],
                                  triangle[2] - triangle[0]);
  }

  void
  cut_triangle(const std::array<Point<3>, 3>        &triangle,
               const std::uint64_t                   n_pieces,
               std::vector<std::array<Point<3>, 3>> &pieces)
  {
    if (n_pieces == 1)
      {
        pieces.push_back(triangle);
        return;
      }
    // The longest edge is cut, so that pieces stay compact; at the ratio of the
    // numbers of pieces, so that their areas are equal.
    unsigned int longest = 0;
    for (unsigned int i = 1; i < 3; ++i)
      if (triangle[i].distance(triangle[(i + 1) % 3]) >
          triangle[longest].distance(triangle[(longest + 1) % 3]))
        longest = i;
    const Point<3> a = triangle[longest];
    const Point<3> b = triangle[(longest + 1) % 3];
    const Point<3> c = triangle[(longest + 2) % 3];

    const std::uint64_t half    = n_pieces / 2;
    const double        ratio   = static_cast<double>(half) / n_pieces;
    const Point<3>      on_edge = a + ratio * (b - a);
    cut_triangle({{a, on_edge, c}}, half, pieces);
    cut_triangle({{on_edge, b, c}}, n_pieces - half, pieces);
  }

  std::vector<SurfacePatch<3>>
  cut_into_patches(const std::vector<SurfaceTriangle> &triangles,
                   const std::uint64_t                 n_wished,
                   const bool                          projected)
  {
    // Large triangles are cut, small ones are merged, until the number of
    // pieces is about the wish. What has not been merged into another piece is
    // a patch.
    std::vector<Piece> pieces =
      cut(triangles, count_pieces(triangles, n_wished));
    merge_smallest(pieces, n_wished);

    std::vector<SurfacePatch<3>> patches;
    for (std::size_t i = 0; i < pieces.size(); ++i)
      if (pieces[i].merged_into == i)
        patches.push_back(make_patch(pieces[i], projected));
    return patches;
  }


  namespace
  {
    /** The body inside a closed surface that a file holds. It lies where the
     * file places it. */
    class MeshShape : public Shape<3>
    {
    public:
      /** @throws InputError as SurfaceMesh */
      MeshShape(const std::string &key, const std::string &file)
        : mesh(key, file)
      {}

      BoundingBox<3>
      bounding_box() const override
      {
        return mesh.bounding_box();
      }

      bool
      contains(const Point<3> &x, const double clearance) const override
      {
        return mesh.contains(x, clearance);
      }
      std::optional<bool>
      side_of_cube(const Point<3> &x, const double half_side) const override
      {
        return mesh.side_of_cube(x, half_side);
      }

      double
      volume() const override
      {
        // The volume is seen from a point of the surface, so that no digits are
        // lost if the body is far from the origin.
        const Point<3> apex   = mesh.triangles().front().vertices[0];
        double         volume = 0.;
        for (const SurfaceTriangle &triangle : mesh.triangles())
          volume +=
            (triangle.vertices[0] - apex) * area_vector(triangle.vertices);
        return volume / 3.;
      }

      double
      surface_area() const override
      {
        double area = 0.;
        for (const SurfaceTriangle &triangle : mesh.triangles())
          area += area_vector(triangle.vertices).norm();
        return area;
      }

      /** See cut_into_patches(). */
      SurfaceTiling<3>
      tile(const std::uint64_t n_wished) const override
      {
        SurfaceTiling<3>             tiling;
        std::vector<SurfacePatch<3>> patches =
          cut_into_patches(mesh.triangles(), n_wished);
        tiling.n_patches = patches.size();
        tiling.patch = [patches = std::move(patches)](const std::uint64_t i) {
          return patches[i];
        };
        return tiling;
      }

    private:
      SurfaceMesh mesh;
    };
  } // namespace


  std::unique_ptr<Shape<3>>
  make_mesh_shape(const TissueParameters &parameters)
  {
    return std::make_unique<MeshShape>(parameters.surface_mesh.path(),
                                       parameters.surface_mesh);
  }
} // namespace Morula
