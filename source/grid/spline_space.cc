// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/grid/spline_space.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

namespace Morula
{
  namespace
  {
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
    , extend(parameters.extension)
  {
    // Classes, copies and blocks first. Whether the window was wide enough
    // shows only after the search for blocks. If any rank's was not, all begin
    // anew with a wider one, since the sums travel between ranks. Then unknowns
    // get numbers over all ranks, each rank asks for those of others that it
    // needs, and each active grid cell gets its rows of weights.
    bool wide = find_splines(grid, parameters);
    while (Utilities::MPI::logical_or(!wide, grid.communicator()))
      {
        occupancy_.widen(grid, !wide);
        wide = find_splines(grid, parameters);
      }
    count(grid.communicator());
    std::vector<unsigned int> own;
    for (unsigned int c = 0; c < copies.list().size(); ++c)
      if (copies.is_own(copies.list()[c]) && is_unknown(copies.list()[c]))
        own.push_back(c);
    numbers = UnknownNumbers<dim>(copies, own, small_pieces, grid);
    numbers.ask(copies_of_others(), copies, grid);
    owned_  = numbers.owned();
    pieces_ = numbers.pieces();
    std::map<unsigned int, Terms> outer; // many grid cells share a spline
    const auto                    terms_of = [&](const unsigned int copy) {
      if (numbers.has(copy))
        return Terms{{numbers[copy], 1.}};
      auto found = outer.find(copy);
      if (found == outer.end())
        found = outer.emplace(copy, expression(copy)).first;
      return found->second;
    };
    for (const unsigned int node : copies.own_nodes())
      {
        std::vector<Terms> rows;
        for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
          rows.push_back(terms_of(copy_at(node, a)));
        add_grid_cell(node, rows);
      }
    find_relevant();
  }

  template <int dim>
  bool
  SplineSpace<dim>::find_splines(const BackgroundGrid<dim> &grid,
                                 const GridParameters      &parameters)
  {
    classes = classify(occupancy_, parameters.occupation_parameter);
    copies =
      SplineCopies<dim>(occupancy_.window(), occupancy_.nodes(), classes, grid);
    // Without extension every spline is an unknown of its own.
    if (!extend)
      return true;
    small_pieces =
      find_small_pieces(occupancy_, classes, copies, grid.communicator());
    blocks.clear();
    ExtensionSearch<dim> search(occupancy_, classes);
    // Blocks are searched for outer copies of this rank's own grid cells alone.
    for (const unsigned int node : copies.own_nodes())
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        {
          const unsigned int c    = copy_at(node, a);
          const SplineCopy  &copy = copies.list()[c];
          // Many grid cells share a spline; its blocks are searched once.
          if (!is_unknown(copy) && small_pieces.count(copy.piece) == 0 &&
              blocks.count(c) == 0)
            blocks[c] = search.blocks(copies.center(c), copies.nodes_of(copy));
        }
    return !search.needs_wider_window();
  }


  template <int dim>
  unsigned int
  SplineSpace<dim>::copy_at(const unsigned int node, const unsigned int a) const
  {
    return copies.at(neighbor(occupancy_.nodes().index(node), a), node);
  }

  /** Unknowns of other ranks that this rank's grid cells need. */
  template <int dim>
  std::vector<unsigned int>
  SplineSpace<dim>::copies_of_others() const
  {
    // These are splines of own grid cells that are unknowns of other ranks, and
    // the splines of other ranks by which own outer ones are expressed.
    std::vector<unsigned int> wanted;
    for (const unsigned int node : copies.own_nodes())
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        {
          const unsigned int c    = copy_at(node, a);
          const SplineCopy  &copy = copies.list()[c];
          if (!copies.is_own(copy) && is_unknown(copy))
            wanted.push_back(c);
        }
    for (const auto &[copy, inner] : blocks)
      for (const unsigned int block : inner)
        for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
          if (const unsigned int c = copy_at(block, a);
              !copies.is_own(copies.list()[c]))
            wanted.push_back(c);
    std::sort(wanted.begin(), wanted.end());
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    return wanted;
  }

