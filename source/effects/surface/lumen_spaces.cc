// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/near_tree.h>
#include <morula/effects/surface/lumen_spaces.h>
#include <morula/particles/neighbours.h>
#include <morula/particles/point_exchange.h>

#include <deal.II/base/mpi.h>

#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace Morula
{
  namespace
  {
    /** How many boundary points of all ranks face a cavity and have belonged to
     *  a space, by both numbers. */
    using Votes = std::map<std::pair<unsigned int, unsigned int>, unsigned int>;

    /** Collective. */
    template <int dim>
    Votes
    votes_of(const Tissue<dim> &tissue)
    {
      const BoundaryPoints<dim> &points = tissue.boundary_points();
      const auto                 space  = space_column(tissue);
      const auto                 cavity = points.columns().cavity;
      Votes                      own, all;
      for (unsigned int p = 0; p < points.size(); ++p)
        ++own[{points[p].get(cavity), points[p].get(space)}];
      std::vector<std::array<unsigned int, 3>> list;
      for (const auto &[numbers, n] : own)
        list.push_back({{numbers.first, numbers.second, n}});
      for (const auto &of_rank :
           Utilities::MPI::all_gather(tissue.communicator(), list))
        for (const auto &[faced, number, n] : of_rank)
          all[{faced, number}] += n;
      return all;
    }

    /** Lengths of a cell: the least thickness of tissue between two spaces, and
     *  how far its middle may be from all cells. */
    constexpr double thinnest = 0.6, emptiest = 0.9;

    using Pairs = std::set<std::pair<unsigned int, unsigned int>>;

    /** Pairs of spaces between which the tissue has a gap that the surface does
     *  not show yet. Collective. */
    template <int dim>
    Pairs
    open_to_each_other(const Tissue<dim> &tissue)
    {
      // A step in which such a gap opens must know that the content is one:
      // volumes of two have no meaning while the points between them part. The
      // surface is smoothed over max(l, h/2), l the length of the mean cell. So
      // points of two spaces that are nearer than that have no cell between
      // them if the middle is far from all cells: farther than in a row of
      // cells that touch. A row that thin has torn, too.
      const BoundaryPoints<dim> &points = tissue.boundary_points();
      const auto                 space  = space_column(tissue);
      const auto                 cavity = points.columns().cavity;
      const double   l    = std::pow(mean_cell_volume(tissue), 1. / dim);
      const double   near = std::max(l, 0.5 * tissue.grid().box().spacing());
      PointList<dim> walls(1), cells(1);
      for (unsigned int p = 0; p < points.size(); ++p)
        if (points[p].get(cavity) > 1 && points[p].get(space) > 0)
          walls.add_value(points.id(p),
                          points.position(p),
                          double(points[p].get(space)));
      const std::size_t n_own = walls.size();
      walls.append(halo(walls, tissue.grid(), near));
      for (unsigned int p = 0; p < tissue.cells().size(); ++p)
        cells.add_value(tissue.cells().id(p), tissue.cells().position(p), 0.);
      cells.append(halo(cells, tissue.grid(), 0.5 * near + l));
      const NearTree<dim> wall_tree(walls.positions),
        cell_tree(cells.positions);
      std::vector<std::array<unsigned int, 2>> own;
      for (std::size_t i = 0; i < n_own; ++i)
        for (const unsigned int j : wall_tree.within(walls.positions[i], near))
          if (const Tensor<1, dim> way =
                walls.positions[j] - walls.positions[i];
              walls.row(i)[0] < walls.row(j)[0] &&
              (way.norm() < thinnest * l ||
               cell_tree.within(walls.positions[i] + 0.5 * way, emptiest * l)
                 .empty()))
            own.push_back({{static_cast<unsigned int>(walls.row(i)[0]),
                            static_cast<unsigned int>(walls.row(j)[0])}});
      Pairs all;
      for (const auto &of_rank :
           Utilities::MPI::all_gather(tissue.communicator(), own))
        for (const auto &[a, b] : of_rank)
          all.insert({a, b});
      return all;
    }
  } // namespace


  std::string
  number_of_space(const unsigned int space, const std::string &what)
  {
    return number_of_spaces + std::to_string(space) + "/" + what;
  }


  std::vector<LumenSpace>
  kept_spaces(const NamedNumbers &kept, const unsigned int n_lumens)
  {
    std::vector<LumenSpace> spaces(kept.at(number_of_spaces));
    for (unsigned int s = 0; s < spaces.size(); ++s)
      {
        const auto number = [&](const std::string &what) {
          return kept.at(number_of_space(s, what));
        };
        for (unsigned int l = 0; l < n_lumens; ++l)
          spaces[s].held.push_back(number(std::to_string(l)));
        spaces[s].pressure = number("pressure");
        spaces[s].together = number("together") != 0.;
      }
    return spaces;
  }


  void
  keep_spaces(const std::vector<LumenSpace> &spaces, NamedNumbers &kept)
  {
    kept[number_of_spaces] = spaces.size();
    for (unsigned int s = 0; s < spaces.size(); ++s)
      {
        for (unsigned int l = 0; l < spaces[s].held.size(); ++l)
          kept[number_of_space(s, std::to_string(l))] = spaces[s].held[l];
        kept[number_of_space(s, "pressure")] = spaces[s].pressure;
        kept[number_of_space(s, "together")] = spaces[s].together;
      }
  }


  template <int dim>
  SpacesOfSurface
  find_spaces(const std::vector<bool> &together, Tissue<dim> &tissue)
  {
    // Each space has a main cavity, that of most of its points. The owner of a
    // cavity is, of the spaces whose main one it is, that with the most points
    // there: the others have merged with it. A cavity that is nobody's main one
    // has split off from the space of most of its points. Outside of all
    // cavities the numbers end, but for points of other bodies than that which
    // has the cavity: these stand in it.
    constexpr unsigned int    unknown = 0, outside = 1;
    const unsigned int        n     = together.size();
    const Votes               votes = votes_of(tissue);
    std::vector<unsigned int> main(n + 1, outside), most(n + 1, 0);
    for (const auto &[numbers, count] : votes)
      if (const auto [faced, space] = numbers; count > most[space])
        {
          main[space] = faced;
          most[space] = count;
        }
    // Of each cavity: whether it is main to the space, its points, the space.
    std::map<unsigned int, std::array<unsigned int, 3>> owners;
    for (const auto &[numbers, count] : votes)
      if (const auto [faced, space] = numbers; faced > outside)
        owners[faced] =
          std::max(owners[faced],
                   {{space > 0 && main[space] == faced, count, space}});

    SpacesOfSurface result;
    result.n_cavities.assign(n, 0);
    for (auto &[faced, owner] : owners)
      {
        auto &[is_main, count, space] = owner;
        if (space > 0 && !is_main && main[space] == outside)
          space = 0;
        if (space == 0)
          continue;
        ++result.n_cavities[space - 1];
        if (is_main || main[space] == unknown || together[space - 1])
          continue;
        result.split_from.push_back(space);
        space = n + result.split_from.size();
      }
    for (unsigned int space = 1; space <= n; ++space)
      {
        result.has_opened.push_back(most[space] > 0 && main[space] == outside);
        result.into.push_back(main[space] == unknown ? space :
                              main[space] == outside ? 0 :
                                                       owners[main[space]][2]);
      }

    const BoundaryColumns<dim> &columns = tissue.boundary_points().columns();
    const auto column = space_column(tissue), cavity = columns.cavity;
    for (unsigned int p = 0; p < tissue.boundary_points().size(); ++p)
      {
        const auto         point = tissue.boundary_point(p);
        const unsigned int faced = point.get(cavity), space = point.get(column);
        const unsigned int body =
          columns.body.exists() ? point.get(columns.body) : 0;
        if (faced > outside)
          point.set(column, owners[faced][2]);
        else if (faced == outside && space > 0 &&
                 (main[space] <= outside || main[space] >> 16 == body))
          point.set(column, 0);
        else if (faced == outside && space > 0)
          point.set(column, owners[main[space]][2]);
      }
    return result;
  }


  template <int dim>
  void
  join_spaces(SpacesOfSurface &found, Tissue<dim> &tissue)
  {
    const unsigned int n = found.into.size();
    if (n < 2)
      return;

    // Spaces that have a gap between them are one from now on, also while the
    // surface shows two cavities.
    const auto column = space_column(tissue);
    for (auto [a, b] : open_to_each_other(tissue))
      {
        for (unsigned int *const space : {&a, &b})
          while (*space <= n && found.into[*space - 1] != *space)
            *space = found.into[*space - 1];
        if (a == b || std::max(a, b) > n)
          continue;
        found.into[b - 1] = a;
        found.joined.push_back(a);
        for (unsigned int p = 0; p < tissue.boundary_points().size(); ++p)
          if (const auto point = tissue.boundary_point(p);
              point.get(column) == b)
            point.set(column, a);
      }
    for (unsigned int &space : found.into)
      while (space > 0 && found.into[space - 1] != space)
        space = found.into[space - 1];
  }


  MORULA_INSTANTIATE(find_spaces);
  MORULA_INSTANTIATE(join_spaces);
} // namespace Morula
