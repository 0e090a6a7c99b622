// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/matrix_scatter.h>

#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <algorithm>

namespace Morula
{
  template <int dim>
  MatrixScatter<dim>::MatrixScatter(const SplineSpace<dim> &space,
                                    Matrix                 &matrix,
                                    const MPI_Comm          comm)
    : space(space)
    , matrix(matrix)
  {
    make_pattern(comm);
    make_positions();
  }

  template <int dim>
  void
  MatrixScatter<dim>::make_pattern(const MPI_Comm comm)
  {
    // Which unknowns couple, by this rank's relevant unknowns.
    const IndexSet                        &relevant = space.relevant();
    std::vector<std::vector<unsigned int>> couplings(relevant.n_elements());
    std::vector<std::vector<unsigned int>> cells_of(relevant.n_elements());
    for (unsigned int c = 0; c < space.cells().size(); ++c)
      for (const unsigned int unknown : space.cells()[c].unknowns)
        cells_of[unknown].push_back(c);
    std::vector<unsigned int> last(relevant.n_elements(),
                                   numbers::invalid_unsigned_int);
    for (unsigned int row = 0; row < couplings.size(); ++row)
      {
        for (const unsigned int c : cells_of[row])
          for (const unsigned int column : space.cells()[c].unknowns)
            if (last[column] != row)
              {
                last[column] = row;
                couplings[row].push_back(column);
              }
        std::sort(couplings[row].begin(), couplings[row].end());
      }

    TrilinosWrappers::SparsityPattern    pattern(space.owned_dofs(),
                                              space.owned_dofs(),
                                              space.relevant_dofs(),
                                              comm);
    std::vector<types::global_dof_index> columns;
    for (unsigned int row = 0; row < couplings.size(); ++row)
      {
        columns.clear();
        for (const unsigned int column : couplings[row])
          for (unsigned int i = 0; i < dim; ++i)
            columns.push_back(relevant.nth_index_in_set(column) * dim + i);
        for (unsigned int i = 0; i < dim; ++i)
          pattern.add_entries(relevant.nth_index_in_set(row) * dim + i,
                              columns.begin(),
                              columns.end(),
                              true);
      }
    pattern.compress();
    matrix.reinit(pattern);
  }

  template <int dim>
  void
  MatrixScatter<dim>::make_positions()
  {
    const IndexSet         &relevant = space.relevant();
    const Epetra_CrsMatrix &epetra   = matrix.trilinos_matrix();
    std::vector<int>        column_id(relevant.n_elements() * dim);
    owned_number.assign(relevant.n_elements(), -1);
    for (unsigned int s = 0; s < relevant.n_elements(); ++s)
      {
        const auto unknown = relevant.nth_index_in_set(s);
        for (unsigned int i = 0; i < dim; ++i)
          {
            column_id[s * dim + i] = epetra.ColMap().LID(
              static_cast<TrilinosWrappers::types::int_type>(unknown * dim +
                                                             i));
            if (column_id[s * dim + i] != column_id[s * dim] + int(i))
              width = dim;
          }
        if (space.owned().is_element(unknown))
          owned_number[s] = space.owned().index_within_set(unknown);
      }

    std::vector<std::vector<std::pair<unsigned int, unsigned int>>> places(
      relevant.n_elements()); // (cell, row in the cell)
    positions.resize(space.cells().size());
    for (unsigned int c = 0; c < space.cells().size(); ++c)
      {
        const auto &unknowns = space.cells()[c].unknowns;
        positions[c].resize(unknowns.size() * unknowns.size() * width);
        for (unsigned int s = 0; s < unknowns.size(); ++s)
          if (owned_number[unknowns[s]] >= 0)
            places[unknowns[s]].emplace_back(c, s);
      }

    rows.resize(space.owned_dofs().n_elements());
    std::vector<unsigned int> position_of(epetra.NumMyCols());
    for (unsigned int unknown = 0; unknown < places.size(); ++unknown)
      {
        if (owned_number[unknown] < 0)
          continue;
        int     length;
        double *values;
        int    *columns;
        for (unsigned int i = 0; i < dim; ++i)
          {
            epetra.ExtractMyRowView(owned_number[unknown] * dim + i,
                                    length,
                                    values,
                                    columns);
            rows[owned_number[unknown] * dim + i] = values;
          }
        // All components' rows have the same columns.
        for (int k = 0; k < length; ++k)
          position_of[columns[k]] = k;
        for (const auto &[c, s] : places[unknown])
          {
            const auto &unknowns = space.cells()[c].unknowns;
            for (unsigned int t = 0; t < unknowns.size(); ++t)
              for (unsigned int j = 0; j < width; ++j)
                positions[c][(s * unknowns.size() + t) * width + j] =
                  position_of[column_id[unknowns[t] * dim + j]];
          }
      }
  }

  template <int dim>
  void
  MatrixScatter<dim>::add(const unsigned int         cell,
                          const std::vector<double> &cell_matrix)
  {
    const auto        &unknowns = space.cells()[cell].unknowns;
    const unsigned int m        = unknowns.size();
    std::vector<types::global_dof_index> dofs;
    std::vector<double>                  values;
    for (unsigned int s = 0; s < m; ++s)
      for (unsigned int i = 0; i < dim; ++i)
        {
          const double *const source = &cell_matrix[(i * m + s) * dim * m];
          if (owned_number[unknowns[s]] >= 0)
            {
              double *const target = rows[owned_number[unknowns[s]] * dim + i];
              const unsigned int *const position =
                &positions[cell][s * m * width];
              for (unsigned int j = 0; j < dim; ++j)
                for (unsigned int t = 0; t < m; ++t)
                  target[width == 1 ? position[t] + j :
                                      position[t * width + j]] +=
                    source[j * m + t];
              continue;
            }
          if (dofs.empty())
            for (unsigned int j = 0; j < dim; ++j)
              for (const unsigned int unknown : unknowns)
                dofs.push_back(
                  space.relevant().nth_index_in_set(unknown) * dim + j);
          matrix.add(space.relevant().nth_index_in_set(unknowns[s]) * dim + i,
                     dofs.size(),
                     dofs.data(),
                     source,
                     false);
        }
  }

  template class MatrixScatter<2>;
  template class MatrixScatter<3>;
} // namespace Morula