  template <int dim>
  typename SplineSpace<dim>::Terms
  SplineSpace<dim>::expression(const unsigned int c) const
  {
    // A copy of a piece too small to have inner grid cells follows the piece's
    // own few unknowns. Any other one that is no unknown is outer, and
    // continued from inner grid cells.
    const SplineCopy    &copy  = copies.list()[c];
    const GridIndex<dim> index = occupancy_.window().index(copy.spline);
    if (const auto found = small_pieces.find(copy.piece);
        found != small_pieces.end())
      return found->second.expression(box().center(index), box().spacing());
    const std::vector<unsigned int> &inner_grid_cells = blocks.at(c);
    AssertThrow(!inner_grid_cells.empty(), ExcInternalError());
    // This is the mean over all blocks, doc/theory.md (3.3b). The weights are
    // integers, so the sums are exact in any order; one division follows.
    std::map<unsigned int, double> sums;
    for (const unsigned int block : inner_grid_cells)
      {
        const auto weights =
          extension_weights(index, occupancy_.nodes().index(block));
        for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
          if (weights[a] != 0.)
            sums[numbers[copy_at(block, a)]] += weights[a];
      }
    Terms terms;
    for (const auto &[unknown, sum] : sums)
      if (sum != 0.)
        terms.emplace_back(unknown, sum / inner_grid_cells.size());
    return terms;
  }

  template <int dim>
  void
  SplineSpace<dim>::add_grid_cell(const unsigned int        node,
                                  const std::vector<Terms> &rows)
  {
    // A grid cell whose splines are all unknowns, each once, keeps them in the
    // order of the splines and has no weights: that is the fast path of all
    // loops. Otherwise the unknowns of all its splines are sorted, each taken
    // once, and the weights stand in a matrix of splines by unknowns, C of
    // doc/theory.md (3.5).
    constexpr unsigned int    n = BSpline<dim>::n;
    std::vector<unsigned int> terms; // of one spline after the other
    for (const Terms &row : rows)
      for (const auto &term : row)
        terms.push_back(term.first);
    std::vector<unsigned int> columns = terms;
    std::sort(columns.begin(), columns.end());
    columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
    const bool is_one_each =
      columns.size() == n &&
      std::all_of(rows.begin(), rows.end(), [](const Terms &row) {
        return row.size() == 1 && row.front().second == 1.;
      });

    GridCell grid_cell;
    std::tie(grid_cell.number, grid_cell.part) = occupancy_.nodes().name(node);
    grid_cell.thin                             = occupancy_.is_thin(node);
    if (is_one_each)
      grid_cell.unknowns = std::move(terms);
    else
      {
        grid_cell.weights.assign(n * columns.size(), 0.);
        // Several terms of a spline may have the same unknown.
        for (unsigned int a = 0; a < n; ++a)
          for (const auto &[unknown, weight] : rows[a])
            grid_cell.weights[a * columns.size() +
                              (std::lower_bound(
                                 columns.begin(), columns.end(), unknown) -
                               columns.begin())] += weight;
        grid_cell.unknowns = std::move(columns);
      }
    grid_cells_.push_back(std::move(grid_cell));
  }

  /** Finds the relevant unknowns, and replaces the global unknowns of the grid
   *  cells by positions in relevant(). */
  template <int dim>
  void
  SplineSpace<dim>::find_relevant()
  {
    // Grid cells have had global unknowns so far. All passes look up values of
    // this rank by position in relevant(), so the numbers are replaced once.
    std::vector<types::global_dof_index> used;
    for (const GridCell &grid_cell : grid_cells_)
      used.insert(used.end(),
                  grid_cell.unknowns.begin(),
                  grid_cell.unknowns.end());
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    relevant_ = IndexSet(n_unknowns());
    relevant_.add_indices(used.begin(), used.end());
    relevant_.add_indices(owned());
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
    // Unknown splines get the field's value at their centre, which reproduces
    // affine fields. Small pieces have unknowns of their polynomial: the value
    // at its centre and the slopes per grid spacing, doc/theory.md (3.4);
    // quadratic ones are 0.
    std::vector<double> coefficients(owned().n_elements(), 0.);
    // The unknowns of this rank stand body by body. Those of other bodies stay
    // at 0.
    std::size_t first = 0;
    for (unsigned int b = 0; b < bodies.size(); ++b)
      {
        if (piece >= first_piece[b] && piece < first_piece[b + 1])
          {
            const auto of_body =
              bodies[b].affine_coefficients(piece - first_piece[b],
                                            a,
                                            gradient);
            std::copy(of_body.begin(),
                      of_body.end(),
                      coefficients.begin() + first);
          }
        first += bodies[b].owned().n_elements();
      }
    if (!bodies.empty())
      return coefficients;
    const auto set = [&](const unsigned int unknown, const double value) {
      if (owned().is_element(unknown))
        coefficients[owned().index_within_set(unknown)] = value;
    };
    const auto value_at = [&](const Point<dim> &x) {
      return a + gradient * (x - Point<dim>());
    };
    for (unsigned int c = 0; c < copies.list().size(); ++c)
      if (numbers.has(c) && copies.list()[c].piece == piece)
        set(numbers[c],
            value_at(box().center(
              occupancy_.window().index(copies.list()[c].spline))));
    if (const auto found = small_pieces.find(piece);
        found != small_pieces.end())
      {
        const PiecePolynomial<dim> &polynomial = found->second;
        set(polynomial.first_unknown, value_at(polynomial.center));
        for (unsigned int d = 0; d < dim; ++d)
          set(polynomial.first_unknown + 1 + d, gradient[d] * box().spacing());
      }
    return coefficients;
  }



