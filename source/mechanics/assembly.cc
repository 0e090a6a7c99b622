// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/send_records.h>
#include <morula/mechanics/assembly.h>

#include <deal.II/base/mpi.templates.h>

namespace Morula
{
  template <int dim, int n_components>
  MatrixScatter<dim, n_components>::MatrixScatter(
    const SplineSpace<dim>  &space,
    BlockMatrix             &matrix,
    const bool               symmetric,
    const MPI_Comm           comm,
    std::vector<UnknownLink> links)
    : space(space)
    , links(std::move(links))
    , matrix(matrix)
    , symmetric(symmetric)
    , comm(comm)
    , owners(owners_of_relevant())
  {
    // The columns that this rank's grid cells couple come first. From these the
    // owners of shared rows learn what they will receive; the pattern needs
    // both. The tables of positions come last, as they point into the arrays of
    // the finished matrix.
    const Numbers  columns   = couplings();
    const Messages announced = announce(columns);
    make_pattern(columns, announced);
    make_received(announced);
    make_positions(columns);
  }

  template <int dim, int n_components>
  std::vector<unsigned int>
  MatrixScatter<dim, n_components>::owners_of_relevant() const
  {
    // This rank's own unknowns need no question. Only the owners of the others
    // are asked for.
    const IndexSet &relevant = space.relevant();
    IndexSet        foreign  = relevant;
    foreign.subtract_set(space.owned());
    const std::vector<unsigned int> owners =
      Utilities::MPI::compute_index_owner(space.owned(), foreign, comm);
    std::vector<unsigned int> all(relevant.n_elements(),
                                  Utilities::MPI::this_mpi_process(comm));
    for (types::global_dof_index k = 0; k < owners.size(); ++k)
      all[relevant.index_within_set(foreign.nth_index_in_set(k))] = owners[k];
    return all;
  }

  template <int dim, int n_components>
  typename MatrixScatter<dim, n_components>::Numbers
  MatrixScatter<dim, n_components>::couplings() const
  {
    // Unknowns are numbered here as in space.relevant(): 0, 1, ... on this
    // rank. Two unknowns couple if they share a grid cell or a link. `last`
    // marks the columns that a row has already, so that none enters twice
    // without a search.
    Numbers columns(space.relevant().n_elements());
    Numbers elements_of(columns.size());
    for (unsigned int c = 0; c < n_elements(); ++c)
      for (const unsigned int unknown : rows_of(c))
        elements_of[unknown].push_back(c);
    std::vector<unsigned int> last(columns.size(),
                                   numbers::invalid_unsigned_int);
    for (unsigned int row = 0; row < columns.size(); ++row)
      for (const unsigned int c : elements_of[row])
        for (const unsigned int column : columns_of(c))
          if (last[column] != row && keeps(row, column))
            {
              last[column] = row;
              columns[row].push_back(column);
            }
    return columns;
  }

  template <int dim, int n_components>
  typename MatrixScatter<dim, n_components>::Messages
  MatrixScatter<dim, n_components>::announce(const Numbers &columns)
  {
    // The order of the messages is the order in which finish() sends blocks
    // later: by relevant number, and within a row in the order of its columns.
    // Both sides keep to it, so that no index has to travel again.
    const IndexSet    &relevant = space.relevant();
    const unsigned int rank     = Utilities::MPI::this_mpi_process(comm);
    Messages           messages;
    for (unsigned int s = 0; s < columns.size(); ++s)
      {
        if (owners[s] == rank)
          continue;
        auto &message = messages[owners[s]];
        message.push_back(relevant.nth_index_in_set(s));
        message.push_back(columns[s].size());
        for (const unsigned int column : columns[s])
          message.push_back(relevant.nth_index_in_set(column));
        auto &blocks = sent[owners[s]];
        blocks.resize(blocks.size() + block_size * columns[s].size());
      }
    return send_records(messages, comm);
  }

  template <int dim, int n_components>
  void
  MatrixScatter<dim, n_components>::make_pattern(const Numbers  &columns,
                                                 const Messages &announced)
  {
    // Each owned row takes the columns that this rank's grid cells couple with
    // it, then those that other ranks have announced.
    const IndexSet                   &relevant = space.relevant();
    const IndexSet                   &owned    = space.owned();
    std::vector<BlockMatrix::Columns> unknowns(owned.n_elements());
    for (unsigned int s = 0; s < columns.size(); ++s)
      if (const auto row = relevant.nth_index_in_set(s); owned.is_element(row))
        for (const unsigned int column : columns[s])
          unknowns[owned.index_within_set(row)].push_back(
            relevant.nth_index_in_set(column));
    for (const auto &[rank, message] : announced)
      // A record is: unknown, number of columns, columns.
      for (std::size_t m = 0; m < message.size(); m += 2 + message[m + 1])
        {
          auto &row = unknowns[owned.index_within_set(message[m])];
          row.insert(row.end(),
                     message.begin() + m + 2,
                     message.begin() + m + 2 + message[m + 1]);
        }
    matrix.reinit(owned, unknowns, n_components, symmetric, comm);
  }

