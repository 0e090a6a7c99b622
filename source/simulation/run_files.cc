// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/available_memory.h>
#include <morula/base/parameter_keys.h>
#include <morula/base/version.h>
#include <morula/scene/seeded_tissue.h>
#include <morula/simulation/run_files.h>

#include <ctime>
#include <fstream>
#include <iterator>

namespace Morula
{
  namespace
  {
    /** A snapshot calls the number of a table's rows by the table's name and
     * this suffix. */
    const std::string rows_suffix = "_rows";

    /** Prefixes of a section's numbers in a snapshot. */
    const std::string section_prefix = "seconds in ";
    const std::string calls_prefix   = "calls of ";

    /** A table that grows by rows as the run goes on. */
    struct Table
    {
      std::string name; // of the file, without ending
      std::string header;
      // A resumed run may have the table although the run began without it.
      bool may_begin_later = false;
    };

    /** The tables of a run. */
    template <int dim>
    std::vector<Table>
    tables_of(const TissueModel<dim> &model)
    {
      // The first tables follow from what acts in the scene, which a resumed
      // run cannot change. The others follow from keys that it may change, or
      // came with a later version: they may begin later. The values of the rows
      // do not matter here.
      const Scene       &scene      = model.scene;
      const Tables<dim> &of_effects = model.tables;
      const CellEvent    event{0., 0, CellEvent::death, 0, 0};
      Birth<dim>         birth{};
      StatisticsRow      row; // a column exists where it has a value for it
      for (const auto &column : of_effects.columns())
        row.of_effects.emplace_back(column.name, 0.);
      if (has_surface(model))
        row.surface.emplace();
      if (model.development.states_error())
        row.step_error = 0.;
      birth.numbers             = model.development.state().named_numbers();
      std::vector<Table> tables = {
        {"statistics", statistics_row(row).header()},
        {"lineage", lineage_row(birth, !scene.type_names().empty()).header()}};
      if (of_effects.records_events())
        tables.push_back(
          {"events", event_row(event, {{}, of_effects.has_causes()}).header()});
      if (Scene::has_any(scene.catalogue.boundary_conditions) ||
          Scene::has_any(scene.catalogue.interactions))
        tables.push_back({"forces", force_row({}, {}).header(), true});
      if (scene.output.condition_estimate)
        tables.push_back(
          {"condition", condition_row({}, {}, {}).header(), true});
      if (scene.output.newton_trace)
        tables.push_back({"newton", newton_row({}, {}).header(), true});
      return tables;
    }

    /** Adds to provenance.json which program begins or resumes the run, when,
     *  where, and by which command. Collective.
     *  @return the same, a line each */
    std::string
    note_provenance(const std::string &path,
                    const std::string &command,
                    const bool         resume,
                    const MPI_Comm     comm)
    {
      // The file is a list, of which a resumed run keeps what is there. Its
      // last line is the bracket that closes it.
      const std::time_t now = std::time(nullptr);
      char              date[32];
      std::strftime(date, sizeof(date), "%FT%TZ", std::gmtime(&now));
      std::string                                      text;
      std::vector<std::pair<std::string, std::string>> members;
      for (const auto &[name, value] :
           std::vector<std::pair<std::string, std::string>>{
             {"version", version_in_words()},
             {"date", date},
             {"host", Utilities::System::get_hostname()},
             {"ranks", std::to_string(Utilities::MPI::n_mpi_processes(comm))},
             {"command", command}})
        {
          members.emplace_back(name, Json::text(value));
          text += (text.empty() ? "" : "\n") + name + ": " + value;
        }
      on_root(comm, [&]() {
        std::ifstream file(path);
        std::string   list(std::istreambuf_iterator<char>(file), {});
        const auto    end = list.rfind("\n]");
        list =
          resume && end != std::string::npos ? list.substr(0, end) + "," : "[";
        write_atomically(path, list + '\n' + Json::object(members) + "\n]\n");
      });
      return text;
    }
  } // namespace

