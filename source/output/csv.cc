// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/output/csv.h>
#include <morula/output/table.h>

#include <algorithm>
#include <utility>

namespace Morula
{
  template <int dim>
  std::string
  csv_text(const std::vector<PointFields<dim>> &parts)
  {
    const auto        &names     = parts.front().names;
    const unsigned int n_columns = parts.front().n_csv_columns;
    std::vector<std::pair<types::particle_index, const double *>> rows;
    for (const PointFields<dim> &part : parts)
      for (std::size_t i = 0; i < part.size(); ++i)
        rows.emplace_back(part.ids[i], part.row(i));
    std::sort(rows.begin(), rows.end());
    std::string text;
    // A number has about a dozen characters; moving a longer and longer text
    // would take as long as making it.
    text.reserve(12 * n_columns * (1 + rows.size()));
    for (unsigned int i = 0; i < n_columns; ++i)
      text += (i > 0 ? "," : "") + names[i];
    text += '\n';
    for (const auto &[id, row] : rows)
      {
        for (unsigned int i = 0; i < n_columns; ++i)
          {
            if (i > 0)
              text += ',';
            append_number(text, row[i]);
          }
        text += '\n';
      }
    return text;
  }

  MORULA_INSTANTIATE(csv_text);
} // namespace Morula
