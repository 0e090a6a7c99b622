// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/send_records.h>
#include <morula/mechanics/assembly.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi.templates.h>

#include <Epetra_CrsMatrix.h>
#include <Epetra_Map.h>

#include <algorithm>
#include <utility>

namespace Morula
{
  template <int dim, int n_components>
  MatrixScatter<dim, n_components>::MatrixScatter(
    const SplineSpace<dim>  &space,
    const IndexSet          &own_rows,
    Matrix                  &matrix,
    const MPI_Comm           comm,
    std::vector<UnknownLink> links)
    : space(space)
    , links(std::move(links))
    , matrix(matrix)
    , comm(comm)
  {
    // The columns that this rank's grid cells couple come first. From these the
    // owners of shared rows learn what they will receive; the pattern needs
    // both. The tables of positions come last, as they point into the arrays of
    // the finished matrix.
    const Couplings                 columns   = couplings();
    const std::vector<unsigned int> owners    = owners_of_relevant();
    const Messages                  announced = announce(columns, owners);
    make_pattern(columns, announced, own_rows);
    make_received(announced);
    make_positions(columns, owners);
  }

  template <int dim, int n_components>
  typename MatrixScatter<dim, n_components>::Couplings
  MatrixScatter<dim, n_components>::couplings() const
  {
    // Unknowns are numbered here as in space.relevant(): 0, 1, ... on this
    // rank. Two unknowns couple if they share a grid cell or a link. `last`
    // marks the columns that a row has already, so that none enters twice
    // without a search.
    Couplings columns(space.relevant().n_elements());
    Couplings grid_cells_of(columns.size());
    for (unsigned int c = 0; c < n_elements(); ++c)
      for (const unsigned int unknown : rows_of(c))
        grid_cells_of[unknown].push_back(c);
    std::vector<unsigned int> last(columns.size(),
                                   numbers::invalid_unsigned_int);
    for (unsigned int row = 0; row < columns.size(); ++row)
      {
        for (const unsigned int c : grid_cells_of[row])
          for (const unsigned int column : columns_of(c))
            if (last[column] != row)
              {
                last[column] = row;
                columns[row].push_back(column);
              }
        std::sort(columns[row].begin(), columns[row].end());
      }
    return columns;
  }

  template <int dim, int n_components>
  typename MatrixScatter<dim, n_components>::Messages
  MatrixScatter<dim, n_components>::announce(
    const Couplings &columns, const std::vector<unsigned int> &owners)
  {
    // The order of the messages is the order in which exchange() sends values
    // later: by owner, then by relevant number, and within a row by column.
    // Both sides keep to it, so that no index has to travel again.
    const IndexSet &relevant = space.relevant();
    Messages        messages;
    for (unsigned int s = 0; s < columns.size(); ++s)
      {
        const auto unknown = relevant.nth_index_in_set(s);
        if (space.owned().is_element(unknown))
          continue;
        auto &message = messages[owners[s]];
        message.push_back(unknown);
        message.push_back(columns[s].size());
        for (const unsigned int column : columns[s])
          message.push_back(relevant.nth_index_in_set(column));
        // Room for the block of each pair of unknowns, all components.
        auto &values = sent[owners[s]];
        values.resize(values.size() +
                      n_components * n_components * columns[s].size());
      }
    return send_records(messages, comm);
  }

  template <int dim, int n_components>
  void
  MatrixScatter<dim, n_components>::make_pattern(const Couplings &columns,
                                                 const Messages  &announced,
                                                 const IndexSet  &own_rows)
  {
    // Each owned row takes the columns that this rank's grid cells couple with
    // it, then those that other ranks have announced. A column may come from
    // several ranks, so rows are sorted and made unique. The columns that other
    // ranks own are collected in a list of their own: the column map has them
    // behind the owned ones.
    const IndexSet &relevant = space.relevant(), &owned = space.owned();
    Unknowns        unknowns(owned.n_elements());
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

    std::vector<types::global_dof_index> others; // columns, not owned
    for (auto &row : unknowns)
      {
        std::sort(row.begin(), row.end());
        row.erase(std::unique(row.begin(), row.end()), row.end());
        for (const auto unknown : row)
          if (!owned.is_element(unknown))
            others.push_back(unknown);
      }
    std::sort(others.begin(), others.end());
    others.erase(std::unique(others.begin(), others.end()), others.end());
    // reinit() wants a matrix, of which it takes the structure only. The values
    // of this one are never used.
    Epetra_CrsMatrix without_values(View, graph(unknowns, others, own_rows));
    without_values.FillComplete();
    matrix.reinit(without_values, false);
  }