  template <int dim>
  RunFiles<dim>::RunFiles(const TissueModel<dim>                 &model,
                          const std::optional<SnapshotData<dim>> &resumed_from,
                          const Timer                            &clock,
                          const MPI_Comm                          comm)
    : scene(model.scene)
    , comm(comm)
    , records_events(model.tables.records_events())
    , contents{scene.type_names(), model.tables.has_causes()}
    , wall_seconds_before(resumed_from ? resumed_from->number("wall_seconds") :
                                         0.)
    , clock(clock)
    , outputs(scene.output.interval,
              scene.time.slack(),
              resumed_from ? resumed_from->time : 0.)
    , snapshots(scene.output.snapshot_interval,
                scene.time.slack(),
                resumed_from ? resumed_from->time : 0.)
    , forces(outputs)
    , points(comm)
  {
    // The lock is taken first, so that a second run in this directory fails
    // before it touches anything. A snapshot that could not be written is found
    // out now and not after hours. A resumed run checks its tables before it
    // cuts any file; a new one removes the files of an earlier run. Tables that
    // the earlier part of the run did not have begin here. Messages come last,
    // as they need log.txt.
    lock.emplace(scene.output_directory, comm);
    try_snapshot(path("snapshot.h5"), comm);
    if (resumed_from)
      {
        output_times = resumed_from->table("output_times");
        for (const auto &[name, seconds] : resumed_from->numbers)
          if (name.rfind(section_prefix, 0) == 0)
            {
              const std::string section = name.substr(section_prefix.size());
              sections_before[section]  = {resumed_from->number(calls_prefix +
                                                               section),
                                           seconds};
            }
        continue_tables(model, *resumed_from);
        prepare_resume(scene.output_directory,
                       setup(),
                       output_times.size(),
                       comm);
      }
    else
      prepare_directory(scene.output_directory, setup(), comm);
    for (const Table &table : tables_of(model))
      if (tables.count(table.name) == 0)
        tables.try_emplace(table.name,
                           path(table.name + ".csv"),
                           table.header,
                           comm);
    progress.emplace(path("log.txt"),
                     resumed_from.has_value(),
                     resumed_from ? resumed_from->time : 0.,
                     scene.time.end_time,
                     comm);
    progress->message(note_provenance(path("provenance.json"),
                                      scene.command_line,
                                      resumed_from.has_value(),
                                      comm),
                      false);
    if (!lock->reason_without_lock().empty())
      message(lock->reason_without_lock());
  }

  template <int dim>
  void
  RunFiles<dim>::continue_tables(const TissueModel<dim>  &model,
                                 const SnapshotData<dim> &resumed_from)
  {
    // The first pass checks all tables, the second one cuts them to the rows
    // that the snapshot counts. So a table that does not fit leaves all others
    // whole.
    for (const bool check : {true, false})
      for (const Table &table : tables_of(model))
        {
          const std::string &name = table.name;
          const std::string  file = path(name + ".csv");
          if (table.may_begin_later &&
              resumed_from.numbers.count(name + rows_suffix) == 0)
            continue;
          const TableExtent kept{
            static_cast<std::uint64_t>(resumed_from.number(name + rows_suffix)),
            digest_of_integers(
              resumed_from.integer_table(name + "_digest", 2))};
          if (check)
            AppendedCsv::check(file, table.header, kept, comm);
          else
            tables.try_emplace(name, file, table.header, kept, comm);
        }
  }


  template <int dim>
  void
  RunFiles<dim>::step(StatisticsRow                 &row,
                      const std::vector<Birth<dim>> &births,
                      const std::vector<CellEvent>  &events)
  {
    // Files of points are written by threads meanwhile. They are listed for
    // ParaView as soon as all ranks have written theirs. Each rank has the
    // births and events of its own cells, which rank 0 gathers; the row of
    // statistics.csv is equal on all ranks.
    if (points.written())
      finish_points();
    row.wall_seconds = wall_seconds();
    tables.at("statistics").append(statistics_row(row).text());
    tables.at("lineage").append(
      lineage_rows(births, !contents.type_names.empty(), comm));
    if (records_events)
      tables.at("events").append(event_rows(events, contents, comm));
    progress->step(row, clock.wall_time());
  }

