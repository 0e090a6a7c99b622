// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_points_file_rows_h
#define morula_seeding_points_file_rows_h

#include <deal.II/base/point.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** What is wrong with a line of a points file. */
  struct LineProblem
  {
    // below 2^63: Open MPI 4.1 takes the minimum of MPI_UNSIGNED_LONG as signed
    static constexpr std::uint64_t no_line =
      std::numeric_limits<std::int64_t>::max();

    /** Counted from 1; no_line if nothing is wrong. */
    std::uint64_t line = no_line;
    /** The arguments of InputError. */
    std::string value, allowed, remedy;
  };

  /** Rows that this rank has read from a points file. */
  template <int dim>
  struct PointsFileRows
  {
    /** µm */
    std::vector<Point<dim>> positions;
    /** µm^dim */
    std::vector<double> volumes;
    /** Empty if the file has no such columns. */
    std::vector<unsigned int> generations, phases, types;
    /** The lines on which the rows stand. */
    std::vector<std::uint64_t> lines;
    /** Number of lines read, including those without a row. */
    std::uint64_t n_lines = 0;
    /** The problem of the first bad line. */
    LineProblem problem;
  };

  /** Whether a line is blank or begins with #. Such lines are skipped. */
  bool
  is_blank_or_comment(const std::string &line);

  /**
   * The meaning of each column that the header line @p text names: 0, 1, 2 for
   * x, y, z, 3 for the volume, 4 for the generation, 5 for the phase, 6 for the
   * type. If the names are wrong, sets @p problem, except its line.
   */
  template <int dim>
  std::vector<unsigned int>
  read_columns(const std::string &text, LineProblem &problem);

  /**
   * Appends the row in the line @p text, whose number is rows.n_lines, or sets
   * rows.problem.
   * @param types names that the column of types may have, or their numbers from
   *        0 on
   */
  template <int dim>
  void
  read_row(const std::string               &text,
           const std::vector<unsigned int> &columns,
           const double                     default_volume,
           const std::vector<std::string>  &types,
           PointsFileRows<dim>             &rows);
} // namespace Morula

#endif
