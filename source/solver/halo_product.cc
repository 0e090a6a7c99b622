// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/solver/halo_product.h>

#include <deal.II/base/exceptions.h>
#include <deal.II/base/mpi.h>

#include <algorithm>

namespace Morula
{
  using namespace dealii;

  /**
   * Products with the rows of a matrix that a rank owns, by the blocks of the
   * splines' unknowns. Of a symmetric matrix it reads each pair of blocks once:
   * a product takes as long as the memory takes to deliver the entries, and
   * these take a third of the matrix's own bytes, where columns are numbered
   * entry by entry (doc/performance.md, The linear solver). Epetra's block
   * matrices have pointers for each block and no symmetric form.
   */
  class BlockRows
  {
  public:
    virtual ~BlockRows() = default;

    /** Takes over the entries of a matrix with the pattern of the first. */
    virtual void
    read(const Epetra_CrsMatrix &K) = 0;

    /** y = K x.
     *  @param y by own rows
     *  @param x by columns: the own ones, then those of other ranks by
     *           ascending numbers */
    virtual void
    vmult(double *y, const double *x) const = 0;
  };


  namespace
  {
    /** A view of a row. */
    struct RowView
    {
      // The view is into Epetra's arrays, nothing is copied.
      int     length;
      double *entries;
      int    *columns;

      RowView(const Epetra_CrsMatrix &K, const int row)
      {
        const int error = K.ExtractMyRowView(row, length, entries, columns);
        AssertThrow(error == 0, ExcInternalError());
      }
    };

    template <int n>
    class RowsOfBlocks : public BlockRows
    {
    public:
      RowsOfBlocks(const Epetra_CrsMatrix &K,
                   const std::vector<int> &order,
                   const bool              symmetric)
        : symmetric(symmetric)
        , n_rows(K.NumMyRows() / n)
        , order(order)
        , begins(1, 0)
      {
        AssertThrow(K.NumMyRows() + int(order.size()) == K.NumMyCols(),
                    ExcInternalError());
        numbers.reserve(K.NumMyNonzeros() / (n * n * (symmetric ? 2 : 1)) +
                        n_rows);
        for (int k = 0; k < n_rows; ++k)
          append(RowView(K, n * k), k);
        blocks.resize(numbers.size());
        read(K);
      }

      void
      read(const Epetra_CrsMatrix &K) override
      {
        // Own columns of a row stand in ascending order, so their entries
        // follow each other, block by block. Those of other ranks need their
        // place in the row of blocks, for which of_others is a table. It is
        // written anew for each row and only read where the row has a block.
        std::vector<std::size_t> of_others((order.size() + n - 1) / n);
        for (int k = 0; k < n_rows; ++k)
          {
            for (std::size_t b = ends_of_own[k]; b < begins[k + 1]; ++b)
              of_others[numbers[b] - n_rows] = b;
            for (int i = 0; i < n; ++i)
              {
                const RowView row(K, n * k + i);
                int           e = first_of(row, k);
                for (std::size_t b = begins[k]; b < ends_of_own[k]; ++b)
                  for (int j = 0; j < n; ++j)
                    blocks[b].row[i][j] = row.entries[e++];
                for (; e < row.length; ++e)
                  {
                    const int column = place(row.columns[e]);
                    blocks[of_others[column / n - n_rows]].row[i][column % n] =
                      row.entries[e];
                  }
              }
          }
      }

      void
      vmult(double *y, const double *x) const override
      {
        // Each block above the diagonal is read once, and used for its row and,
        // transposed, for its column: the product is bound by memory. Blocks
        // with columns of other ranks are used once, since those ranks have
        // their transposes in rows of their own.
        std::fill_n(y, n * n_rows, 0.);
        for (int k = 0; k < n_rows; ++k)
          {
            double x_of_row[n], sums[n] = {}; // in registers
            std::copy_n(x + n * k, n, x_of_row);
            std::size_t b = begins[k];
            if (symmetric)
              {
                blocks[b++].add(x_of_row, sums); // on the diagonal
                for (; b < ends_of_own[k]; ++b)
                  {
                    blocks[b].add(x + n * numbers[b], sums);
                    blocks[b].add_transpose(x_of_row, y + n * numbers[b]);
                  }
              }
            for (; b < begins[k + 1]; ++b)
              blocks[b].add(x + n * numbers[b], sums);
            for (int i = 0; i < n; ++i)
              y[n * k + i] += sums[i];
          }
      }

    private:
      struct Block
      {
        double row[n][n];

        /** y += B x */
        void
        add(const double *x, double *y) const
        {
          for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j)
              y[i] += row[i][j] * x[j];
        }

        /** y += Bᵀ x */
        void
        add_transpose(const double *x, double *y) const
        {
          for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j)
              y[j] += row[i][j] * x[i];
        }
      };

