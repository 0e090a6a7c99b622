// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/seeding/pieces_at_start.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi.templates.h>
#include <deal.II/base/utilities.h>

#include <boost/pending/disjoint_sets.hpp>

#include <array>
#include <cmath>
#include <map>
#include <numeric>

namespace Morula
{
  namespace
  {
    /** A grid cell by its place, and the body in it. */
    template <int dim>
    using GridPlace = std::array<int, dim + 1>;

    /** The places of points, in their order. */
    template <int dim>
    std::vector<GridPlace<dim>>
    places_of(const GridParameters            &grid,
              const std::vector<Point<dim>>   &points,
              const std::vector<unsigned int> &bodies)
    {
      const std::vector<double>   offset = grid.offset;
      std::vector<GridPlace<dim>> places(points.size());
      for (std::size_t i = 0; i < points.size(); ++i)
        {
          for (unsigned int d = 0; d < dim; ++d)
            places[i][d] = static_cast<int>(
              std::floor((points[i][d] - offset[d]) / grid.spacing));
          places[i][dim] = bodies.empty() ? 0 : bodies[i];
        }
      return places;
    }

    /** Numbers by place, of all ranks. */
    template <int dim>
    using PlaceNumbers = std::map<GridPlace<dim>, unsigned int>;

    /** All places that some rank has, each once, numbered in their order.
     *  Collective. */
    template <int dim>
    PlaceNumbers<dim>
    all_places(const std::vector<GridPlace<dim>> &founders,
               const std::vector<GridPlace<dim>> &patches,
               const MPI_Comm                     comm)
    {
      PlaceNumbers<dim> mine, all;
      for (const auto *list : {&founders, &patches})
        for (const GridPlace<dim> &place : *list)
          mine[place] = 0;
      std::vector<int> flat;
      for (const auto &entry : mine)
        flat.insert(flat.end(), entry.first.begin(), entry.first.end());
      for (const auto &list : Utilities::MPI::all_gather(comm, flat))
        for (std::size_t k = 0; k < list.size(); k += dim + 1)
          {
            GridPlace<dim> place;
            std::copy_n(&list[k], dim + 1, place.begin());
            all[place] = 0;
          }
      unsigned int n = 0;
      for (auto &entry : all)
        entry.second = n++;
      return all;
    }
  } // namespace


  template <int dim>
  PiecesAtStart
  pieces_at_start(const GridParameters      &grid,
                  const Founders<dim>       &founders,
                  const SurfacePatches<dim> &surface,
                  const MPI_Comm             comm)
  {
    // Every rank gets all occupied grid cells, far fewer than founders, and
    // joins those that touch by Boost's disjoint sets, in the same order. A
    // piece gets its number when the first of its grid cells comes along.
    const auto of_founders =
      places_of<dim>(grid, founders.positions, founders.bodies);
    const auto of_patches =
      places_of<dim>(grid, surface.positions, surface.bodies);
    const PlaceNumbers<dim> numbers =
      all_places<dim>(of_founders, of_patches, comm);

    std::vector<unsigned int> rank(numbers.size(), 0), parent(numbers.size());
    std::iota(parent.begin(), parent.end(), 0u);
    boost::disjoint_sets<unsigned int *, unsigned int *> sets(rank.data(),
                                                              parent.data());
    for (const auto &[place, number] : numbers)
      for (int k = 0; k < Utilities::pow(3, dim); ++k)
        {
          GridPlace<dim> other = place;
          for (int d = 0, rest = k; d < dim; ++d, rest /= 3)
            other[d] += rest % 3 - 1;
          if (const auto found = numbers.find(other); found != numbers.end())
            sets.union_set(number, found->second);
        }

    PiecesAtStart                        pieces;
    std::map<unsigned int, unsigned int> of_set;
    std::vector<unsigned int>            of_number;
    for (unsigned int number = 0; number < numbers.size(); ++number)
      of_number.push_back(
        of_set.emplace(sets.find_set(number), of_set.size()).first->second);
    pieces.n = of_set.size();
    for (const GridPlace<dim> &place : of_founders)
      pieces.of_founders.push_back(of_number[numbers.at(place)]);
    for (const GridPlace<dim> &place : of_patches)
      pieces.of_patches.push_back(of_number[numbers.at(place)]);
    return pieces;
  }


  MORULA_INSTANTIATE(pieces_at_start);
} // namespace Morula
