// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/particles/point_exchange.h>
#include <morula/surface/walls.h>

#include <cmath>
#include <tuple>

namespace Morula
{
  namespace
  {
    /** Cells at a wall end within this way behind it, and a patch
     *  belongs to a point of t = 0 that is at most so far along the wall, in
     *  spacings of the lattice. */
    constexpr double farthest_behind = 3., along = 2.;

    /** How far the points of a plane are from it, in parts of their reach. */
    constexpr double out_of_plane = 0.01;

    /** The cosine of the largest angle between a patch and its wall. */
    constexpr double least_cosine = 0.5;

    /** X, N, the condition and the body of a wall. */
    template <int dim>
    using WallValues =
      std::tuple<Point<dim>, Tensor<1, dim>, SurfaceCondition, unsigned int>;
  } // namespace


  template <int dim>
  std::vector<double>
  walls_of(const BoundaryPoints<dim> &points, const MPI_Comm comm)
  {
    PointList<dim> held(Flat<WallValues<dim>>::n);
    for (unsigned int p = 0; p < points.size(); ++p)
      if (const auto point = points[p]; is_held(point.condition()))
        held.add_value(points.id(p),
                       points.position(p),
                       WallValues<dim>(point.initial_position(),
                                       point.initial_normal(),
                                       point.condition(),
                                       points.has_bodies() ?
                                         point.get(points.columns().body) :
                                         0));
    return of_all_ranks(held, comm).numbers;
  }


  template <int dim>
  std::vector<double>
  one_of_each_plane(const std::vector<double> &walls, const double spacing)
  {
    // Points are in one plane whose normals and distances from the origin are
    // about equal. Where rounding parts them the plane is there twice. A plane
    // has several points, while each of a curved side has its own.
    constexpr unsigned int                n = Flat<WallValues<dim>>::n;
    std::map<std::vector<long>, unsigned> counts;
    std::vector<double>                   planes;
    for (std::size_t i = 0; i < walls.size(); i += n)
      {
        const auto        wall = Flat<WallValues<dim>>::read(&walls[i]);
        const auto       &N    = std::get<1>(wall);
        std::vector<long> plane{std::lround(Tensor<1, dim>(std::get<0>(wall)) *
                                            N / (out_of_plane * spacing))};
        for (unsigned int d = 0; d < dim; ++d)
          plane.push_back(std::lround(N[d] / out_of_plane));
        if (++counts[plane] == dim)
          planes.insert(planes.end(), &walls[i], &walls[i] + n);
      }
    return planes;
  }


  template <int dim>
  Walls<dim>::Walls(const std::vector<double>  &numbers,
                    const PlaceConditions<dim> &scene,
                    const BoundaryColumns<dim> &columns)
    : scene(scene)
  {
    for (std::size_t i = 0; i < numbers.size(); i += Flat<WallValues<dim>>::n)
      {
        const auto [X, N, condition, body] =
          Flat<WallValues<dim>>::read(&numbers[i]);
        Wall<dim> wall{X, N, condition, body, {}};
        if (condition == SurfaceCondition::fixed)
          {
            const auto row = columns.initial_point(X, N, 1., condition);
            wall.motion    = scene.displacement(
              BoundaryView<dim>(make_array_view(row), columns));
          }
        walls.push_back(wall);
        places.push_back(X + wall.motion);
      }
    tree.emplace(places);
  }


  template <int dim>
  std::optional<typename Walls<dim>::Foot>
  Walls<dim>::at(const unsigned int    body,
                 const Point<dim>     &x,
                 const Tensor<1, dim> &n,
                 const double          offset,
                 const double          edge,
                 const double          before) const
  {
    // The nearest point of t = 0 on this side tells which wall it is. Beyond
    // the last of them the wall goes on in its plane as far as the scene's
    // words say.
    const auto i = tree->nearest(x, [&](const unsigned int k) {
      return walls[k].body == body && walls[k].N * n > least_cosine;
    });
    if (!i)
      return {};
    const Wall<dim>     &wall = walls[*i];
    const Tensor<1, dim> way  = x - places[*i];
    const double         off  = way * wall.N;
    const double         end  = off - offset * (n * wall.N);
    const Point<dim>     X    = x - off * wall.N - wall.motion;
    if (end <= -before * edge || end >= farthest_behind * edge ||
        ((way - off * wall.N).norm() > along * edge &&
         scene.condition(X, wall.N) != wall.condition))
      return {};
    return Foot{&wall, X};
  }


  template <int dim>
  Tensor<1, dim>
  Walls<dim>::behind(const Point<dim> &x, const double near) const
  {
    // The nearest point tells which wall it is. Tissue that slips along a
    // curved one leaves its points' planes as it should, so that only plane
    // ones tell.
    const unsigned int   i   = tree->nearest(x);
    const Tensor<1, dim> way = x - places[i], N = walls[i].N;
    const double         depth = way * N;
    if (depth <= 0. || (way - depth * N).norm() > near)
      return {};
    for (const unsigned int k : tree->within(places[i], 2. * near))
      if (walls[k].N * N > least_cosine &&
          std::abs((places[k] - places[i]) * N) > out_of_plane * near)
        return {};
    return depth * N;
  }

  MORULA_INSTANTIATE(walls_of);
  MORULA_INSTANTIATE(one_of_each_plane);
  template class Walls<2>;
  template class Walls<3>;
} // namespace Morula
