// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/send_records.h>
#include <morula/grid/unknown_numbers.h>

#include <deal.II/base/mpi.templates.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace Morula
{
  namespace
  {
    constexpr unsigned int no_number = numbers::invalid_unsigned_int;

    /** The copies in the order of the grid's box. (The window's is another one
     *  where it has several boxes.) */
    template <int dim>
    std::vector<unsigned int>
    in_order(const std::vector<unsigned int> &list,
             const SplineCopies<dim>         &copies,
             const GridBox<dim>              &whole)
    {
      // Copies of one spline keep their order: the number of the copy is the
      // second key.
      std::vector<std::pair<unsigned int, unsigned int>> sorted;
      for (const unsigned int c : list)
        sorted.emplace_back(whole.number(copies.center(c)), c);
      std::sort(sorted.begin(), sorted.end());
      std::vector<unsigned int> result;
      for (const auto &[number, c] : sorted)
        result.push_back(c);
      return result;
    }
  } // namespace

  template <int dim>
  UnknownNumbers<dim>::UnknownNumbers(const SplineCopies<dim>         &copies,
                                      const std::vector<unsigned int> &own,
                                      SmallPieces               &small_pieces,
                                      const BackgroundGrid<dim> &grid)
    : numbers(copies.list().size(), no_number)
  {
    // A rank's unknowns are its splines, in the order of the grid's box, and
    // then those of the small pieces whose lowest grid cell it owns. All ranks
    // tell each other how many they have, so that the numbers run rank by rank.
    // Numbers of other ranks' copies are asked for later.
    const MPI_Comm     comm = grid.communicator();
    const unsigned int rank = Utilities::MPI::this_mpi_process(comm);

    unsigned int n_own = own.size();
    for (const auto &[piece, polynomial] : small_pieces)
      if (grid.owner(copies.lowest_grid_cell(piece)) == rank)
        n_own += polynomial.n_unknowns();
    const auto   of_ranks = Utilities::MPI::all_gather(comm, n_own);
    unsigned int next =
      std::accumulate(of_ranks.begin(), of_ranks.begin() + rank, 0u);
    owned_ = IndexSet(std::accumulate(of_ranks.begin(), of_ranks.end(), 0u));
    owned_.add_range(next, next + n_own);

    pieces_.reserve(n_own);
    for (const unsigned int c : in_order(own, copies, grid.box()))
      {
        numbers[c] = next++;
        pieces_.push_back(copies.list()[c].piece);
      }
    add_small_pieces(copies, small_pieces, grid, next);
  }

  template <int dim>
  void
  UnknownNumbers<dim>::add_small_pieces(const SplineCopies<dim>   &copies,
                                        SmallPieces               &small_pieces,
                                        const BackgroundGrid<dim> &grid,
                                        unsigned int               next)
  {
    const MPI_Comm     comm = grid.communicator();
    const unsigned int rank = Utilities::MPI::this_mpi_process(comm);
    // Every rank knows all small pieces. The owner of each sets its first
    // unknown, the others have 0 there, and a sum tells all.
    std::vector<unsigned int> first(small_pieces.size(), 0);
    std::size_t               k = 0;
    for (const auto &[piece, polynomial] : small_pieces)
      {
        if (grid.owner(copies.lowest_grid_cell(piece)) == rank)
          {
            first[k] = next;
            next += polynomial.n_unknowns();
            pieces_.insert(pieces_.end(), polynomial.n_unknowns(), piece);
          }
        ++k;
      }
    Utilities::MPI::sum(first, comm, first);
    k = 0;
    for (auto &[piece, polynomial] : small_pieces)
      polynomial.first_unknown = first[k++];
  }

  template <int dim>
  void
  UnknownNumbers<dim>::ask(const std::vector<unsigned int> &of_others,
                           const SplineCopies<dim>         &copies,
                           const BackgroundGrid<dim>       &grid)
  {
    const MPI_Comm comm = grid.communicator();
    if (Utilities::MPI::n_mpi_processes(comm) == 1)
      return;
    struct Question
    {
      unsigned int spline; // number in the grid's box
      unsigned int place;  // of the copy
    };
    // A copy is named by its spline and its place among the copies of this:
    // that is the same on all ranks that know it, whereas numbers of copies are
    // not. Owners answer in the order of the questions.
    std::map<unsigned int, std::vector<Question>>     questions;
    std::map<unsigned int, std::vector<unsigned int>> asked, answers;
    for (const unsigned int c : of_others)
      {
        const GridIndex<dim> index = copies.center(c);
        const unsigned int   owner = grid.owner(index);
        questions[owner].push_back({grid.box().number(index), copies.place(c)});
        asked[owner].push_back(c);
      }
    for (const auto &[rank, list] : send_records(questions, comm))
      for (const auto &[spline, place] : list)
        answers[rank].push_back(
          numbers[copies.copy_at(grid.box().index(spline), place)]);
    for (const auto &[rank, list] : send_records(answers, comm))
      for (std::size_t i = 0; i < list.size(); ++i)
        {
          // An owner without a number for a copy would mean that ranks disagree
          // on what is an unknown.
          AssertThrow(list[i] != no_number, ExcInternalError());
          numbers[asked.at(rank)[i]] = list[i];
        }
  }

  template <int dim>
  bool
  UnknownNumbers<dim>::has(const unsigned int copy) const
  {
    return numbers[copy] != no_number;
  }

  template <int dim>
  unsigned int
  UnknownNumbers<dim>::operator[](const unsigned int copy) const
  {
    return numbers[copy];
  }

  template class UnknownNumbers<2>;
  template class UnknownNumbers<3>;
} // namespace Morula
