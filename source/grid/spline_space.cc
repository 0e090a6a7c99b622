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

    /** Disjoint sets; the representative is the smallest member. */
    class DisjointSets
    {
    public:
      explicit DisjointSets(const unsigned int n)
        : parents(n)
      {
        std::iota(parents.begin(), parents.end(), 0u);
      }

      unsigned int
      find(unsigned int i)
      {
        while (parents[i] != i)
          i = parents[i] = parents[parents[i]];
        return i;
      }

      void
      unite(const unsigned int i, const unsigned int j)
      {
        const unsigned int a = find(i), b = find(j);
        parents[std::max(a, b)] = std::min(a, b);
      }

    private:
      std::vector<unsigned int> parents;
    };

    /** Expands spline numbers to degrees of freedom. */
    IndexSet
    times_dim(const IndexSet &splines, const unsigned int dim)
    {
      IndexSet dofs(splines.size() * dim);
      for (auto range = splines.begin_intervals();
           range != splines.end_intervals();
           ++range)
        dofs.add_range(*range->begin() * dim, (range->last() + 1) * dim);
      dofs.compress();
      return dofs;
    }
  } // namespace

  template <int dim>
  SplineSpace<dim>::SplineSpace(const BackgroundGrid<dim> &grid,
                                const Occupancy<dim>      &occupancy,
                                const GridParameters      &parameters)
    : box_(occupancy.box())
    , extend(parameters.extension)
    , classes(classify(occupancy, parameters.occupation_parameter))
  {
    find_kinds();
    find_pieces();
    if (extend)
      find_affine_fields();
    number_unknowns(grid);
    express_cells(grid);
  }

  template <int dim>
  void
  SplineSpace<dim>::find_kinds()
  {
    kinds.assign(box_.size(), Kind::inactive);
    for (unsigned int number = 0; number < box_.size(); ++number)
      if (classes[number] != GridCellClass::inactive)
        {
          ++n_active;
          const Kind kind =
            classes[number] == GridCellClass::inner ? Kind::inner : Kind::outer;
          box_.for_neighbors(box_.index(number),
                             1,
                             [&](const unsigned int spline, const auto &) {
                               kinds[spline] = std::max(kinds[spline], kind);
                             });
        }
    n_inner = std::count(kinds.begin(), kinds.end(), Kind::inner);
    n_outer = std::count(kinds.begin(), kinds.end(), Kind::outer);
  }

  template <int dim>
  void
  SplineSpace<dim>::find_pieces()
  {
    DisjointSets sharing(box_.size()), touching(box_.size());
    for (unsigned int spline = 0; spline < box_.size(); ++spline)
      {
        if (kinds[spline] == Kind::inactive)
          continue;
        const bool   center_active = classes[spline] != GridCellClass::inactive;
        unsigned int first         = none;
        box_.for_neighbors(box_.index(spline),
                           1,
                           [&](const unsigned int number, const auto &) {
                             if (classes[number] == GridCellClass::inactive)
                               return;
                             if (first == none)
                               first = number;
                             sharing.unite(first, number);
                             if (center_active)
                               touching.unite(spline, number);
                           });
      }
    pieces.assign(box_.size(), none);
    components.assign(box_.size(), none);
    for (unsigned int number = 0; number < box_.size(); ++number)
      if (classes[number] != GridCellClass::inactive)
        {
          const unsigned int root = sharing.find(number);
          // The root is the smallest member, so it comes first.
          pieces[number]     = root == number ? n_pieces_++ : pieces[root];
          components[number] = touching.find(number);
        }
  }

  template <int dim>
  void
  SplineSpace<dim>::find_affine_fields()
  {
    std::vector<char> has_inner(box_.size(), 0);
    for (unsigned int number = 0; number < box_.size(); ++number)
      if (classes[number] == GridCellClass::inner)
        has_inner[components[number]] = 1;
    std::map<unsigned int, unsigned int> sizes;
    for (unsigned int number = 0; number < box_.size(); ++number)
      if (classes[number] != GridCellClass::inactive &&
          !has_inner[components[number]])
        {
          AffineField &field = affine_fields[components[number]];
          field.lowest_cell  = components[number];
          field.center += box_.center(box_.index(number)) - Point<dim>();
          ++sizes[components[number]];
        }
    for (auto &[component, field] : affine_fields)
      field.center /= sizes[component];
  }

  template <int dim>
  void
  SplineSpace<dim>::number_unknowns(const BackgroundGrid<dim> &grid)
  {
    const unsigned int n_ranks =
      Utilities::MPI::n_mpi_processes(grid.communicator());
    const unsigned int rank =
      Utilities::MPI::this_mpi_process(grid.communicator());
    const auto is_unknown = [&](const unsigned int spline) {
      return kinds[spline] == Kind::inner ||
             (!extend && kinds[spline] == Kind::outer);
    };

    std::vector<unsigned int> next(n_ranks + 1, 0);
    for (unsigned int spline = 0; spline < box_.size(); ++spline)
      if (is_unknown(spline))
        ++next[grid.owner(spline) + 1];
    for (const auto &[component, field] : affine_fields)
      next[grid.owner(field.lowest_cell) + 1] += dim + 1;
    std::partial_sum(next.begin(), next.end(), next.begin());

    n_splines = next[n_ranks];
    owned_    = IndexSet(n_splines);
    owned_.add_range(next[rank], next[rank + 1]);
    owned_dofs_ = times_dim(owned_, dim);

    numbers.assign(box_.size(), none);
    for (unsigned int spline = 0; spline < box_.size(); ++spline)
      if (is_unknown(spline))
        numbers[spline] = next[grid.owner(spline)]++;
    for (auto &[component, field] : affine_fields)
      {
        unsigned int &first = next[grid.owner(field.lowest_cell)];
        field.first_unknown = first;
        first += dim + 1;
      }

    pieces_of_unknowns_.resize(owned_.n_elements());
    for (unsigned int spline = 0; spline < box_.size(); ++spline)
      if (numbers[spline] != none && owned_.is_element(numbers[spline]))
        pieces_of_unknowns_[owned_.index_within_set(numbers[spline])] =
          piece_of_spline(spline);
    for (const auto &[component, field] : affine_fields)
      for (unsigned int k = 0; k <= dim; ++k)
        if (owned_.is_element(field.first_unknown + k))
          pieces_of_unknowns_[owned_.index_within_set(field.first_unknown +
                                                      k)] = pieces[component];
  }

  template <int dim>
  std::vector<std::pair<unsigned int, double>>
  SplineSpace<dim>::expression(const unsigned int    spline,
                               ExtensionSearch<dim> &search) const
  {
    if (numbers[spline] != none)
      return {{numbers[spline], 1.}};

    std::vector<std::pair<unsigned int, double>> terms;
    const GridIndex<dim>                         index = box_.index(spline);
    if (const auto block = search.block(index))
      {
        const GridIndex<dim> inner   = box_.index(*block);
        const auto           weights = extension_weights(index, inner);
        for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
          {
            GridIndex<dim> neighbor = inner;
            for (unsigned int d = 0; d < dim; ++d)
              neighbor[d] += BSpline<dim>::offset(a, d);
            if (weights[a] != 0.)
              terms.emplace_back(numbers[box_.number(neighbor)], weights[a]);
          }
        return terms;
      }

    unsigned int component = none;
    box_.for_neighbors(index, 1, [&](const unsigned int number, const auto &) {
      component = std::min(component, components[number]);
    });
    const AffineField   &field    = affine_fields.at(component);
    const Tensor<1, dim> distance = box_.center(index) - field.center;
    terms.emplace_back(field.first_unknown, 1.);
    for (unsigned int d = 0; d < dim; ++d)
      terms.emplace_back(field.first_unknown + 1 + d,
                         distance[d] / box_.spacing());
    return terms;
  }

  template <int dim>
  void
  SplineSpace<dim>::express_cells(const BackgroundGrid<dim> &grid)
  {
    constexpr unsigned int n = BSpline<dim>::n;
    const unsigned int     rank =
      Utilities::MPI::this_mpi_process(grid.communicator());

    using Terms = std::vector<std::pair<unsigned int, double>>;
    ExtensionSearch<dim>          search(box_, classes);
    std::map<unsigned int, Terms> outer; // many grid cells share a spline
    const auto                    terms_of = [&](const unsigned int spline) {
      if (numbers[spline] != none)
        return Terms{{numbers[spline], 1.}};
      auto found = outer.find(spline);
      if (found == outer.end())
        found = outer.emplace(spline, expression(spline, search)).first;
      return found->second;
    };

    std::vector<types::global_dof_index>   used;
    std::vector<std::vector<unsigned int>> unknowns; // global numbers
    for (unsigned int number = 0; number < box_.size(); ++number)
      {
        if (classes[number] == GridCellClass::inactive ||
            grid.owner(number) != rank)
          continue;
        std::vector<Terms> rows;
        box_.for_neighbors(box_.index(number),
                           1,
                           [&](const unsigned int spline, const auto &) {
                             rows.push_back(terms_of(spline));
                           });
        AssertDimension(rows.size(), n);

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
        columns.erase(std::unique(columns.begin(), columns.end()),
                      columns.end());

        Cell cell;
        cell.number = number;
        if (!plain)
          {
            cell.weights.assign(n * columns.size(), 0.);
            for (unsigned int a = 0; a < n; ++a)
              for (const auto &[unknown, weight] : rows[a])
                cell.weights[a * columns.size() +
                             (std::lower_bound(
                                columns.begin(), columns.end(), unknown) -
                              columns.begin())] += weight;
          }
        used.insert(used.end(), columns.begin(), columns.end());
        unknowns.push_back(std::move(columns));
        cells_.push_back(std::move(cell));
      }

    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    relevant_ = IndexSet(n_splines);
    relevant_.add_indices(used.begin(), used.end());
    relevant_.add_indices(owned_);
    relevant_.compress();
    relevant_dofs_ = times_dim(relevant_, dim);
    for (std::size_t c = 0; c < cells_.size(); ++c)
      for (const unsigned int unknown : unknowns[c])
        cells_[c].unknowns.push_back(relevant_.index_within_set(unknown));
  }

  template <int dim>
  unsigned int
  SplineSpace<dim>::piece_of_spline(const unsigned int spline) const
  {
    unsigned int piece = none;
    box_.for_neighbors(box_.index(spline),
                       1,
                       [&](const unsigned int number, const auto &) {
                         piece = std::min(piece, pieces[number]);
                       });
    return piece;
  }

  template <int dim>
  std::vector<double>
  SplineSpace<dim>::affine_coefficients(const unsigned int    piece,
                                        const Tensor<1, dim> &a,
                                        const Tensor<2, dim> &A) const
  {
    std::vector<double> coefficients(owned_dofs_.n_elements(), 0.);
    const auto          set = [&](const unsigned int    unknown,
                         const Tensor<1, dim> &value) {
      if (!owned_.is_element(unknown))
        return;
      const unsigned int local = owned_.index_within_set(unknown);
      if (pieces_of_unknowns_[local] == piece)
        for (unsigned int d = 0; d < dim; ++d)
          coefficients[local * dim + d] = value[d];
    };
    for (unsigned int spline = 0; spline < box_.size(); ++spline)
      if (numbers[spline] != none)
        set(numbers[spline],
            a + A * (box_.center(box_.index(spline)) - Point<dim>()));
    for (const auto &[component, field] : affine_fields)
      {
        set(field.first_unknown, a + A * (field.center - Point<dim>()));
        for (unsigned int d = 0; d < dim; ++d)
          {
            Tensor<1, dim> slope;
            for (unsigned int i = 0; i < dim; ++i)
              slope[i] = A[i][d] * box_.spacing();
            set(field.first_unknown + 1 + d, slope);
          }
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
  const std::vector<typename SplineSpace<dim>::Cell> &
  SplineSpace<dim>::cells() const
  {
    return cells_;
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
  const IndexSet &
  SplineSpace<dim>::owned_dofs() const
  {
    return owned_dofs_;
  }

  template <int dim>
  const IndexSet &
  SplineSpace<dim>::relevant_dofs() const
  {
    return relevant_dofs_;
  }

  template <int dim>
  unsigned int
  SplineSpace<dim>::n_unknowns() const
  {
    return n_splines * dim;
  }

  template <int dim>
  unsigned int
  SplineSpace<dim>::n_active_cells() const
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
    return pieces[number];
  }

  template <int dim>
  unsigned int
  SplineSpace<dim>::n_pieces() const
  {
    return n_pieces_;
  }

  template <int dim>
  const GridBox<dim> &
  SplineSpace<dim>::box() const
  {
    return box_;
  }

  template class SplineSpace<2>;
  template class SplineSpace<3>;
} // namespace Morula
