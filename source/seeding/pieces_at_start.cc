// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/seeding/bodies.h>
#include <morula/seeding/pieces_at_start.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi.templates.h>
#include <deal.II/base/utilities.h>

#include <boost/pending/disjoint_sets.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

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
      std::set<GridPlace<dim>> mine(founders.begin(), founders.end());
      mine.insert(patches.begin(), patches.end());
      PlaceNumbers<dim> all;
      for (const auto &place :
           of_all_ranks(std::vector<GridPlace<dim>>(mine.begin(), mine.end()),
                        comm))
        all[place] = 0;
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

    boost::disjoint_sets_with_storage<> sets(numbers.size());
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


  namespace
  {
    /** Cubes of a lattice that follow each other along the last axis, far fewer
     *  than cubes: the first one, and the place on that axis behind the last
     *  one. */
    template <int dim>
    using Run = std::array<int, dim + 1>;

    /** The cubes of a lattice, its lines at i @p length (µm), that hold points,
     *  as runs; all ranks' on rank 0. Collective. */
    template <int dim>
    std::vector<Run<dim>>
    occupied(const std::vector<Point<dim>> &points,
             const double                   length,
             const MPI_Comm                 comm)
    {
      // Sorted by coordinates, cubes along the last axis follow each other, and
      // become one run where they touch. That makes far less to send.
      std::vector<std::array<int, dim>> places(points.size());
      for (std::size_t i = 0; i < points.size(); ++i)
        for (unsigned int d = 0; d < dim; ++d)
          places[i][d] = static_cast<int>(std::floor(points[i][d] / length));
      std::sort(places.begin(), places.end());

      std::vector<Run<dim>> mine;
      for (const std::array<int, dim> &place : places)
        {
          const int end = place[dim - 1] + 1;
          if (!mine.empty() && end <= mine.back()[dim] + 1 &&
              std::equal(place.begin(), place.end() - 1, mine.back().begin()))
            mine.back()[dim] = end;
          else
            {
              mine.emplace_back();
              std::copy(place.begin(), place.end(), mine.back().begin());
              mine.back()[dim] = end;
            }
        }
      std::vector<Run<dim>> all;
      for (const auto &runs : Utilities::MPI::gather(comm, mine, 0))
        all.insert(all.end(), runs.begin(), runs.end());
      return all;
    }

    /** How many groups the cubes form, of which neighbours stand at most two
     *  cubes apart along each axis. */
    template <int dim>
    unsigned int
    n_groups(const std::vector<Run<dim>> &runs)
    {
      // Each run is joined with those found before it in all rows within reach,
      // where they overlap along the last axis or come as near as that. All
      // pairs are looked at, as the later of two runs finds the earlier one.
      using Row = std::array<int, dim - 1>; // the other axes
      std::map<Row, std::vector<std::size_t>> rows;
      boost::disjoint_sets_with_storage<>     groups(runs.size());
      std::vector<std::size_t>                list;
      for (std::size_t r = 0; r < runs.size(); ++r)
        {
          list.push_back(r);
          const Run<dim> &run = runs[r];
          Row             row;
          std::copy_n(run.begin(), dim - 1, row.begin());
          // This joins it with runs that came before.
          for (int k = 0; k < Utilities::pow(5, dim - 1); ++k)
            {
              Row other = row;
              for (int d = 0, rest = k; d < dim - 1; ++d, rest /= 5)
                other[d] += rest % 5 - 2;
              if (const auto found = rows.find(other); found != rows.end())
                for (const std::size_t s : found->second)
                  if (run[dim - 1] < runs[s][dim] + 2 &&
                      runs[s][dim - 1] < run[dim] + 2)
                    groups.union_set(r, s);
            }
          rows[row].push_back(r);
        }
      return groups.count_sets(list.begin(), list.end());
    }
  } // namespace


  template <int dim>
  BodyCounts
  count_bodies(const GridParameters      &grid,
               const Founders<dim>       &founders,
               const SurfacePatches<dim> &surface,
               const MPI_Comm             comm)
  {
    // Bodies are groups of cubes as long as the longest cell that stand at most
    // two apart, counted on rank 0. The grid sticks bodies together that the
    // cells keep apart where there are fewer pieces than bodies.
    const std::vector<Run<dim>> runs =
      occupied<dim>(founders.positions, longest_length(founders, comm), comm);
    return {Utilities::MPI::broadcast(comm, n_groups<dim>(runs), 0),
            pieces_at_start(grid, founders, surface, comm).n};
  }


  template <int dim>
  void
  review_bodies(const GridParameters      &grid,
                const TissueParameters    &tissue,
                const Founders<dim>       &founders,
                const SurfacePatches<dim> &surface,
                const MPI_Comm             comm,
                Review                    &review)
  {
    // A shape is one body. The run says when bodies come to stick later.
    if (!tissue.is_from_file())
      return;
    const BodyCounts counts = count_bodies(grid, founders, surface, comm);
    if (counts.bodies > counts.pieces)
      review.warn(grid.spacing.path(),
                  as_text(grid.spacing) + " um",
                  "the tissue is " + std::to_string(counts.bodies) +
                    " bodies, and the grid makes " +
                    std::to_string(counts.pieces) +
                    (counts.pieces == 1 ? " piece" : " pieces") +
                    " of them: those within a grid spacing of each other stick "
                    "together from the start, though their cells do not touch "
                    "(doc/faq.md, bodies that stick).",
                  "A Grid/Spacing of less than half the gap between them keeps "
                  "them apart.");
  }


  MORULA_INSTANTIATE(count_bodies);
  MORULA_INSTANTIATE(review_bodies);
} // namespace Morula
