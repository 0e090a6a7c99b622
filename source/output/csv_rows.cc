// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/csv_rows.h>
#include <morula/output/gather.h>

#include <algorithm>
#include <charconv>

namespace Morula
{
  void
  append_number(std::string &text, const double value)
  {
    // %.10g needs at most sign, 10 digits, point and exponent; like %g but
    // several times faster and in every locale the same
    char       digits[32];
    const auto end = std::to_chars(digits,
                                   digits + sizeof(digits),
                                   value == 0. ? 0. : value,
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
  CsvRows::add(const types::particle_index id,
               const double               *values,
               const unsigned              n)
  {
    for (unsigned int i = 0; i < n; ++i)
      {
        if (i > 0)
          text += ',';
        append_number(text, values[i]);
      }
    text += '\n';
    ids.push_back(id);
    ends.push_back(text.size());
  }

  GatheredRows::GatheredRows(const CsvRows &local, const MPI_Comm comm)
    : texts(gather_to_root(local.text, comm))
  {
    const auto ids  = gather_to_root(local.ids, comm);
    const auto ends = gather_to_root(local.ends, comm);

    std::vector<std::pair<types::particle_index, std::string_view>> sorted;
    for (std::size_t rank = 0; rank < texts.size(); ++rank)
      {
        std::size_t begin = 0;
        for (std::size_t i = 0; i < ids[rank].size(); ++i)
          {
            const std::size_t end = ends[rank][i];
            sorted.emplace_back(
              ids[rank][i],
              std::string_view(texts[rank]).substr(begin, end - begin));
            begin = end;
          }
      }
    std::sort(sorted.begin(), sorted.end(), [](const auto &a, const auto &b) {
      return a.first < b.first;
    });

    rows.reserve(sorted.size());
    for (const auto &id_and_row : sorted)
      rows.push_back(id_and_row.second);
  }

  const std::vector<std::string_view> &
  GatheredRows::in_id_order() const
  {
    return rows;
  }
} // namespace Morula
