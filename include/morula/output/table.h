// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_table_h
#define morula_output_table_h

#include <morula/base/send_records.h>
#include <morula/output/output_file.h>
#include <morula/output/sealed_file.h>

#include <mpi.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** The lists of all ranks, by rank, on rank 0; elsewhere nothing.
   *  Collective. */
  template <typename T>
  std::vector<std::vector<T>>
  gather_to_root(std::vector<T> local, const MPI_Comm comm)
  {
    // Rank 0's own list stays where it is.
    const bool is_root = Utilities::MPI::this_mpi_process(comm) == 0;
    std::map<unsigned int, std::vector<T>> sent;
    if (!is_root)
      sent[0] = std::move(local);
    std::map<unsigned int, std::vector<T>> lists = send_records(sent, comm);
    std::vector<std::vector<T>>            all;
    if (!is_root)
      return all;
    lists[0] = std::move(local);
    for (auto &[rank, list] : lists)
      all.push_back(std::move(list));
    return all;
  }


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
      : number(number)
    {}

    TableValue(std::string text)
      : text(std::move(text))
    {}

    std::optional<double> number;
    std::string           text; // of what is no number
  };

  /** A row of a table: names and values of its columns, in their order. Any row
   *  also makes the header, so the two cannot differ. */
  class TableRow
  {
  public:
    TableRow(std::initializer_list<std::pair<std::string_view, TableValue>> row)
    {
      // A row of ten numbers asks the heap once for each text: there may be a
      // million rows.
      names.reserve(128);
      values.reserve(128);
      for (const auto &[name, value] : row)
        add(name, value);
    }

    void
    add(const std::string_view name, const TableValue &value)
    {
      if (!names.empty())
        {
          names += ',';
          values += ',';
        }
      names += name;
      values += value.text;
      if (value.number)
        append_number(values, *value.number);
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
  rows_in_order(std::vector<Key>                keys,
                const std::vector<std::string> &rows,
                const MPI_Comm                  comm)
  {
    // Rows travel as one text. Their lengths cut it into rows again.
    std::vector<char>        text;
    std::vector<std::size_t> lengths;
    for (const std::string &row : rows)
      {
        text.insert(text.end(), row.begin(), row.end());
        lengths.push_back(row.size());
      }
    const auto all_keys    = gather_to_root(std::move(keys), comm);
    const auto all_lengths = gather_to_root(std::move(lengths), comm);
    const auto all_texts   = gather_to_root(std::move(text), comm);
    std::vector<std::pair<Key, std::string_view>> all;
    for (std::size_t rank = 0; rank < all_keys.size(); ++rank)
      {
        std::string_view rest(all_texts[rank].data(), all_texts[rank].size());
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


  /** How much of a table stays when a run is resumed from a snapshot. */
  struct TableExtent
  {
    std::uint64_t n_rows = 0; // below the header
    std::uint64_t digest = 0; // of header and rows; only on rank 0
  };

  /**
   * A CSV file to which rows are appended during a run. All members are
   * collective and throw on all ranks alike. A crash may leave incomplete rows
   * at the end; they are never read, since a resumed run cuts the file behind
   * the rows that the snapshot knows of.
   */
  class AppendedCsv
  {
  public:
    /**
     * Starts a new file with its header, a complete line.
     * @throws std::runtime_error with path and reason
     */
    AppendedCsv(const std::string &path,
                const std::string &header,
                const MPI_Comm     comm);

    /**
     * Continues a file: keeps the rows that @p kept names, and cuts what
     * follows.
     * @throws InputError if the file is missing, or has another header, fewer
     * rows, or rows with another digest
     */
    AppendedCsv(const std::string &path,
                const std::string &header,
                const TableExtent &kept,
                const MPI_Comm     comm);

    /**
     * Throws what the second constructor would throw, and changes nothing.
     * @throws InputError
     */
    static void
    check(const std::string &path,
          const std::string &header,
          const TableExtent &kept,
          const MPI_Comm     comm);

    /**
     * Appends rank 0's @p rows, which are complete lines. On return the system
     * has them.
     * @throws std::runtime_error with path and reason, e.g. if somebody has
     *   deleted the file
     */
    void
    append(const std::string &rows);

    /** Forces the rows to the disk. Needed before a snapshot counts them. */
    void
    sync()
    {
      on_root(comm, [&]() {
        file->check_in_place();
        file->sync();
      });
    }

    /** What a snapshot stores. */
    TableExtent
    extent() const
    {
      return {n_rows, digest.checksum()};
    }

  private:
    MPI_Comm                    comm;
    std::uint64_t               n_rows = 0;
    Digest                      digest; // of the file so far, on rank 0
    std::unique_ptr<OutputFile> file;   // on rank 0
  };
} // namespace Morula

#endif
