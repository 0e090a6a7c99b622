// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_rows_h
#define morula_output_rows_h

#include <morula/output/table.h>
#include <morula/output/tissue_sums.h>
#include <morula/particles/cell_event.h>
#include <morula/particles/detached_points.h>
#include <morula/solver/condition_estimate.h>
#include <morula/solver/newton.h>

#include <deal.II/base/tensor.h>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

// The rows of all tables that grow with the run.

namespace Morula
{
  /** One row of statistics.csv: the state after a step, and the step's cost. */
  struct StatisticsRow
  {
    unsigned int  step  = 0;
    double        time  = 0.; // day
    double        dt    = 0.; // day
    std::uint64_t cells = 0;
    TissueTotals  tissue;
    std::uint64_t dividing           = 0; // divisions in this step
    std::uint64_t held_at_checkpoint = 0;
    std::uint64_t active_grid_cells  = 0;
    std::uint64_t inner_splines      = 0;
    std::uint64_t outer_splines      = 0;
    std::uint64_t unknowns           = 0;
    unsigned int  newton_iterations  = 0; // including rejected attempts
    unsigned int  linear_iterations  = 0; // including rejected attempts
    unsigned int  rejected_steps     = 0;
    unsigned int  turns          = 0; // equilibria, including rejected attempts
    unsigned int  proximal_paths = 0; // likewise
    double        residual       = 0.; // relative to the step's first
    double        wall_seconds   = 0.; // since the start, across resumes
    CellLengths   lengths;
    /** Columns of the scene's effects, by name: Tables::columns(). */
    std::vector<std::pair<std::string, double>> of_effects = {};
    /** How the surface fits the cells; empty without boundary points. */
    std::optional<SurfaceFit> surface = {};
    /** What the step before missed of growth and flow, relative to the volume;
     *  only where they follow the state. */
    std::optional<double> step_error = {};

    /** A column of the effects. @throws std::out_of_range */
    double &
    of_effect(const std::string &name);
    double
    of_effect(const std::string &name) const
    {
      return const_cast<StatisticsRow *>(this)->of_effect(name);
    }
  };

  /** What acts on the tissue at one time, summed over its points and over all
   *  ranks. In 2-D forces are per µm of thickness. */
  struct ForceRow
  {
    /** "condition", "obstacle", "lumen", on cells "force", or the name of an
     *  interaction. */
    std::string kind;
    /** As in the scene. */
    std::string name;
    /** On which it acts: boundary points, cells of a force. */
    std::uint64_t points = 0;
    /** Of these boundary points, µm^(dim-1). */
    double area = 0.;
    /** On the tissue, kPa µm^(dim-1). */
    Tensor<1, 3> force;
    /** Of the force, about the origin, kPa µm^dim. */
    Tensor<1, 3> moment;
    /** Sum of the points' forces along their inward normals, kPa µm^(dim-1):
     *  it does not cancel where the tissue is pressed from both sides. */
    double inward = 0.;
    /** Whether it acts between bodies of the tissue. */
    bool is_internal = false;
  };

  /** What events.csv records. */
  struct EventsContents
  {
    /** The names of the types, by their numbers; empty: there are no types. */
    std::vector<std::string> type_names;
    /** Whether deaths have causes. */
    bool with_causes = false;
  };

  TableRow
  statistics_row(const StatisticsRow &row);

  /** Of lineage.csv. @param with_types whether cells have types */
  template <int dim>
  TableRow
  lineage_row(const Birth<dim> &birth, const bool with_types);

  /**
   * The next rows of lineage.csv, on rank 0. The table has one for each cell
   * that ever lived: all ranks' births since the last call, in id order. Their
   * ids follow those in the file. Collective.
   * @param births of this rank, in any order
   */
  template <int dim>
  std::string
  lineage_rows(const std::vector<Birth<dim>> &births,
               const bool                     with_types,
               const MPI_Comm                 comm);

  TableRow
  event_row(const CellEvent &event, const EventsContents &contents);

  /**
   * A step's rows of events.csv, on rank 0: one for each event of a cell on any
   * rank, ordered by time, then by the cell's id, then by kind. Collective.
   * @param events of this rank, in any order
   */
  std::string
  event_rows(const std::vector<CellEvent> &events,
             const EventsContents         &contents,
             const MPI_Comm                comm);

  /** Of forces.csv at @p time, day. */
  TableRow
  force_row(const double time, const ForceRow &row);

  /** Of newton.csv. @param state that Newton's method has accepted, with the
   *  extremes of all ranks */
  TableRow
  newton_row(const unsigned int step, const NewtonIteration &state);

  /** Of condition.csv, the condition of the tangent matrix. @param time (day)
   *  of the step's beginning, where the tangent is taken */
  TableRow
  condition_row(const unsigned int       step,
                const double             time,
                const ConditionEstimate &estimate);
} // namespace Morula

#endif
