// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_csv_rows_h
#define morula_output_csv_rows_h

#include <morula/output/gather.h>

#include <mpi.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
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

  /**
   * All ranks' rows of a table in the order of their keys, on rank 0; elsewhere
   * nothing. Rows of equal keys are of one rank, and stay in their order.
   * Collective.
   * @tparam Key trivially copyable, with operator<
   */
  template <typename Key>
  std::string
  rows_in_order(std::vector<Key>                keys,
                const std::vector<std::string> &rows,
                const MPI_Comm                  comm)
  {
    // Rows travel as one text. Their lengths cut it into rows again.
    std::string              text;
    std::vector<std::size_t> lengths;
    for (const std::string &row : rows)
      {
        text += row;
        lengths.push_back(row.size());
      }
    const auto all_keys    = gather_to_root(std::move(keys), comm);
    const auto all_lengths = gather_to_root(std::move(lengths), comm);
    const auto all_texts   = gather_to_root(std::move(text), comm);
    std::vector<std::pair<Key, std::string_view>> all;
    for (std::size_t rank = 0; rank < all_keys.size(); ++rank)
      {
        std::string_view rest = all_texts[rank];
        for (std::size_t i = 0; i < all_keys[rank].size(); ++i)
          {
            all.emplace_back(all_keys[rank][i],
                             rest.substr(0, all_lengths[rank][i]));
            rest.remove_prefix(all_lengths[rank][i]);
          }
      }
    std::stable_sort(all.begin(), all.end(), [](const auto &a, const auto &b) {
      return a.first < b.first;
    });
    std::string sorted;
    for (const auto &row : all)
      sorted += row.second;
    return sorted;
  }
} // namespace Morula

#endif