  template <int dim, int n_components>
  Epetra_CrsGraph
  MatrixScatter<dim, n_components>::graph(
    const Unknowns                             &unknowns,
    const std::vector<types::global_dof_index> &others,
    const IndexSet                             &own_rows) const
  {
    // Columns get local numbers: owned ones first, in the order of the rows,
    // then the others by global number. FillComplete() would find an order
    // itself, at the price that the header states. All components of an unknown
    // stand side by side in columns and rows, so a row of one component has the
    // columns of the others.
    const IndexSet  &owned = space.owned();
    const Epetra_Map rows  = own_rows.make_trilinos_map(comm);

    std::vector<int> columns(rows.MyGlobalElements(),
                             rows.MyGlobalElements() + rows.NumMyElements());
    for (const auto unknown : others)
      for (unsigned int i = 0; i < n_components; ++i)
        columns.push_back(unknown * n_components + i);
    // Exact row lengths: Epetra then allocates once.
    std::vector<int> lengths;
    for (const auto &row : unknowns)
      lengths.insert(lengths.end(), n_components, n_components * row.size());
    Epetra_CrsGraph graph(
      Copy,
      rows,
      Epetra_Map(-1, columns.size(), columns.data(), 0, rows.Comm()),
      lengths.data(),
      true);

    std::vector<int> ids;
    for (unsigned int r = 0; r < unknowns.size(); ++r)
      {
        ids.clear();
        for (const auto unknown : unknowns[r])
          {
            // The local number of a column, as in the map above.
            const int number =
              owned.is_element(unknown) ?
                owned.index_within_set(unknown) :
                owned.n_elements() +
                  (std::lower_bound(others.begin(), others.end(), unknown) -
                   others.begin());
            for (unsigned int i = 0; i < n_components; ++i)
              ids.push_back(number * n_components + i);
          }
        std::sort(ids.begin(), ids.end());
        for (unsigned int i = 0; i < n_components; ++i)
          graph.InsertMyIndices(r * n_components + i, ids.size(), ids.data());
      }
    graph.FillComplete();
    graph.OptimizeStorage();
    return graph;
  }


  template <int dim, int n_components>
  void
  MatrixScatter<dim, n_components>::make_received(const Messages &announced)
  {
    // The values that arrive have no indices. So each announced row gets a
    // table: where in the row of the matrix the k-th announced column stands.
    // One component is enough, as the others stand next to it and all
    // components' rows have the same columns.
    std::vector<int> position_of(matrix.trilinos_matrix().NumMyCols());
    for (const auto &[rank, message] : announced)
      for (std::size_t m = 0; m < message.size(); m += 2 + message[m + 1])
        {
          auto &[number, row_positions] = received[rank].emplace_back();
          number = space.owned().index_within_set(message[m]);
          int     length;
          double *values;
          int    *ids;
          matrix.trilinos_matrix().ExtractMyRowView(number * n_components,
                                                    length,
                                                    values,
                                                    ids);
          // The inverse of the row's column list, for this row only. Entries of
          // earlier rows stay in position_of, but no column of this row reads
          // them.
          for (int k = 0; k < length; ++k)
            position_of[ids[k]] = k;
          for (types::global_dof_index k = 0; k < message[m + 1]; ++k)
            row_positions.push_back(position_of[column_id(message[m + 2 + k])]);
        }
  }

  template <int dim, int n_components>
  void
  MatrixScatter<dim, n_components>::make_positions(
    const Couplings &columns, const std::vector<unsigned int> &owners)
  {
    // Makes three tables that add() reads for every entry of every grid cell's
    // matrix: where each row of a relevant degree of freedom begins, in the
    // matrix if this rank owns it, else in the buffer that goes to its owner;
    // and where in such a row each column of a grid cell stands. The first loop
    // translates relevant unknowns to local columns and rows. The second one
    // inverts the grid cells' lists of unknowns. The third goes row by row, so
    // that one inverse of a row's column list, position_of, serves all grid
    // cells that add to this row.
    const IndexSet         &relevant = space.relevant();
    const Epetra_CrsMatrix &epetra   = matrix.trilinos_matrix();
    std::vector<int>        ids(relevant.n_elements());
    owned_number.assign(relevant.n_elements(), -1);
    for (unsigned int s = 0; s < relevant.n_elements(); ++s)
      {
        const auto unknown = relevant.nth_index_in_set(s);
        ids[s]             = column_id(unknown);
        if (space.owned().is_element(unknown))
          owned_number[s] = space.owned().index_within_set(unknown);
      }

    std::vector<std::vector<std::pair<unsigned int, unsigned int>>> places(
      relevant.n_elements()); // (grid cell, row in it)
    positions.resize(n_elements());
    for (unsigned int c = 0; c < n_elements(); ++c)
      {
        positions[c].resize(rows_of(c).size() * columns_of(c).size());
        for (unsigned int s = 0; s < rows_of(c).size(); ++s)
          places[rows_of(c)[s]].emplace_back(c, s);
      }

    // The place in the buffer of each owner up to which rows have been handed
    // out. It advances in the order of announce().
    rows.resize(relevant.n_elements() * n_components);
    std::map<unsigned int, std::size_t> n_sent;
    std::vector<unsigned int>           position_of(
      std::max<int>(epetra.NumMyCols(), relevant.n_elements()));
    // The loop is over the relevant unknowns, owned or not, since all of them
    // have rows here.
    for (unsigned int unknown = 0; unknown < places.size(); ++unknown)
      {
        // An owned row lies in the matrix: its columns are local column
        // numbers.
        const bool owned = owned_number[unknown] >= 0;
        for (unsigned int i = 0; i < n_components; ++i)
          if (owned)
            {
              int  length;
              int *row_ids;
              epetra.ExtractMyRowView(owned_number[unknown] * n_components + i,
                                      length,
                                      rows[unknown * n_components + i],
                                      row_ids);
              // All components' rows have the same columns, so the first one's
              // list serves all.
              for (int k = 0; i == 0 && k < length; ++k)
                position_of[row_ids[k]] = k;
            }
          else
            {
              // A row of another rank lies in a buffer, with the columns that
              // this rank has announced, n_components numbers each.
              const unsigned int rank          = owners[unknown];
              rows[unknown * n_components + i] = &sent[rank][n_sent[rank]];
              n_sent[rank] += n_components * columns[unknown].size();
            }
        if (!owned)
          for (unsigned int k = 0; k < columns[unknown].size(); ++k)
            position_of[columns[unknown][k]] = k * n_components;
        // Each grid cell that holds this unknown gets the places of its own
        // unknowns in the row.
        for (const auto &[c, s] : places[unknown])
          {
            const auto &unknowns = columns_of(c);
            for (unsigned int t = 0; t < unknowns.size(); ++t)
              positions[c][s * unknowns.size() + t] =
                position_of[owned ? ids[unknowns[t]] : unknowns[t]];
          }
      }
  }

