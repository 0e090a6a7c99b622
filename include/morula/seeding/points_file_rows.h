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
    // This is below 2^63, as Open MPI 4.1 takes the minimum of
    // MPI_UNSIGNED_LONG as if they were signed.
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
    /** The first and last moment that a column "frame" or "t" names, in its
     *  own unit; first > last without such a column. */
    double first_time = std::numeric_limits<double>::infinity();
    double last_time  = -std::numeric_limits<double>::infinity();
    /** The lines on which the rows stand. */
    std::vector<std::uint64_t> lines;
    /** Number of lines read, including those without a row. */
    std::uint64_t n_lines = 0;
    /** The problem of the first bad line. */
    LineProblem problem;
  };

  /** How the rows of a points file are written, as its header line says. */
  struct PointsFormat
  {
    /** Old programs end lines with a carriage return alone. */
    char line_end = '\n';
    /** Between the entries of a row; a blank stands for any number of them. */
    char separator = ',';
    /** The meaning of each column: 0, 1, 2 are x, y, z, 3 the volume, 4 the
     *  generation, 5 the phase, 6 the type, 7 the moment; 8 is skipped. */
    std::vector<unsigned int> columns;
    /** Names of the columns whose entries are read, and are skipped. */
    std::vector<std::string> read, skipped;
  };

  /** Whether a line is blank, has separators only, or begins with #. Such
   *  lines are skipped. */
  bool
  is_blank_or_comment(const std::string &line);

  /**
   * What the header line @p text names, with the separator that makes most
   * sense of it. Names of trackers ("POSITION_X") and a unit after a name
   * ("x (um)") are understood. If the header is wrong, sets @p problem, except
   * its line.
   */
  template <int dim>
  PointsFormat
  read_columns(const std::string &text, LineProblem &problem);

  /**
   * Whether the line @p text, below the header line, is a further one, of
   * words: tables of trackers have such lines with long names and units. Sets
   * @p problem if a coordinate is in another unit than µm.
   */
  bool
  is_further_header(const std::string  &text,
                    const PointsFormat &format,
                    LineProblem        &problem);

  /**
   * Appends the row in the line @p text, whose number is rows.n_lines, or sets
   * rows.problem.
   * @param types names that the column of types may have, or their numbers from
   *        0 on
   */
  template <int dim>
  void
  read_row(const std::string              &text,
           const PointsFormat             &format,
           const double                    default_volume,
           const std::vector<std::string> &types,
           PointsFileRows<dim>            &rows);
} // namespace Morula

#endif
