// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_table_h
#define morula_output_table_h

#include <morula/output/gather.h>

#include <mpi.h>

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <type_traits>
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

  /** A value as it stands in a table. */
  struct TableValue
  {
    template <typename Number,
              typename = std::enable_if_t<std::is_arithmetic_v<Number>>>
    TableValue(const Number number)
    {
      append_number(text, number);
    }

    TableValue(std::string text)
      : text(std::move(text))
    {}

    std::string text;
  };

  /** A row of a table: names and values of its columns, in their order. Any row
   *  also makes the header, so the two cannot differ. */
  class TableRow
  {
  public:
    TableRow(std::initializer_list<std::pair<std::string_view, TableValue>> row)
    {
      for (const auto &[name, value] : row)
        add(name, value);
    }

    void
    add(const std::string_view name, const TableValue &value)
    {
      const char *const comma = names.empty() ? "" : ",";
      names.append(comma).append(name);
      values.append(comma).append(value.text);
    }

    /** The names separated by commas, with the newline. */
    std::string
    header() const
    {
      return names + '\n';
    }

    /** The values separated by commas, with the newline. */
    std::string
    text() const
    {
      return values + '\n';
    }

  private:
    std::string names, values;
  };

  /**
   * All ranks' rows of a table in the order of their keys, on rank 0; elsewhere
   * nothing. Rows of equal keys are of one rank, and stay in their order.
   * Collective.
   * @tparam Key trivially copyable, with operator<
   */
  template <typename Key>
  std::string
  rows_in_order(std::vector<Key>             keys,
                const std::vector<TableRow> &rows,
                const MPI_Comm               comm)
  {
    // Rows travel as one text. Their lengths cut it into rows again.
    std::string              text;
    std::vector<std::size_t> lengths;
    for (const TableRow &row : rows)
      {
        text += row.text();
        lengths.push_back(row.text().size());
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
