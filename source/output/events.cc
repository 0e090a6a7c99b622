// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/csv_rows.h>
#include <morula/output/events.h>

#include <tuple>
#include <utility>

namespace Morula
{
  namespace
  {
    /** The rows are ordered by time, then by id, then by kind. */
    struct EventKey
    {
      double                time;
      types::particle_index id;
      unsigned int          kind;

      bool
      operator<(const EventKey &other) const
      {
        return std::tie(time, id, kind) <
               std::tie(other.time, other.id, other.kind);
      }
    };

    /** What has no type to go to leaves `to` empty, what has no cause leaves
     *  `cause` empty. */
    std::string
    event_row(const CellEvent &event, const EventsContents &contents)
    {
      const auto type = [&](const unsigned int number) {
        return contents.type_names.empty() ? "" : contents.type_names[number];
      };
      const bool  changes = event.kind == CellEvent::transition;
      std::string text;
      append_number(text, event.time);
      text += ',' + std::to_string(event.id) + ',' + event.kind.name + ',' +
              type(event.from) + ',' + (changes ? type(event.to) : "");
      if (contents.with_causes)
        text += std::string(",") + event.cause;
      return text + '\n';
    }
  } // namespace

  std::vector<std::string>
  event_columns(const EventsContents &contents)
  {
    std::vector<std::string> columns = {"time", "id", "event", "from", "to"};
    if (contents.with_causes)
      columns.push_back("cause");
    return columns;
  }

  std::string
  event_rows(const std::vector<CellEvent> &events,
             const EventsContents         &contents,
             const MPI_Comm                comm)
  {
    std::vector<std::string> rows;
    std::vector<EventKey>    keys;
    for (const CellEvent &event : events)
      {
        rows.push_back(event_row(event, contents));
        keys.push_back({event.time, event.id, event.kind.order});
      }
    // Several changes of a cell at one time stay in their order: each ends
    // where the next one begins.
    return rows_in_order(std::move(keys), rows, comm);
  }
} // namespace Morula
