// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/output/csv.h>
#include <morula/output/csv_rows.h>

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
    std::string text = csv_header({names.begin(), names.begin() + n_columns});
    // A number has about a dozen characters; moving a longer and longer text
    // would take as long as making it.
    text.reserve(text.size() + 12 * n_columns * rows.size());
    for (const auto &[id, row] : rows)
      append_row(text, row, n_columns);
    return text;
  }

  MORULA_INSTANTIATE(csv_text);
} // namespace Morula
