// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_csv_rows_h
#define morula_output_csv_rows_h

#include <morula/base/global_order.h>

#include <mpi.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /**
   * Appends @p value as printf's `%.10g` does in the C locale, in any locale; a
   * negative zero loses its sign.
   */
  void
  append_number(std::string &text, const double value);

  /** The names separated by commas, with the newline. */
  std::string
  csv_header(const std::vector<std::string> &names);

  /** Appends one row of @p n values, with the newline. */
  void
  append_row(std::string &text, const double *values, const unsigned int n);

  /** One row of @p n values, with the newline. */
  std::string
  csv_row(const double *values, const unsigned int n);

  /** Rows of a CSV file that this rank contributes, already as text. */
  class CsvRows
  {
  public:
    /** Adds a row, with its newline. */
    void
    add(const std::string_view row);

    /** Bytes of all rows. */
    std::size_t
    n_bytes() const
    {
      return text.size();
    }

    /**
     * Puts all ranks' rows in order and returns those that this rank is to
     * write: each rank has about as many as the others, rank 0 the first ones.
     * Collective.
     * @param order of the rows, over all ranks. Rows of equal places are of one
     *   rank, and stay in their order.
     */
    std::string
    share_in_order(const GlobalOrder &order, const MPI_Comm comm) const;

  private:
    std::string_view
    row(const std::size_t i) const;

    std::string text;
    /** The position in the text behind its newline, for each row. */
    std::vector<std::size_t> ends;
  };
} // namespace Morula

#endif