  namespace
  {
    /** The numbers of one body's unknowns in the common space. */
    class CommonNumbers
    {
    public:
      /** A body's unknowns from begins[r] on, which are those of rank r, get
       *  the numbers from targets[r] on. */
      std::vector<unsigned int> begins, targets;

      unsigned int
      operator()(const unsigned int unknown) const
      {
        // Of several ranks with one begin all but the last own nothing.
        const auto rank =
          std::upper_bound(begins.begin(), begins.end(), unknown) -
          begins.begin() - 1;
        return targets[rank] + (unknown - begins[rank]);
      }
    };

    /** The common numbers of all bodies, and their sum over ranks before this
     *  one. Unknowns run rank by rank, on each rank body by body. Collective.
     */
    std::vector<CommonNumbers>
    number_together(const std::vector<unsigned int> &n_own, const MPI_Comm comm)
    {
      const auto of_ranks = Utilities::MPI::all_gather(comm, n_own);
      std::vector<CommonNumbers> numbers(n_own.size());
      std::vector<unsigned int>  begins(n_own.size(), 0);
      unsigned int               target = 0;
      for (const auto &of_rank : of_ranks)
        for (std::size_t b = 0; b < of_rank.size(); ++b)
          {
            numbers[b].begins.push_back(begins[b]);
            numbers[b].targets.push_back(target);
            begins[b] += of_rank[b];
            target += of_rank[b];
          }
      return numbers;
    }
  } // namespace


  template <int dim>
  SplineSpace<dim>::SplineSpace(std::vector<SplineSpace> spaces,
                                const MPI_Comm           comm)
    : occupancy_(spaces.at(0).occupancy_)
    , extend(spaces[0].extend)
    , bodies(std::move(spaces))
  {
    // Each body's unknowns are numbered from 0. They get numbers in the common
    // space, by which the bodies' grid cells are written anew; then these are
    // sorted and the unknowns that they use become the relevant ones. Pieces
    // and counts of the bodies follow one another.
    std::vector<unsigned int> n_own;
    for (const SplineSpace &body : bodies)
      n_own.push_back(body.owned().n_elements());
    const std::vector<CommonNumbers> numbers = number_together(n_own, comm);
    unsigned int                     n_all   = 0;
    for (const SplineSpace &body : bodies)
      n_all += body.n_unknowns();
    owned_ = IndexSet(n_all);
    first_piece.assign(1, 0);
    for (unsigned int b = 0; b < bodies.size(); ++b)
      {
        const SplineSpace &body = bodies[b];
        if (n_own[b] > 0)
          {
            const unsigned int first =
              numbers[b](body.owned().nth_index_in_set(0));
            owned_.add_range(first, first + n_own[b]);
          }
        for (const unsigned int piece : body.pieces_)
          pieces_.push_back(first_piece[b] + piece);
        first_piece.push_back(first_piece[b] + body.n_pieces());
        for (GridCell grid_cell : body.grid_cells_)
          {
            for (unsigned int &unknown : grid_cell.unknowns)
              unknown = numbers[b](body.relevant().nth_index_in_set(unknown));
            grid_cell.part = b;
            grid_cells_.push_back(std::move(grid_cell));
          }
        n_active += body.n_active;
        n_inner += body.n_inner;
        n_outer += body.n_outer;
      }
    owned_.compress();
    std::sort(grid_cells_.begin(),
              grid_cells_.end(),
              [](const GridCell &a, const GridCell &b) {
                return std::tie(a.number, a.part) < std::tie(b.number, b.part);
              });
    find_relevant();
  }



  template class SplineSpace<2>;
  template class SplineSpace<3>;
} // namespace Morula
