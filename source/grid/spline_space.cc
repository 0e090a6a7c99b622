// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/grid/spline_space.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <numeric>

namespace Morula
{
  namespace
  {
    constexpr unsigned int none = numbers::invalid_unsigned_int;

    /** Coordinates of the grid cell on which spline @p a of a grid cell is
     *  centred. */
    template <int dim>
    GridIndex<dim>
    neighbor(GridIndex<dim> index, const unsigned int a)
    {
      for (unsigned int d = 0; d < dim; ++d)
        index[d] += BSpline<dim>::offset(a, d);
      return index;
    }
  } // namespace

  template <int dim>
  SplineSpace<dim>::SplineSpace(const BackgroundGrid<dim> &grid,
                                Occupancy<dim>             occupancy,
                                const GridParameters      &parameters)
    : occupancy_(std::move(occupancy))
    , box_(occupancy_.box())
    , extend(parameters.extension)
    , classes(classify(occupancy_, parameters.occupation_parameter))
    , copies(box_, classes)
  {
    if (extend)
      small_pieces = find_small_pieces(occupancy_, classes, copies);
    n_active = std::count_if(classes.begin(), classes.end(), is_active);
    n_inner =
      std::count_if(copies.list().begin(),
                    copies.list().end(),
                    [&](const SplineCopy &copy) {
                      return copy.inner && small_pieces.count(copy.piece) == 0;
                    });
    n_outer = copies.list().size() - n_inner;
    number_unknowns(grid);
    express_grid_cells(grid);
    find_relevant();
  }

  template <int dim>
  bool
  SplineSpace<dim>::is_unknown(const SplineCopy &copy) const
  {
    return !extend || (copy.inner && small_pieces.count(copy.piece) == 0);
  }

  template <int dim>
  void
  SplineSpace<dim>::number_unknowns(const BackgroundGrid<dim> &grid)
  {
    const unsigned int n_ranks =
      Utilities::MPI::n_mpi_processes(grid.communicator());
    const unsigned int rank =
      Utilities::MPI::this_mpi_process(grid.communicator());
    const auto &list = copies.list();

    std::vector<unsigned int> next(n_ranks + 1, 0);
    for (const SplineCopy &copy : list)
      if (is_unknown(copy))
        ++next[grid.owner(copy.spline) + 1];
    for (const auto &[piece, polynomial] : small_pieces)
      next[grid.owner(copies.lowest_grid_cell(piece)) + 1] +=
        polynomial.n_unknowns();
    std::partial_sum(next.begin(), next.end(), next.begin());

    n_unknowns_ = next[n_ranks];
    owned_      = IndexSet(n_unknowns_);
    owned_.add_range(next[rank], next[rank + 1]);

    pieces_of_unknowns_.resize(owned_.n_elements());
    const auto set_piece = [&](const unsigned int number,
                               const unsigned int piece) {
      if (owned_.is_element(number))
        pieces_of_unknowns_[owned_.index_within_set(number)] = piece;
    };
    numbers.assign(list.size(), none);
    for (unsigned int c = 0; c < list.size(); ++c)
      if (is_unknown(list[c]))
        {
          numbers[c] = next[grid.owner(list[c].spline)]++;
          set_piece(numbers[c], list[c].piece);
        }
    for (auto &[piece, polynomial] : small_pieces)
      {
        unsigned int &first = next[grid.owner(copies.lowest_grid_cell(piece))];
        polynomial.first_unknown = first;
        for (unsigned int k = 0; k < polynomial.n_unknowns(); ++k)
          set_piece(first++, piece);
      }
  }

  template <int dim>
  typename SplineSpace<dim>::Terms
  SplineSpace<dim>::expression(const unsigned int    c,
                               ExtensionSearch<dim> &search) const
  {
    if (numbers[c] != none)
      return {{numbers[c], 1.}};

    const SplineCopy    &copy  = copies.list()[c];
    const GridIndex<dim> index = box_.index(copy.spline);
    if (const auto found = small_pieces.find(copy.piece);
        found != small_pieces.end())
      return found->second.expression(box_.center(index), box_.spacing());
    const std::vector<unsigned int> blocks = search.blocks(copy);
    AssertThrow(!blocks.empty(), ExcInternalError());
    // doc/theory.md (3.3b); sums of integers, exact in any order
    std::map<unsigned int, double> sums;
    for (const unsigned int block : blocks)
      {
        const GridIndex<dim> inner   = box_.index(block);
        const auto           weights = extension_weights(index, inner);
        for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
          if (weights[a] != 0.)
            sums[numbers[copies.at(neighbor(inner, a), inner)]] += weights[a];
      }
    Terms terms;
    for (const auto &[unknown, sum] : sums)
      if (sum != 0.)
        terms.emplace_back(unknown, sum / blocks.size());
    return terms;
  }

  template <int dim>
  void
  SplineSpace<dim>::express_grid_cells(const BackgroundGrid<dim> &grid)
  {
    const unsigned int rank =
      Utilities::MPI::this_mpi_process(grid.communicator());
    ExtensionSearch<dim>          search(occupancy_, classes);
    std::map<unsigned int, Terms> outer; // many grid cells share a spline
    const auto                    terms_of = [&](const unsigned int copy) {
      if (numbers[copy] != none)
        return Terms{{numbers[copy], 1.}};
      auto found = outer.find(copy);
      if (found == outer.end())
        found = outer.emplace(copy, expression(copy, search)).first;
      return found->second;
    };
    for (unsigned int number = 0; number < box_.size(); ++number)
      if (is_active(classes[number]) && grid.owner(number) == rank)
        {
          const GridIndex<dim> index = box_.index(number);
          std::vector<Terms>   rows;
          for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
            rows.push_back(terms_of(copies.at(neighbor(index, a), index)));
          add_grid_cell(number, rows);
        }
  }

