// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_run_files_h
#define morula_simulation_run_files_h

#include <morula/output/condition.h>
#include <morula/output/directory.h>
#include <morula/output/lineage.h>
#include <morula/output/point_fields.h>
#include <morula/output/progress.h>
#include <morula/output/run_lock.h>
#include <morula/output/snapshot.h>
#include <morula/output/statistics.h>
#include <morula/output/timings.h>
#include <morula/scene/scene.h>

#include <deal.II/base/timer.h>

#include <optional>
#include <string>
#include <vector>

namespace Morula
{
  /**
   * The files of one run in its output directory: opens them, knows when which
   * is due, and numbers the series. Collective throughout.
   */
  template <int dim>
  class RunFiles
  {
  public:
    /**
     * Takes the directory for this run alone, and makes it ready: for a new
     * run, or to go on behind a snapshot.
     * @param clock runs since the program began with this run; kept as a
     *        reference
     * @throws InputError, or std::runtime_error with path and reason
     */
    RunFiles(const Scene                            &scene,
             const std::optional<SnapshotData<dim>> &resumed_from,
             const Timer                            &clock,
             const MPI_Comm                          comm);

    /** Appends to statistics.csv and lineage.csv, and shows the step. Completes
     *  @p row with the wall time. */
    void
    step(StatisticsRow &row, const std::vector<Birth<dim>> &births);

    /** Onto the terminal and into log.txt: something worth knowing. */
    void
    message(const std::string &text);

    /** Appends to condition.csv. The scene asks for it. */
    void
    condition(const unsigned int       step,
              const double             time,
              const ConditionEstimate &estimate);

    /** Whether cells and surface are to be written in any format. */
    bool
    writes_points() const;

    /** Whether something is due at @p time (day). The last state is always. */
    bool
    output_due(const double time, const bool last) const;
    /** The same for the snapshot. */
    bool
    snapshot_due(const double time, const bool last) const;

    /** Writes the next number of the series of cells and surface. */
    void
    write_points(const PointFields<dim> &cells,
                 const PointFields<dim> &surface,
                 const double            time);

    /** Completes @p data with the files' own counters and writes it. No section
     *  of @p timer may be open: this has its own. */
    void
    write_snapshot(SnapshotData<dim> data, TimerOutput &timer);

    /** Writes timings.csv anew. Collective. */
    void
    write_timings(const TimerOutput &timer);

    /** Into log.txt, where possible: what ends the run. Not collective. */
    void
    fail(const std::string &text) noexcept;

    /** The summary, on the terminal and in log.txt; the run is complete, and
     *  its directory free. Collective. */
    void
    finish(const std::string   &outcome,
           const StatisticsRow &row,
           const unsigned int   rejected_steps,
           const TimerOutput   &timer);

    /** Wall seconds since the start of the run, across resumes. */
    double
    wall_seconds() const;

  private:
    void
    tell_of_missing_states(); // of which Output/Formats was another
    bool
    continues_conditions(
      const std::optional<SnapshotData<dim>> &resumed_from) const;
    void
    open_conditions(const std::optional<SnapshotData<dim>> &resumed_from);

    ComingRun
    coming_run() const;

    std::string
    path(const std::string &file) const;

    bool
    has_format(const std::string &format) const;

    void
    write_series(const std::string      &stem,
                 const PointFields<dim> &fields,
                 const double            time);

    const Scene            scene;
    const MPI_Comm         comm;
    std::optional<RunLock> lock; // until the end
    const double           wall_seconds_before;
    const Timer           &clock;
    std::vector<double>    output_times;
    // Due at these multiples of their intervals.
    unsigned int                    next_output;
    unsigned int                    next_snapshot;
    SectionTimes                    sections_before;
    std::optional<Progress>         progress;
    std::optional<StatisticsFile>   statistics;
    std::optional<LineageFile<dim>> lineage;
    std::optional<ConditionFile>    conditions; // if the scene asks for it
  };
} // namespace Morula

#endif