      /** The place of K's column @p k in x. */
      int
      place(const int k) const
      {
        // Columns of this rank come first, numbered as its rows. Those of other
        // ranks stand in Epetra's order, and are given places by ascending
        // number.
        return k < n * n_rows ? k : n * n_rows + order[k - n * n_rows];
      }

      /** Where the entries begin that the row of blocks @p k is read from. */
      int
      first_of(const RowView &row, const int k) const
      {
        // A symmetric matrix is read from the diagonal's block on; own columns
        // are sorted.
        if (!symmetric)
          return 0;
        const int *const columns = row.columns;
        return std::lower_bound(columns, columns + row.length, n * k) - columns;
      }

      /** Appends the blocks of a row. */
      void
      append(const RowView &row, const int k)
      {
        // A spline's unknowns are whole blocks, so the first unknown of each
        // stands for the block.
        for (int e = first_of(row, k); e < row.length; ++e)
          if (place(row.columns[e]) % n == 0)
            numbers.push_back(place(row.columns[e]) / n);
        std::sort(numbers.begin() + begins[k], numbers.end());
        // Own columns come before others' in x; the product treats them
        // differently.
        ends_of_own.push_back(
          std::lower_bound(numbers.begin() + begins[k], numbers.end(), n_rows) -
          numbers.begin());
        begins.push_back(numbers.size());
      }

      const bool       symmetric;
      const int        n_rows; // of blocks
      std::vector<int> order;

      // These two go by row of blocks.
      std::vector<std::size_t> begins;
      std::vector<std::size_t> ends_of_own; // columns

      std::vector<int>   numbers; // of block columns, ascending in a row
      std::vector<Block> blocks;
    };


    /**
     * @param K Each row has its diagonal. The unknowns of a spline follow each
     *        other, and its blocks are whole
     * @param order of other ranks' columns: the place of each among them by
     *        ascending numbers; Epetra's own order tears splines apart
     * @param n_components unknowns of a spline, 1 to 3
     * @param symmetric    whether K is
     */
    std::unique_ptr<BlockRows>
    make_block_rows(const Epetra_CrsMatrix &K,
                    const std::vector<int> &order,
                    const unsigned int      n_components,
                    const bool              symmetric)
    {
      // The number of components is a template parameter, so that the loops
      // over a block are unrolled.
      switch (n_components)
        {
          case 2:
            return std::make_unique<RowsOfBlocks<2>>(K, order, symmetric);
          case 3:
            return std::make_unique<RowsOfBlocks<3>>(K, order, symmetric);
          default:
            AssertThrow(n_components == 1, ExcNotImplemented());
            return std::make_unique<RowsOfBlocks<1>>(K, order, symmetric);
        }
    }
  } // namespace


  HaloProduct::HaloProduct(const Matrix      &K,
                           const unsigned int n_components,
                           const bool         symmetric)
    : K(K)
    , columns(K.trilinos_matrix().ColMap())
    , n_own(K.locally_owned_range_indices().n_elements())
  {
    // The columns of other ranks stand in Epetra's order behind the own ones.
    // An IndexSet has them in ascending order, as the halo brings them; `order`
    // translates.
    const IndexSet own = K.locally_owned_range_indices();
    IndexSet       others(own.size());
    for (int k = n_own; k < columns.NumMyElements(); ++k)
      others.add_index(columns.GID(k));
    others.compress();
    std::vector<int> order;
    for (int k = n_own; k < columns.NumMyElements(); ++k)
      order.push_back(others.index_within_set(columns.GID(k)));
    rows = make_block_rows(K.trilinos_matrix(), order, n_components, symmetric);

    const MPI_Comm comm = K.get_mpi_communicator();
    // On one rank x can be read where it stands, and nothing is exchanged.
    if (Utilities::MPI::n_mpi_processes(comm) == 1)
      return;
    halo.emplace(own, others, comm);
    by_column.resize(columns.NumMyElements());
  }

  HaloProduct::~HaloProduct() = default;

  bool
  HaloProduct::is_of(const Matrix &other) const
  {
    // A matrix at the same address may have got another pattern since. Its map
    // tells: it is shared with the matrix that it belongs to.
    return &other == &K &&
           columns.DataPtr() == other.trilinos_matrix().ColMap().DataPtr();
  }

  void
  HaloProduct::read()
  {
    rows->read(K.trilinos_matrix());
  }

  void
  HaloProduct::vmult(Vector &y, const Vector &x) const
  {
    const double *columns_of_x = x.begin();
    if (halo)
      {
        // The own entries are copied in front of those that come from
        // neighbours: BlockRows wants all of them in one array.
        std::copy_n(x.begin(), n_own, by_column.begin());
        halo->fetch(by_column.data(), by_column.data() + n_own);
        columns_of_x = by_column.data();
      }
    rows->vmult(y.trilinos_vector()[0], columns_of_x);
  }
} // namespace Morula
