// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/csv_rows.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace Morula
{
  void
  append_number(std::string &text, const double value)
  {
    // %.10g needs at most sign, 10 digits, point and exponent. to_chars() gives
    // the same several times faster, in every locale. Whole numbers of up to 10
    // digits are printed as such, which is faster again; -0 becomes 0.
    char       digits[32];
    const auto whole =
      std::abs(value) < 1e10 ? static_cast<std::int64_t>(value) : 0;
    const auto end =
      static_cast<double>(whole) == value ?
        std::to_chars(digits, digits + sizeof(digits), whole).ptr :
        std::to_chars(digits,
                      digits + sizeof(digits),
                      value,
                      std::chars_format::general,
                      10)
          .ptr;
    text.append(digits, end);
  }

  std::string
  csv_header(const std::vector<std::string> &names)
  {
    std::string line;
    for (const std::string &name : names)
      line += (line.empty() ? "" : ",") + name;
    return line + '\n';
  }

  void
  append_row(std::string &text, const double *values, const unsigned int n)
  {
    for (unsigned int i = 0; i < n; ++i)
      {
        if (i > 0)
          text += ',';
        append_number(text, values[i]);
      }
    text += '\n';
  }

  std::string
  csv_row(const double *values, const unsigned int n)
  {
    std::string row;
    append_row(row, values, n);
    return row;
  }

  void
  CsvRows::add(const std::string_view row)
  {
    text += row;
    ends.push_back(text.size());
  }

  std::string_view
  CsvRows::row(const std::size_t i) const
  {
    const std::size_t begin = i == 0 ? 0 : ends[i - 1];
    return std::string_view(text).substr(begin, ends[i] - begin);
  }

  std::string
  CsvRows::share_in_order(const GlobalOrder &order, const MPI_Comm comm) const
  {
    // Each row's place among all ranks' rows is known, so it is also known
    // which rank writes it: each gets an equal number. Rows travel as one text
    // to each rank, with a list of places and lengths beside. What a rank has
    // received is then put in order by place.
    std::vector<std::pair<std::uint64_t, std::string_view>> rows;
    const std::uint64_t n_ranks = Utilities::MPI::n_mpi_processes(comm);
    // Place and length of each row, and the rows' text, by the rank that gets
    // them.
    std::map<unsigned int, std::vector<std::uint64_t>> heads;
    std::map<unsigned int, std::vector<char>>          texts;
    for (std::size_t i = 0; i < ends.size(); ++i)
      // On one rank nothing has to travel.
      if (const std::uint64_t place = order.places[i]; n_ranks == 1)
        rows.emplace_back(place, row(i));
      else
        {
          const unsigned int rank = place * n_ranks / order.n_keys;
          heads[rank].push_back(place);
          heads[rank].push_back(row(i).size());
          texts[rank].insert(texts[rank].end(), row(i).begin(), row(i).end());
        }
    if (n_ranks > 1)
      {
        heads = Utilities::MPI::some_to_some(comm, heads);
        texts = Utilities::MPI::some_to_some(comm, texts);
        for (const auto &[rank, head] : heads)
          {
            // The lengths cut the text into its rows again.
            const char *row = texts.at(rank).data();
            for (std::size_t k = 0; k < head.size(); row += head[k + 1], k += 2)
              rows.emplace_back(head[k], std::string_view(row, head[k + 1]));
          }
      }
    std::stable_sort(rows.begin(),
                     rows.end(),
                     [](const auto &a, const auto &b) {
                       return a.first < b.first;
                     });
    std::string share;
    for (const auto &row : rows)
      share += row.second;
    return share;
  }
} // namespace Morula
