// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/send_records.h>
#include <morula/grid/unknown_numbers.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi.templates.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

namespace Morula
{
  namespace
  {
    /** Extents and contents of all pieces. */
    template <int dim>
    struct Extents
    {
      /** The extent of the tissue, µm: for each piece the upper corner, and the
       *  lower one with a minus, so that one maximum over ranks finds both. */
      std::vector<double> corners;
      /** For each piece the numbers of inner grid cells, of particles, of grid
       *  cells, and the sum of the coordinates of these: integers, so that the
       *  order of the ranks does not matter. */
      std::vector<std::int64_t> counts;

      static constexpr unsigned int n_counts = 3 + dim;
    };

    template <int dim>
    Extents<dim>
    extents(const Occupancy<dim>             &occupancy,
            const std::vector<GridCellClass> &classes,
            const SplineCopies<dim>          &copies,
            const MPI_Comm                    comm)
    {
      // Each rank looks at its own grid cells. A maximum and a sum over all
      // ranks give all pieces at once; the lower corners carry a minus, so that
      // one maximum serves both.
      Extents<dim> all;
      all.corners.assign(copies.n_pieces() * 2 * dim,
                         std::numeric_limits<double>::lowest());
      all.counts.assign(copies.n_pieces() * Extents<dim>::n_counts, 0);
      for (const unsigned int number : copies.own_nodes())
        {
          const unsigned int   piece  = copies.piece(number);
          const GridIndex<dim> index  = occupancy.nodes().index(number);
          const auto [lower, upper]   = occupancy.bounds(number);
          double *const       corners = &all.corners[piece * 2 * dim];
          std::int64_t *const counts =
            &all.counts[piece * Extents<dim>::n_counts];
          counts[0] += classes[number] == GridCellClass::inner;
          counts[1] += occupancy.n_particles(number);
          ++counts[2];
          for (unsigned int d = 0; d < dim; ++d)
            {
              corners[d]       = std::max(corners[d], upper[d]);
              corners[dim + d] = std::max(corners[dim + d], -lower[d]);
              counts[3 + d] += index[d];
            }
        }
      Utilities::MPI::max(all.corners, comm, all.corners);
      Utilities::MPI::sum(all.counts, comm, all.counts);
      return all;
    }
  } // namespace

  template <int dim>
  std::vector<std::pair<unsigned int, double>>
  PiecePolynomial<dim>::expression(const Point<dim> &x, const double h) const
  {
    std::vector<std::pair<unsigned int, double>> terms;
    // The terms of doc/theory.md (3.4) in the order of the unknowns: the
    // constant, the linear ones, and products of two coordinates.
    const Tensor<1, dim> xi      = (x - center) / h;
    unsigned int         unknown = first_unknown;
    terms.emplace_back(unknown++, 1.);
    for (unsigned int d = 0; d < dim; ++d)
      terms.emplace_back(unknown++, xi[d]);
    // The spline coefficient of ξ² is its value at the centre minus 1/4.
    if (quadratic)
      for (unsigned int d = 0; d < dim; ++d)
        for (unsigned int e = d; e < dim; ++e)
          terms.emplace_back(unknown++, xi[d] * xi[e] - (d == e ? 0.25 : 0.));
    return terms;
  }

