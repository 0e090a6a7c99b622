// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_block_matrix_h
#define morula_base_block_matrix_h


#include <morula/base/send_records.h>

#include <deal.II/base/array_view.h>
#include <deal.II/base/index_set.h>
#include <deal.II/base/partitioner.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <mpi.h>

#include <cstddef>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /**
   * The entries of a distributed vector that a rank needs besides its own. They
   * come and go by messages between neighbours alone: deal.II's Partitioner
   * has no barrier and no reduction.
   */
  class Halo
  {
  public:
    /** Collective.
     *  @param own    an interval; those of all ranks follow each other
     *  @param others of other ranks */
    Halo(const IndexSet &own, const IndexSet &others, const MPI_Comm comm)
      : partitioner(own, others, comm)
      , buffer(partitioner.n_import_indices())
    {}

    /** Puts the other ranks' entries into @p others, in the order of their
     *  numbers. Neighbours have to do the same. */
    void
    fetch(const double *own, double *others) const
    {
      // deal.II sends the own entries that others need and receives the ghost
      // entries, without a barrier.
      const ArrayView<double>  ghosts(others, partitioner.n_ghost_indices());
      std::vector<MPI_Request> requests;
      partitioner.export_to_ghosted_array_start(
        channel,
        ArrayView<const double>(own, partitioner.locally_owned_size()),
        make_array_view(buffer),
        ghosts,
        requests);
      partitioner.export_to_ghosted_array_finish(ghosts, requests);
    }

    /** The transpose: adds @p others to the entries of the ranks that own them,
     *  and clears them. */
    void
    add_back(double *others, double *own) const
    {
      const ArrayView<double>  ghosts(others, partitioner.n_ghost_indices());
      std::vector<MPI_Request> requests;
      partitioner.import_from_ghosted_array_start(VectorOperation::add,
                                                  channel,
                                                  ghosts,
                                                  make_array_view(buffer),
                                                  requests);
      partitioner.import_from_ghosted_array_finish(
        VectorOperation::add,
        ArrayView<const double>(buffer.data(), buffer.size()),
        ArrayView<double>(own, partitioner.locally_owned_size()),
        ghosts,
        requests);
    }

    /**
     * Lists of any length that go with the entries. Collective.
     * @tparam T trivially copyable
     * @param append appends the list of an own entry, by its number among these
     * @param length of a list, about: for so much there is room at once
     * @param take   gets the lists of consecutive entries of other ranks, one
     *               after the other; called in the order of the entries
     */
    template <typename T, typename Append, typename Take>
    void
    fetch_lists(const Append     &append,
                const std::size_t length,
                const Take       &take) const
    {
      // A rank that needs entries of this one gets their lists in one message.
      std::map<unsigned int, std::vector<T>> sent;
      for (const auto &[rank, entries] : needed_elsewhere())
        {
          std::vector<T> &lists = sent[rank];
          lists.reserve(entries.size() * length);
          for (const unsigned int entry : entries)
            append(entry, lists);
        }
      for (const auto &[rank, lists] :
           send_records(sent, partitioner.get_mpi_communicator()))
        take(lists);
    }

  private:
    /** The numbers of own entries that others need, by their rank. */
    std::vector<std::pair<unsigned int, std::vector<unsigned int>>>
    needed_elsewhere() const
    {
      std::vector<std::pair<unsigned int, std::vector<unsigned int>>> result;
      // The partitioner has the entries that others need as ranges, one rank
      // after the other.
      auto range = partitioner.import_indices().begin();
      for (const auto &[rank, n] : partitioner.import_targets())
        {
          auto &entries =
            result.emplace_back(rank, std::vector<unsigned int>()).second;
          for (; entries.size() < n; ++range)
            for (unsigned int entry = range->first; entry < range->second;
                 ++entry)
              entries.push_back(entry);
        }
      return result;
    }

    /** No other exchange is under way at the same time. */
    static constexpr unsigned int channel = 0;

    Utilities::MPI::Partitioner partitioner;
    mutable std::vector<double> buffer; // of the messages
  };

  /** Those of all splines: component i of spline s has number s n + i. */
  IndexSet
  unknowns_of(const IndexSet &splines, const unsigned int n);

  /**
   * A sparse matrix of blocks of n × n entries, those of two splines with n
   * unknowns each. The unknowns of a spline follow each other, and a rank has
   * the rows of its own splines. Of a symmetric matrix each pair of own splines
   * is kept once, as the block from the diagonal on: a product takes as long as
   * the memory takes to deliver the entries (doc/performance.md, The linear
   * solver). Neighbours alone exchange messages.
   *
   * No library has such a matrix: PETSc's symmetric blocks are as fast on one
   * rank, but their preconditioners take more iterations on several;
   * deal.II's and Trilinos' matrices have no symmetric form.
   */
  class BlockMatrix
  {
  public:
    using Vector = LinearAlgebra::distributed::Vector<double>;

    /** Splines, by global numbers; in any order, and perhaps several times. */
    using Columns = std::vector<types::global_dof_index>;

    /**
     * Makes the pattern; all entries are zero. Collective.
     * @param own       splines of this rank, an interval; those of all ranks
     *        follow each other
     * @param columns   of each own row. The diagonal's need not be there. Of a
     *        symmetric matrix own columns before the diagonal are left out
     * @param n         unknowns of a spline, 1 to 3
     * @param symmetric whether the matrix is
     */
    void
    reinit(const IndexSet             &own,
           const std::vector<Columns> &columns,
           const unsigned int          n,
           const bool                  symmetric,
           const MPI_Comm              comm);

    unsigned int
    n_components() const
    {
      return n;
    }

    bool
    is_symmetric() const
    {
      return symmetric;
    }

    /** This rank's splines. */
    const IndexSet &
    own() const
    {
      return own_;
    }

    /** Splines of other ranks that own rows have columns of. */
    const IndexSet &
    others() const
    {
      return others_;
    }

    MPI_Comm
    communicator() const
    {
      return comm;
    }

    /** The column of a spline in own() or others(): own ones come first, each
     *  by ascending numbers. */
    int
    column_of(const types::global_dof_index spline) const
    {
      return own_.is_element(spline) ?
               own_.index_within_set(spline) :
               own_.n_elements() + others_.index_within_set(spline);
    }

    /** The spline of a column. */
    types::global_dof_index
    spline_of(const int column) const
    {
      const int n_own = own_.n_elements();
      return column < n_own ? own_.nth_index_in_set(column) :
                              others_.nth_index_in_set(column - n_own);
    }

    /** The columns of an own row, ascending. */
    ArrayView<const int>
    columns(const unsigned int row) const
    {
      return {columns_.data() + begins[row], begins[row + 1] - begins[row]};
    }

    /** How many of them are own ones. */
    unsigned int
    n_own_columns(const unsigned int row) const
    {
      return ends_of_own[row] - begins[row];
    }

    /** The blocks of an own row, in the order of the columns: entry (i, j) of
     *  the k-th one is number (k n + i) n + j. */
    double *
    blocks(const unsigned int row)
    {
      return values.data() + begins[row] * n * n;
    }

    const double *
    blocks(const unsigned int row) const
    {
      return values.data() + begins[row] * n * n;
    }

    /** Makes all entries zero. */
    void
    clear();

    /** y = K x. Neighbours have to do the same. */
    void
    vmult(Vector &y, const Vector &x) const;

    /** The diagonal, in the layout of @p like. */
    Vector
    diagonal(const Vector &like) const;

    /** Adds a multiple of @p values. */
    void
    add_to_diagonal(const double factor, const Vector &values);

    /** (K + Kᵀ)/2, for a pattern that is symmetric. Collective. */
    BlockMatrix
    symmetric_part() const;

    /** Blocks in a row of this rank, in the mean; both of a pair count. */
    double
    mean_blocks() const;

  private:
    /** Where the block of an own row and a column is among all blocks. */
    std::size_t
    find(const unsigned int row, const int column) const;

    template <int size>
    void
    multiply(double *y, const double *x) const;

    unsigned int n         = 1;
    bool         symmetric = true;
    MPI_Comm     comm      = MPI_COMM_NULL;
    IndexSet     own_, others_;

    // These go by row of blocks.
    std::vector<std::size_t> begins;
    std::vector<std::size_t> ends_of_own; // columns

    std::vector<int>    columns_; // of blocks
    std::vector<double> values;

    std::shared_ptr<const Halo> halo;      // on several ranks; of all copies
    mutable std::vector<double> by_column; // on several ranks: x
  };
} // namespace Morula

#endif