  template <int dim, int n_components>
  void
  MatrixScatter<dim, n_components>::add(const unsigned int         grid_cell,
                                        const std::vector<double> &local_matrix)
  {
    // Rows and columns of the local matrix are ordered by component, those of
    // the sparse one by unknown. The components of a column stand side by side,
    // so one position serves all of them.
    const auto        &unknowns = rows_of(grid_cell);
    const unsigned int n        = unknowns.size();
    const unsigned int m        = columns_of(grid_cell).size();
    for (unsigned int s = 0; s < n; ++s)
      for (unsigned int i = 0; i < n_components; ++i)
        {
          const double *const source =
            &local_matrix[(i * n + s) * n_components * m];
          double *const target = rows[unknowns[s] * n_components + i];
          const unsigned int *const position = &positions[grid_cell][s * m];
          for (unsigned int j = 0; j < n_components; ++j)
            for (unsigned int t = 0; t < m; ++t)
              target[position[t] + j] += source[j * m + t];
        }
  }

  template <int dim, int n_components>
  std::map<unsigned int, std::vector<double>>
  MatrixScatter<dim, n_components>::exchange() const
  {
    // Both sides know from announce() how much comes from whom. So plain
    // messages between neighbours do, and no rank waits for one that has
    // nothing for it. All receives are posted first, so that messages go
    // straight into their buffers.
    constexpr int                               tag = 0;
    std::map<unsigned int, std::vector<double>> values;
    std::vector<MPI_Request>                    requests;
    for (const auto &[rank, rows] : received)
      {
        std::size_t n = 0;
        for (const Received &row : rows)
          n += n_components * n_components * row.second.size();
        std::vector<double> &buffer = values[rank];
        buffer.resize(n);
        requests.emplace_back();
        const int error = MPI_Irecv(
          buffer.data(), n, MPI_DOUBLE, rank, tag, comm, &requests.back());
        AssertThrowMPI(error);
      }
    for (const auto &[rank, buffer] : sent)
      {
        requests.emplace_back();
        const int error = MPI_Isend(buffer.data(),
                                    buffer.size(),
                                    MPI_DOUBLE,
                                    rank,
                                    tag,
                                    comm,
                                    &requests.back());
        AssertThrowMPI(error);
      }
    const int error =
      MPI_Waitall(requests.size(), requests.data(), MPI_STATUSES_IGNORE);
    AssertThrowMPI(error);
    return values;
  }

  template <int dim, int n_components>
  void
  MatrixScatter<dim, n_components>::finish()
  {
    // Records arrive in the order of announce(); a record holds all rows of one
    // unknown, one component after the other.
    const Epetra_CrsMatrix &epetra = matrix.trilinos_matrix();
    for (const auto &[rank, values] : exchange())
      {
        const double *value = values.data();
        for (const auto &[number, row_positions] : received.at(rank))
          for (unsigned int i = 0; i < n_components; ++i)
            {
              int     length;
              double *target;
              int    *ids;
              epetra.ExtractMyRowView(number * n_components + i,
                                      length,
                                      target,
                                      ids);
              for (const unsigned int position : row_positions)
                for (unsigned int j = 0; j < n_components; ++j)
                  target[position + j] += *value++;
            }
      }
  }

  template class MatrixScatter<2, 1>;
  template class MatrixScatter<2, 2>;
  template class MatrixScatter<2, 3>;
  template class MatrixScatter<3, 1>;
  template class MatrixScatter<3, 2>;
  template class MatrixScatter<3, 3>;
} // namespace Morula
