// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_run_files_h
#define morula_simulation_run_files_h

#include <morula/output/directory.h>
#include <morula/output/output_file.h>
#include <morula/output/point_fields.h>
#include <morula/output/progress.h>
#include <morula/output/rows.h>
#include <morula/output/snapshot.h>
#include <morula/output/table.h>
#include <morula/scene/scene.h>

#include <deal.II/base/timer.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace Morula
{
  /** Multiples of an interval, at which something is due. */
  class Multiples
  {
  public:
    /** @param interval day; 0: never
     *  @param slack    for the rounding of times, day
     *  @param after    the first one is later, day */
    Multiples(const double interval, const double slack, const double after)
      : interval(interval)
      , slack(slack)
    {
      are_reached(after);
    }

    /** Whether @p time (day) has come to the next one; it is passed then. */
    bool
    are_reached(const double time)
    {
      if (interval <= 0. || time < next * interval - slack)
        return false;
      next =
        static_cast<unsigned int>(std::floor((time + slack) / interval)) + 1;
      return true;
    }

  private:
    double       interval, slack;
    unsigned int next = 0;
  };

  /**
   * The files of one run in its output directory. It opens them, knows when
   * each is due, and numbers the series. All members are collective unless they
   * say otherwise.
   */
  template <int dim>
  class RunFiles
  {
  public:
    /**
     * Locks the directory for this run and makes it ready, for a new run or for
     * one resumed from a snapshot.
     * @param clock runs since this program began the run; kept as a reference
     * @throws InputError, or std::runtime_error with path and reason
     */
    RunFiles(const TissueModel<dim>                 &model,
             const std::optional<SnapshotData<dim>> &resumed_from,
             const Timer                            &clock,
             const MPI_Comm                          comm);

    /** Appends to statistics.csv, lineage.csv and, where effects ask for it,
     *  events.csv, and shows the step. Writes the wall time into @p row.
     */
    void
    step(StatisticsRow                 &row,
         const std::vector<Birth<dim>> &births,
         const std::vector<CellEvent>  &events);

    /** Writes a message to the terminal and into log.txt. */
    void
    message(const std::string &text)
    {
      progress->message(text);
    }

    /** Appends rows to condition.csv, newton.csv or forces.csv. Only if the
     *  scene asks for the file. @param name without its ending */
    void
    append(const std::string &name, const std::string &rows)
    {
      tables.at(name).append(rows);
    }

    /** Whether forces.csv is due at @p time (day), as cells and surface are
     *  from the first step on. */
    bool
    forces_due(const double time, const bool last)
    {
      return last || forces.are_reached(time);
    }

    /** Whether the scene asks for cells and surface in any format. */
    bool
    writes_points() const
    {
      return has_format("vtu") || has_format("csv");
    }

    /** Whether output is due at @p time (day). Always true for the first state
     *  and the last one. */
    bool
    output_due(const double time, const bool last)
    {
      return last || output_times.empty() || outputs.are_reached(time);
    }
    /** Whether a snapshot is due, as output_due() or by the clock of rank 0. */
    bool
    snapshot_due(const double time, const bool last);

    /** Begins to write the next files of the series of cells and surface. They
     *  are complete after one of the next steps, before the next snapshot at
     * the latest; a step that finds that they cannot be written throws a
     *  std::runtime_error. */
    void
    write_points(PointFields<dim> cells,
                 PointFields<dim> surface,
                 const double     time);

    /** Adds the files' own counters to @p data and writes it. No section of
     *  @p timer may be open, since this function opens some. */
    void
    write_snapshot(SnapshotData<dim> data, TimerOutput &timer);

    /** Writes timings.csv anew. */
    void
    write_timings(const TimerOutput &timer)
    {
      Morula::write_timings(path("timings.csv"),
                            section_times(timer, sections_before),
                            wall_seconds(),
                            comm);
    }

    /** Writes the reason why the run ends into log.txt, where possible. Not
     *  collective. */
    void
    fail(const std::string &text) noexcept
    {
      progress->fail(text);
    }

    /** Writes the summary to the terminal and into log.txt, marks the run as
     *  finished, and unlocks its directory. */
    void
    finish(const std::string &outcome,
           StatisticsRow      row,
           const unsigned int rejected_steps);

    /** Wall seconds since the start of the run, over all resumptions. */
    double
    wall_seconds() const
    {
      return wall_seconds_before + clock.wall_time();
    }

  private:
    void
    continue_tables(const TissueModel<dim>  &model,
                    const SnapshotData<dim> &resumed_from);

    RunSetup
    setup() const
    {
      return {scene.file,
              scene.parameters(),
              {scene.tissue.surface_mesh, scene.tissue.points_file},
              scene.replace};
    }

    std::string
    path(const std::string &file) const
    {
      return scene.output_directory + "/" + file;
    }

    bool
    has_format(const std::string &format) const
    {
      return std::find(scene.output.formats->begin(),
                       scene.output.formats->end(),
                       format) != scene.output.formats->end();
    }

    /** Waits for the files of points, if there are any, and lists them. */
    void
    finish_points()
    {
      if (!points.pending())
        return;
      points.finish();
      list_points();
    }

    /** Lists the files of points for ParaView. */
    void
    list_points();

    const Scene                  scene;
    const MPI_Comm               comm;
    const bool                   records_events;
    const EventsContents         contents; // of events.csv
    std::optional<DirectoryLock> lock;     // until the end
    const double                 wall_seconds_before;
    const Timer                 &clock;
    std::vector<double>          output_times;
    Multiples outputs, snapshots, forces; // when they are due
    // On this program's clock, s: when the last snapshot was done, and how long
    // it took.
    double                  last_snapshot    = 0.;
    double                  snapshot_seconds = 0.;
    SectionTimes            sections_before;
    std::optional<Progress> progress;
    // The tables that the scene has, by their names without ending.
    std::map<std::string, AppendedCsv> tables;
    BackgroundFiles                    points; // cells and surface
  };
} // namespace Morula

#endif
