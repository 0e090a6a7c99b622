// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/csv_rows.h>
#include <morula/output/events.h>
#include <morula/output/gather.h>

#include <algorithm>
#include <utility>

namespace Morula
{
  std::vector<std::string>
  event_columns()
  {
    return {"time", "id", "event", "from", "to"};
  }

  std::string
  event_rows(const std::vector<TypeChange>  &changes,
             const std::vector<std::string> &type_names,
             const MPI_Comm                  comm)
  {
    std::vector<TypeChange> all;
    for (const auto &part : gather_to_root(changes, comm))
      all.insert(all.end(), part.begin(), part.end());
    // Several changes of a cell stay in their order: each ends where the next
    // begins.
    std::stable_sort(all.begin(),
                     all.end(),
                     [](const TypeChange &a, const TypeChange &b) {
                       return std::make_pair(a.time, a.id) <
                              std::make_pair(b.time, b.id);
                     });
    std::string text;
    for (const TypeChange &change : all)
      {
        append_number(text, change.time);
        text += ',' + std::to_string(change.id) + ",transition," +
                type_names[change.from] + ',' + type_names[change.to] + '\n';
      }
    return text;
  }
} // namespace Morula