  template <int dim>
  std::map<unsigned int, PiecePolynomial<dim>>
  find_small_pieces(const Occupancy<dim>             &occupancy,
                    const std::vector<GridCellClass> &classes,
                    const SplineCopies<dim>          &copies,
                    const MPI_Comm                    comm)
  {
    // A piece is judged by its extent and by what it holds, doc/theory.md,
    // section 3.5. All ranks have all pieces' sums, so they find the same small
    // pieces and the same polynomials, also of pieces of which they hold
    // nothing.
    const double     h = occupancy.window().whole().spacing();
    const Point<dim> grid_line =
      occupancy.window().whole().corner(GridIndex<dim>{});
    const auto all = extents(occupancy, classes, copies, comm);
    std::map<unsigned int, PiecePolynomial<dim>> result;
    for (unsigned int piece = 0; piece < copies.n_pieces(); ++piece)
      {
        const auto corners = all.corners.begin() + piece * 2 * dim;
        const auto counts = all.counts.begin() + piece * Extents<dim>::n_counts;
        double     largest = 0.;
        for (unsigned int d = 0; d < dim; ++d)
          largest = std::max(largest, corners[d] + corners[dim + d]);
        const bool has_inner = counts[0] > 0;
        const bool few       = counts[1] < std::int64_t(BSpline<dim>::n);
        if (!has_inner || largest < (few ? 2. : 1.) * h)
          {
            PiecePolynomial<dim> &polynomial = result[piece];
            for (unsigned int d = 0; d < dim; ++d)
              // The mean of the grid cells' centres, from sums of integers.
              polynomial.center[d] =
                grid_line[d] + (1. * counts[3 + d] / counts[2] + 0.5) * h;
            polynomial.quadratic = !few && largest < h;
          }
      }
    return result;
  }


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


  template struct PiecePolynomial<2>;
  template struct PiecePolynomial<3>;
  MORULA_INSTANTIATE(find_small_pieces);
  template class UnknownNumbers<2>;
  template class UnknownNumbers<3>;


  namespace
  {
    /** Fills with a smaller relative difference are equal. In symmetric tissue
     *  the solver's error makes them differ by less. */
    constexpr double equal_fills = 1e-6;

    /** How far a spline lies beyond a block in each direction; 0 if it is among
     *  the block's splines in that direction. Blocks with the same distances
     *  give the same weights to the same splines. */
    template <int dim>
    GridIndex<dim>
    extrapolation(const GridIndex<dim> &spline, const GridIndex<dim> &block)
    {
      GridIndex<dim> distance;
      for (unsigned int d = 0; d < dim; ++d)
        {
          // The block's splines are at -1, 0 and 1 from its middle.
          const int j = spline[d] - block[d];
          distance[d] = std::abs(j) <= 1 ? 0 : j;
        }
      return distance;
    }

    template <int dim>
    double
    sum_of_weights(const GridIndex<dim> &spline, const GridIndex<dim> &block)
    {
      double product = 1.;
      for (unsigned int d = 0; d < dim; ++d)
        {
          // Σ|e| of a tensor product is the product of the sums by direction.
          // All e are integers, so equal sums are equal to the last bit.
          double sum = 0.;
          for (const double e : extension_weights(spline[d] - (block[d] - 1)))
            sum += std::abs(e);
          product *= sum;
        }
      return product;
    }
  } // namespace

  std::array<double, 3>
  extension_weights(const int j)
  {
    // These are Lagrange's polynomials, doc/theory.md (3.3), for the nodes 0,
    // 1, 2.
    return {{0.5 * (j - 1) * (j - 2), -1. * j * (j - 2), 0.5 * j * (j - 1)}};
  }

  template <int dim>
  std::array<double, BSpline<dim>::n>
  extension_weights(const GridIndex<dim> &spline, const GridIndex<dim> &block)
  {
    std::array<double, 3> e[dim];
    for (unsigned int d = 0; d < dim; ++d)
      e[d] = extension_weights(spline[d] - (block[d] - 1));
    std::array<double, BSpline<dim>::n> weights;
    for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
      {
        weights[a] = 1.;
        for (unsigned int d = 0; d < dim; ++d)
          weights[a] *= e[d][BSpline<dim>::offset(a, d) + 1];
      }
    return weights;
  }


