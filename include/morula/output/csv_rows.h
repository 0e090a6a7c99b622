// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_csv_rows_h
#define morula_output_csv_rows_h

#include <deal.II/particles/property_pool.h>

#include <mpi.h>

#include <string>
#include <string_view>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /**
   * Appends @p value as printf's `%.10g` does in the C locale, whatever the
   * locale is; a negative zero loses its sign.
   */
  void
  append_number(std::string &text, const double value);

  /** The names separated by commas, with the newline. */
  std::string
  csv_header(const std::vector<std::string> &names);

  /** Rows of a CSV file that this rank contributes, already as text. */
  class CsvRows
  {
  public:
    /** One row of @p n values; @p id says where it belongs. */
    void
    add(const types::particle_index id, const double *values, const unsigned n);

    std::vector<types::particle_index> ids;
    /** For each row the position in the text behind its newline. */
    std::vector<std::size_t> ends;
    std::string              text;
  };

  /** All ranks' rows, on rank 0. */
  class GatheredRows
  {
  public:
    /** Collective. */
    GatheredRows(const CsvRows &local, const MPI_Comm comm);

    /**
     * The rows with their newlines, sorted by id; views on the texts of this
     * object. Empty on other ranks than 0.
     */
    const std::vector<std::string_view> &
    in_id_order() const;

  private:
    std::vector<std::string>      texts;
    std::vector<std::string_view> rows;
  };
} // namespace Morula

#endif