  template <int dim, int n_components>
  void
  MatrixScatter<dim, n_components>::make_received(const Messages &announced)
  {
    // The values that arrive have no indices. So each announced block gets its
    // place in the matrix. A rank may send none.
    for (const auto &[rank, message] : announced)
      {
        std::vector<double *> &blocks = received[rank];
        for (std::size_t m = 0; m < message.size(); m += 2 + message[m + 1])
          {
            const auto row     = space.owned().index_within_set(message[m]);
            const auto columns = matrix.columns(row);
            for (types::global_dof_index k = 0; k < message[m + 1]; ++k)
              blocks.push_back(
                matrix.blocks(row) +
                block_size *
                  (std::lower_bound(columns.begin(),
                                    columns.end(),
                                    matrix.column_of(message[m + 2 + k])) -
                   columns.begin()));
          }
      }
  }

  template <int dim, int n_components>
  void
  MatrixScatter<dim, n_components>::make_positions(const Numbers &columns)
  {
    // Makes the tables that add() reads for every block of every grid cell's
    // matrix: where the row of a relevant unknown begins, in the matrix if this
    // rank owns it, else in the buffer that goes to its owner; and where in
    // such a row each column of a grid cell stands. The second loop inverts the
    // lists of unknowns of grid cells and links. The third goes row by row, so
    // that one inverse of a row's list of columns, position_of, serves all that
    // add to this row.
    const IndexSet  &relevant = space.relevant();
    std::vector<int> ids(relevant.n_elements()); // the matrix's columns
    for (unsigned int s = 0; s < ids.size(); ++s)
      ids[s] = matrix.column_of(relevant.nth_index_in_set(s));
    Numbers elements_of(relevant.n_elements()), rows_in(elements_of.size());
    positions.resize(n_elements());
    for (unsigned int c = 0; c < n_elements(); ++c)
      {
        positions[c].resize(rows_of(c).size() * columns_of(c).size());
        for (unsigned int s = 0; s < rows_of(c).size(); ++s)
          {
            elements_of[rows_of(c)[s]].push_back(c);
            rows_in[rows_of(c)[s]].push_back(s);
          }
      }

    // Rows of a buffer follow each other in the order of announce().
    rows.resize(relevant.n_elements());
    std::map<unsigned int, double *> next;
    for (auto &[rank, blocks] : sent)
      next[rank] = blocks.data();
    std::vector<Position> position_of(
      std::max(matrix.own().n_elements() + matrix.others().n_elements(),
               relevant.n_elements()));
    for (unsigned int unknown = 0; unknown < rows.size(); ++unknown)
      {
        const auto global = relevant.nth_index_in_set(unknown);
        const bool owned  = space.owned().is_element(global);
        const auto set    = [&](const auto &list) {
          AssertThrow(list.size() < not_kept, ExcInternalError());
          for (unsigned int k = 0; k < list.size(); ++k)
            position_of[list[k]] = k;
        };
        if (owned)
          {
            const auto row = space.owned().index_within_set(global);
            rows[unknown]  = matrix.blocks(row);
            set(matrix.columns(row));
          }
        else
          {
            rows[unknown] = next[owners[unknown]];
            next[owners[unknown]] += block_size * columns[unknown].size();
            set(columns[unknown]);
          }
        for (unsigned int k = 0; k < elements_of[unknown].size(); ++k)
          {
            const unsigned int c        = elements_of[unknown][k];
            const auto        &unknowns = columns_of(c);
            Position *const    position =
              &positions[c][rows_in[unknown][k] * unknowns.size()];
            for (unsigned int t = 0; t < unknowns.size(); ++t)
              position[t] =
                keeps(unknown, unknowns[t]) ?
                  position_of[owned ? ids[unknowns[t]] : unknowns[t]] :
                  not_kept;
          }
      }
  }

  template <int dim, int n_components>
  void
  MatrixScatter<dim, n_components>::add(const unsigned int         grid_cell,
                                        const std::vector<double> &local_matrix)
  {
    // Rows and columns of the local matrix are ordered by component, those of
    // the sparse one by unknown.
    const auto        &unknowns = rows_of(grid_cell);
    const unsigned int n        = unknowns.size();
    const unsigned int m        = columns_of(grid_cell).size();
    for (unsigned int s = 0; s < n; ++s)
      for (unsigned int t = 0; t < m; ++t)
        {
          const Position position = positions[grid_cell][s * m + t];
          if (position == not_kept)
            continue;
          double *block = rows[unknowns[s]] + position * block_size;
          for (unsigned int i = 0; i < n_components; ++i)
            for (unsigned int j = 0; j < n_components; ++j)
              *block++ +=
                local_matrix[((i * n + s) * n_components + j) * m + t];
        }
  }

  template <int dim, int n_components>
  void
  MatrixScatter<dim, n_components>::finish()
  {
    // Blocks arrive in the order of announce().
    for (const auto &[rank, values] : send_records(sent, comm))
      {
        const double *value = values.data();
        for (double *block : received.at(rank))
          for (unsigned int k = 0; k < block_size; ++k)
            *block++ += *value++;
      }
  }

  template class MatrixScatter<2, 1>;
  template class MatrixScatter<2, 2>;
  template class MatrixScatter<2, 3>;
  template class MatrixScatter<3, 1>;
  template class MatrixScatter<3, 2>;
  template class MatrixScatter<3, 3>;
} // namespace Morula