  template <int dim>
  bool
  RunFiles<dim>::snapshot_due(const double time, const bool last)
  {
    // The clock comes last: the conditions before it are equal on all ranks, so
    // that either all ranks go on to its collective call or none.
    if (last || snapshots.are_reached(time))
      return true;
    // Snapshots take this part of the run's time at most. So the time between
    // two of them is at least 19 times as long as the last one took.
    constexpr double largest_part = 0.05;
    const double     minutes      = scene.output.snapshot_minutes;
    if (minutes == 0.)
      return false;
    const bool due =
      clock.wall_time() - last_snapshot >=
      std::max(60. * minutes, (1. / largest_part - 1.) * snapshot_seconds);
    // The clocks of ranks differ; that of rank 0 decides.
    return Utilities::MPI::broadcast(comm, due, 0);
  }

  template <int dim>
  void
  RunFiles<dim>::write_points(PointFields<dim> cells,
                              PointFields<dim> surface,
                              const double     time)
  {
    // The files of the state before are finished first: there is one lot in the
    // background at a time. Then the state is entered into the series, and its
    // files are begun.
    finish_points();
    const unsigned int number = output_times.size();
    output_times.push_back(time);

    // Rank 0 gets the rows of all, and its thread writes them.
    std::vector<std::pair<std::string, std::vector<PointFields<dim>>>> series;
    series.emplace_back(path(numbered_file("cells", number, "")),
                        gather_to_root(std::move(cells), comm));
    series.emplace_back(path(numbered_file("surface", number, "")),
                        gather_to_root(std::move(surface), comm));
    // Tables that wait in memory must not be what is too much for the next
    // step. Where memory is short the files are finished at once.
    points.start(
      [series = std::move(series),
       time,
       number,
       csv = has_format("csv"),
       vtu = has_format("vtu")]() {
        for (const auto &[name, parts] : series)
          {
            if (csv)
              write_atomically(name + "csv", csv_text(parts));
            if (vtu)
              write_vtu(name + "vtu", parts, time, number);
          }
      },
      memory_is_short(comm));
    if (!points.pending())
      list_points();
  }

  template <int dim>
  void
  RunFiles<dim>::list_points()
  {
    if (has_format("vtu"))
      for (const std::string stem : {"cells", "surface"})
        {
          std::vector<std::pair<double, std::string>> names;
          for (unsigned int n = 0; n < output_times.size(); ++n)
            names.emplace_back(output_times[n], numbered_file(stem, n, "vtu"));
          write_pvd(path(stem + ".pvd"), names, comm);
        }
  }

  template <int dim>
  void
  RunFiles<dim>::write_snapshot(SnapshotData<dim> data, TimerOutput &timer)
  {
    // A snapshot claims the outputs before it, so their files are finished
    // first. Then the tables are brought to the disk, counted, and the snapshot
    // is written as the last one: whenever the machine fails, what the snapshot
    // counts is there.
    if (points.pending())
      {
        const TimerOutput::Scope section(timer, "output");
        finish_points();
      }
    // The times are summed up before the section begins, since deal.II cannot
    // do it while a section is open.
    const SectionTimes       sections = section_times(timer, sections_before);
    const TimerOutput::Scope section(timer, "snapshot");
    const double             begin = clock.wall_time();
    // A table that is behind its count could not be continued.
    for (auto &[name, table] : tables)
      {
        table.sync();
        const TableExtent extent              = table.extent();
        data.numbers[name + rows_suffix]      = extent.n_rows;
        data.integer_tables[name + "_digest"] = as_integers(extent.digest);
      }
    data.parameters              = scene.parameters();
    data.numbers["wall_seconds"] = wall_seconds();
    data.tables["output_times"]  = output_times;
    for (const auto &[name, times] : sections)
      {
        data.numbers[section_prefix + name] = times.wall_seconds;
        data.numbers[calls_prefix + name]   = times.calls;
      }
    Morula::write_snapshot(path("snapshot.h5"), data, comm);
    last_snapshot    = clock.wall_time();
    snapshot_seconds = last_snapshot - begin;
  }

  template <int dim>
  void
  RunFiles<dim>::finish(const std::string &outcome,
                        StatisticsRow      row,
                        const unsigned int rejected_steps)
  {
    // The lock goes last: until then no other run may touch the files.
    finish_points();
    row.wall_seconds = wall_seconds();
    message(
      summary_block(outcome, dim, row, rejected_steps, scene.output_directory));
    note_finished(scene.output_directory, setup(), wall_seconds(), comm);
    lock.reset();
  }

  template class RunFiles<2>;
  template class RunFiles<3>;
} // namespace Morula