  /** Grid cells with tissue within @p radius of the spline's centre that are
   *  connected, inside this window, to the copy's support. */
  template <int dim>
  std::vector<unsigned int>
  ExtensionSearch<dim>::connected(const GridIndex<dim>            &center,
                                  const std::vector<unsigned int> &support,
                                  const int                        radius)
  {
    // A breadth-first search over grid cells with tissue, which starts from the
    // copy's own support and does not leave the given radius. So it does not
    // reach bodies on the other side of a gap. `reached` serves all searches:
    // only the entries that were set are cleared.
    std::vector<unsigned int> list;
    const auto reach = [&](const unsigned int node, const auto &index) {
      for (unsigned int d = 0; d < dim; ++d)
        if (std::abs(index[d] - center[d]) > radius)
          return;
      if (classes[node] != GridCellClass::empty && !reached[node])
        {
          reached[node] = 1;
          list.push_back(node);
        }
    };
    for (const unsigned int node : support)
      reach(node, nodes.index(node));
    // The list grows while it is read.
    for (std::size_t i = 0; i < list.size(); ++i)
      nodes.for_linked(list[i], reach);
    for (const unsigned int node : list)
      reached[node] = 0;
    return list;
  }

  /** Chooses among blocks with the same Σ|e|: doc/theory.md, section 3.4. */
  template <int dim>
  std::vector<unsigned int>
  ExtensionSearch<dim>::fullest(const GridIndex<dim>            &spline,
                                const std::vector<unsigned int> &blocks) const
  {
    // Groups are blocks that extrapolate alike; see extrapolation(). Their
    // fills are sums of multiples of 2⁻⁴⁰, so the order of summation does not
    // matter. Of all groups with the most tissue all blocks are chosen: the
    // choice turns and mirrors with the tissue.
    struct Group
    {
      std::vector<unsigned int> blocks;
      double                    fill = 0.; // a sum of multiples of 2^-40: exact
    };
    std::map<GridIndex<dim>, Group> groups;
    double                          most = 0.;
    for (const unsigned int block : blocks)
      {
        Group &group = groups[extrapolation<dim>(spline, nodes.index(block))];
        group.blocks.push_back(block);
        group.fill += occupancy.fill(block);
        most = std::max(most, group.fill);
      }
    std::vector<unsigned int> chosen;
    for (const auto &[distance, group] : groups)
      if (group.fill >= (1. - equal_fills) * most)
        chosen.insert(chosen.end(), group.blocks.begin(), group.blocks.end());
    std::sort(chosen.begin(), chosen.end());
    return chosen;
  }

  template <int dim>
  std::vector<unsigned int>
  ExtensionSearch<dim>::blocks(const GridIndex<dim>            &center,
                               const std::vector<unsigned int> &support)
  {
    std::vector<unsigned int> best;
    double                    best_sum = std::numeric_limits<double>::max();
    std::size_t               n_before = 0;
    // The search looks at ever larger windows around the spline, doc/theory.md,
    // section 3.4. Each time it collects the connected inner grid cells with
    // the smallest Σ|e|. It ends once no block outside of the window can have a
    // smaller sum, or the larger window has brought nothing new. Where this
    // rank's own window of tables ends before that, the search ends without a
    // result, and the caller asks for a wider window.
    for (int radius = 2;; ++radius)
      {
        // The blocks' splines have copies, too, and these have to be known
        // here.
        if (!occupancy.window().holds(center,
                                      radius + 1 + SplineCopies<dim>::reach()))
          {
            met_edge = true;
            return {};
          }
        const auto list = connected(center, support, radius);
        best.clear(); // the larger window finds them again
        for (const unsigned int number : list)
          if (classes[number] == GridCellClass::inner)
            {
              const double sum = sum_of_weights(center, nodes.index(number));
              if (sum < best_sum)
                best.clear();
              if (sum <= best_sum)
                best.push_back(number);
              best_sum = std::min(best_sum, sum);
            }
        // A farther block can have a smaller sum than a nearer one on the
        // diagonal (Σ|e| = 17 against 7·7·7). Blocks outside of this window
        // have at least the sum `least`.
        const double least = 2. * (radius + 1) * (radius + 1) - 1.;
        if (best_sum < least || (radius > 2 && list.size() == n_before))
          return fullest(center, best);
        n_before = list.size();
      }
  }

  template std::array<double, 9>
  extension_weights(const GridIndex<2> &, const GridIndex<2> &);
  template std::array<double, 27>
  extension_weights(const GridIndex<3> &, const GridIndex<3> &);
  template class ExtensionSearch<2>;
  template class ExtensionSearch<3>;
} // namespace Morula