  template <int dim>
  void
  SplineSpace<dim>::add_grid_cell(const unsigned int        number,
                                  const std::vector<Terms> &rows)
  {
    constexpr unsigned int    n = BSpline<dim>::n;
    std::vector<unsigned int> columns;
    bool                      plain = true;
    for (unsigned int a = 0; a < n; ++a)
      {
        for (const auto &[unknown, weight] : rows[a])
          columns.push_back(unknown);
        plain = plain && rows[a].size() == 1 &&
                (a == 0 || columns[a] > columns[a - 1]);
      }
    std::sort(columns.begin(), columns.end());
    columns.erase(std::unique(columns.begin(), columns.end()), columns.end());

    GridCell grid_cell;
    grid_cell.number = number;
    if (!plain)
      {
        grid_cell.weights.assign(n * columns.size(), 0.);
        for (unsigned int a = 0; a < n; ++a)
          for (const auto &[unknown, weight] : rows[a])
            grid_cell.weights[a * columns.size() +
                              (std::lower_bound(
                                 columns.begin(), columns.end(), unknown) -
                               columns.begin())] += weight;
      }
    grid_cell.unknowns = std::move(columns);
    grid_cells_.push_back(std::move(grid_cell));
  }

  /** Finds the relevant unknowns, and replaces the global unknowns of the grid
   *  cells by positions in relevant(). */
  template <int dim>
  void
  SplineSpace<dim>::find_relevant()
  {
    std::vector<types::global_dof_index> used;
    for (const GridCell &grid_cell : grid_cells_)
      used.insert(used.end(),
                  grid_cell.unknowns.begin(),
                  grid_cell.unknowns.end());
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    relevant_ = IndexSet(n_unknowns_);
    relevant_.add_indices(used.begin(), used.end());
    relevant_.add_indices(owned_);
    relevant_.compress();
    for (GridCell &grid_cell : grid_cells_)
      for (unsigned int &unknown : grid_cell.unknowns)
        unknown = relevant_.index_within_set(unknown);
  }

  template <int dim>
  std::vector<double>
  SplineSpace<dim>::affine_coefficients(const unsigned int    piece,
                                        const double          a,
                                        const Tensor<1, dim> &gradient) const
  {
    std::vector<double> coefficients(owned_.n_elements(), 0.);
    const auto set = [&](const unsigned int unknown, const double value) {
      if (owned_.is_element(unknown))
        coefficients[owned_.index_within_set(unknown)] = value;
    };
    const auto value_at = [&](const Point<dim> &x) {
      return a + gradient * (x - Point<dim>());
    };
    for (unsigned int c = 0; c < numbers.size(); ++c)
      if (numbers[c] != none && copies.list()[c].piece == piece)
        set(numbers[c],
            value_at(box_.center(box_.index(copies.list()[c].spline))));
    if (const auto found = small_pieces.find(piece);
        found != small_pieces.end())
      {
        const PiecePolynomial<dim> &polynomial = found->second;
        set(polynomial.first_unknown, value_at(polynomial.center));
        for (unsigned int d = 0; d < dim; ++d)
          set(polynomial.first_unknown + 1 + d, gradient[d] * box_.spacing());
      }
    return coefficients;
  }

  template <int dim>
  const std::vector<unsigned int> &
  SplineSpace<dim>::pieces_of_unknowns() const
  {
    return pieces_of_unknowns_;
  }

  template <int dim>
  const std::vector<typename SplineSpace<dim>::GridCell> &
  SplineSpace<dim>::grid_cells() const
  {
    return grid_cells_;
  }

  template <int dim>
  const IndexSet &
  SplineSpace<dim>::owned() const
  {
    return owned_;
  }

  template <int dim>
  const IndexSet &
  SplineSpace<dim>::relevant() const
  {
    return relevant_;
  }

  template <int dim>
  unsigned int
  SplineSpace<dim>::n_unknowns() const
  {
    return n_unknowns_;
  }

  template <int dim>
  unsigned int
  SplineSpace<dim>::n_active_grid_cells() const
  {
    return n_active;
  }

  template <int dim>
  unsigned int
  SplineSpace<dim>::n_inner_splines() const
  {
    return n_inner;
  }

  template <int dim>
  unsigned int
  SplineSpace<dim>::n_outer_splines() const
  {
    return n_outer;
  }

  template <int dim>
  unsigned int
  SplineSpace<dim>::piece(const unsigned int number) const
  {
    return copies.piece(number);
  }

  template <int dim>
  unsigned int
  SplineSpace<dim>::n_pieces() const
  {
    return copies.n_pieces();
  }

  template <int dim>
  const GridBox<dim> &
  SplineSpace<dim>::box() const
  {
    return box_;
  }

  template <int dim>
  const Occupancy<dim> &
  SplineSpace<dim>::occupancy() const
  {
    return occupancy_;
  }

  template class SplineSpace<2>;
  template class SplineSpace<3>;
} // namespace Morula
