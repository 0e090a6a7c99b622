// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_rows_h
#define morula_output_rows_h

#include <morula/grid/particle_domain.h>
#include <morula/output/point_fields.h>
#include <morula/output/table.h>
#include <morula/particles/cell_event.h>
#include <morula/particles/detached_points.h>
#include <morula/solver/condition_estimate.h>
#include <morula/solver/newton.h>

#include <deal.II/base/array_view.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <mpi.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

// The rows of all tables that grow with the run.

namespace Morula
{
  using namespace dealii;

  /** Sums and extremes over all cells, for statistics.csv. */
  struct TissueTotals
  {
    double total_volume             = 0.; // Σ V⁰ det F, µm^dim
    double grown_volume             = 0.; // Σ V⁰ det F_g, µm^dim
    double mean_energy_density      = 0.; // weighted by V⁰, kPa
    double cell_mean_energy_density = 0.; // each cell counted once, kPa
    double max_energy_density       = 0.; // kPa
    double min_elastic_volume_ratio = 0.;
    double max_elastic_volume_ratio = 0.;
    /**
     * Smallest and largest coordinates of the boundary points, or of the cells
     * if there are no boundary points, µm. In 2-D z is 0.
     */
    std::array<double, 3> lower = {{0., 0., 0.}};
    std::array<double, 3> upper = {{0., 0., 0.}};
  };

  /** Collects TissueTotals point by point. */
  template <int dim>
  class TissueSums
  {
  public:
    /** Adds one of this rank's cells. */
    void
    add_cell(const CellScalars &q, const Point<dim> &position)
    {
      // Energies have the initial volume as their weight: doc/theory.md,
      // section 1.5.
      n_cells += 1.;
      initial_volume += q.initial_volume;
      total_volume += q.volume;
      grown_volume += q.initial_volume * q.growth_volume_ratio;
      energy += q.initial_volume * q.energy_density;
      energy_density_sum += q.energy_density;
      max_energy_density = std::max(max_energy_density, q.energy_density);
      min_volume_ratio   = std::min(min_volume_ratio, q.elastic_volume_ratio);
      max_volume_ratio   = std::max(max_volume_ratio, q.elastic_volume_ratio);
      include(position, cell_box);
    }

    /** Adds one of this rank's boundary points. */
    void
    add_boundary_point(const Point<dim> &position)
    {
      n_boundary_points += 1.;
      include(position, boundary_box);
    }

    /** The totals over all ranks' points. Collective. */
    TissueTotals
    totals(const MPI_Comm comm) const
    {
      // One reduction for all sums; extremes take their own. Without cells, as
      // at the end of a tissue that dies out, there is nothing to divide by.
      // The extent is that of the surface, or of the cells where a scene has no
      // boundary points.
      std::array<double, 7> sums = {{n_cells,
                                     initial_volume,
                                     total_volume,
                                     grown_volume,
                                     energy,
                                     energy_density_sum,
                                     n_boundary_points}};
      Utilities::MPI::sum(ArrayView<const double>(sums.data(), sums.size()),
                          comm,
                          ArrayView<double>(sums.data(), sums.size()));

      TissueTotals all;
      if (sums[0] == 0.)
        return all;
      all.total_volume             = sums[2];
      all.grown_volume             = sums[3];
      all.mean_energy_density      = sums[4] / sums[1];
      all.cell_mean_energy_density = sums[5] / sums[0];
      all.max_energy_density = Utilities::MPI::max(max_energy_density, comm);
      all.min_elastic_volume_ratio =
        Utilities::MPI::min(min_volume_ratio, comm);
      all.max_elastic_volume_ratio =
        Utilities::MPI::max(max_volume_ratio, comm);

      const Box &box = sums[6] > 0. ? boundary_box : cell_box;
      for (unsigned int d = 0; d < dim; ++d)
        {
          all.lower[d] = Utilities::MPI::min(box[0][d], comm);
          all.upper[d] = Utilities::MPI::max(box[1][d], comm);
        }
      return all;
    }

  private:
    /** Smallest and largest coordinates of points. Without points the first are
     *  above the second. */
    using Box = std::array<std::array<double, dim>, 2>;

