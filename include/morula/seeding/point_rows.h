// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_point_rows_h
#define morula_seeding_point_rows_h

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

    /** Counted from 1; no_line: nothing is wrong. */
    std::uint64_t line = no_line;
    /** As in InputError. */
    std::string value, allowed, remedy;
  };

  /** Rows of a points file. */
  template <int dim>
  struct PointRows
  {
    /** µm */
    std::vector<Point<dim>> positions;
    /** µm^dim */
    std::vector<double> volumes;
    /** The lines on which the rows stand. */
    std::vector<std::uint64_t> lines;
    /** Lines read, with those that hold no row. */
    std::uint64_t n_lines = 0;
    /** Of the first bad line. */
    LineProblem problem;
  };

  /** Whether a line holds neither names nor numbers: blank, or # first. */
  bool
  is_remark(const std::string &line);

  /**
   * What the columns mean, by the header line @p text: 0, 1, 2 for x, y, z, and
   * 3 for the volume. Sets @p problem, except its line, if the names are wrong.
   */
  template <int dim>
  std::vector<unsigned int>
  read_columns(const std::string &text, LineProblem &problem);

  /**
   * Appends the row that the line @p text holds, the one numbered
   * rows.n_lines, or sets rows.problem.
   */
  template <int dim>
  void
  read_row(const std::string               &text,
           const std::vector<unsigned int> &columns,
           const double                     default_volume,
           PointRows<dim>                  &rows);
} // namespace Morula

#endif