    static Box
    empty_box()
    {
      Box box;
      box[0].fill(std::numeric_limits<double>::max());
      box[1].fill(std::numeric_limits<double>::lowest());
      return box;
    }

    /** Widens the box so that it holds @p x. */
    static void
    include(const Point<dim> &x, Box &box)
    {
      for (unsigned int d = 0; d < dim; ++d)
        {
          box[0][d] = std::min(box[0][d], x[d]);
          box[1][d] = std::max(box[1][d], x[d]);
        }
    }

    double n_cells            = 0.;
    double initial_volume     = 0.;
    double total_volume       = 0.;
    double grown_volume       = 0.;
    double energy             = 0.; // Σ V⁰ Ψ
    double energy_density_sum = 0.; // Σ Ψ
    double max_energy_density = std::numeric_limits<double>::lowest();
    double min_volume_ratio   = std::numeric_limits<double>::max();
    double max_volume_ratio   = std::numeric_limits<double>::lowest();
    double n_boundary_points  = 0.;
    Box    cell_box           = empty_box();
    Box    boundary_box       = empty_box();
  };


  /** How long the cells of the tissue are, compared with the grid spacing. */
  struct CellLengths
  {
    /** Grid spacing over the length of the longest cell. */
    double min_cells_per_spacing = 0.;
    /** Position of that cell, µm; in 2-D z = 0. */
    std::array<double, 3> place{};
    /** Number of cells of which fewer than `fewest` fill a grid spacing. */
    std::uint64_t n_too_long = 0;

    /** Fewest cells along a grid spacing. With fewer cells, the splines of a
     *  grid cell can deform in ways that one F per cell does not see:
     *  doc/theory.md, section 2.1. */
    static constexpr double fewest = 2.;
  };

  /** Finds the longest cell. */
  template <int dim>
  class LongestCell
  {
  public:
    /** @param h grid spacing, µm */
    explicit LongestCell(const double h)
      : h(h)
    {}

    /** Adds a cell of this rank. */
    void
    add(const ParticleDomain<dim> &cell)
    {
      const double length = cell.length();
      if (length > longest)
        {
          longest = length;
          place   = cell.position();
        }
      if (length > limit())
        ++n_too_long;
    }

    /** The same, of a cell at @p x, µm. Cheap, unless it may be the longest. */
    void
    add(const Point<dim> &x, const DeformedCube<dim> &cell)
    {
      // Most cells are shorter than the longest so far, which a bound shows
      // without eigenvalues.
      if (!cell.is_within_length(std::min(longest, limit())))
        add(cell.at(x));
    }

    /** The result over all ranks. Collective. */
    CellLengths
    over_all_ranks(const MPI_Comm comm) const
    {
      const auto  over_ranks = Utilities::MPI::min_max_avg(longest, comm);
      CellLengths all;
      if (over_ranks.max > 0.)
        all.min_cells_per_spacing = h / over_ranks.max;
      for (unsigned int d = 0; d < dim; ++d)
        all.place[d] = place[d];
      all.place =
        // The place is known on the rank with the longest cell.
        Utilities::MPI::broadcast(comm, all.place, over_ranks.max_index);
      all.n_too_long = Utilities::MPI::sum(n_too_long, comm);
      return all;
    }

  private:
    /** Longer than this is too long, µm. */
    double
    limit() const
    {
      // A cell at the limit, as in an even lattice, is not too long.
      constexpr double slack = 1e-9; // for rounding
      return h / (CellLengths::fewest - slack);
    }

    double        h;
    double        longest = 0.; // µm
    Point<dim>    place;
    std::uint64_t n_too_long = 0;
  };


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
    /** The error in time so far, E of doc/theory.md (5.10); only where growth
     *  or flow follows the state. */
    std::optional<double> step_error = {};

    /** Whether so many cells are too long that this changes the energy by more
     *  than a usual grid does, 3 %. */
    bool
    has_long_cells() const
    {
      return 20 * lengths.n_too_long >= cells && lengths.n_too_long > 0;
    }

    /** A column of the effects. @throws std::out_of_range */
    double &
    of_effect(const std::string &name)
    {
      for (auto &column : of_effects)
        if (column.first == name)
          return column.second;
      throw std::out_of_range("No effect has a column " + name + '.');
    }

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
