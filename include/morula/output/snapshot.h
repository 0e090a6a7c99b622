// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_snapshot_h
#define morula_output_snapshot_h

#include <morula/grid/background_grid.h>
#include <morula/particles/columns.h>
#include <morula/particles/point_list.h>

#include <mpi.h>

#include <map>
#include <string>
#include <vector>

namespace Morula
{
  /** Raised whenever older programs could not read the file. */
  constexpr int snapshot_format = 3;

  /**
   * Everything that outlives a step. Points and weights are those of this rank;
   * all else is written by rank 0. Names of tables hold no '/'.
   */
  template <int dim>
  struct SnapshotData
  {
    /** The version of the program that wrote the file, for information. */
    std::string program_version;
    /** The scene, a .prm file with all keys. */
    std::string parameters;
    /** day */
    double                                     time = 0.;
    std::map<std::string, double>              numbers;
    std::map<std::string, std::vector<double>> tables;
    std::map<std::string, std::vector<int>>    integer_tables;
    PointList<dim>                             cells;
    PointList<dim>                             boundary_points;
    /** Weights of the last partition, see BackgroundGrid. */
    GridCellCounts grid_weights;
    /** The layout of the points' rows, see Columns::layout(). */
    std::string cell_columns, boundary_columns;
    /** The file that this was read from. */
    std::string file;

    /** @throws InputError if the file lacks it, or it is no finite number */
    double
    number(const std::string &name) const;

    /** @throws InputError if the file lacks it */
    const std::vector<double> &
    table(const std::string &name) const;

    /** @throws InputError if the file lacks it, or it has another size */
    const std::vector<int> &
    integer_table(const std::string &name, const std::size_t size) const;
  };

  /**
   * @param allowed what the file should be, a noun phrase
   * @throws InputError about a snapshot from which no run can go on
   */
  [[noreturn]] void
  refuse_snapshot(const std::string &path, const std::string &allowed);

  /**
   * Refuses a snapshot whose points have other columns than these: an effect
   * would read what another effect has written. Collective.
   * @throws InputError, on all ranks, which names the columns that differ
   */
  template <int dim>
  void
  check_columns(const SnapshotData<dim> &data,
                const Columns           &cell_columns,
                const Columns           &boundary_columns,
                const MPI_Comm           comm);

  /** Writes a file beside @p path as a snapshot is written, and removes it:
   * what can only be written at the end is tried at the start. Collective.
   *  @throws InputError with the library's reason */
  void
  try_snapshot(const std::string &path, const MPI_Comm comm);

  /**
   * Writes snapshot.h5, all ranks together. Doubles keep their bits. The file
   * begins with a digest of its bytes, and replaces an older one when it is
   * complete and on the disk. Collective.
   * @throws std::runtime_error, on all ranks; the older file stays
   */
  template <int dim>
  void
  write_snapshot(const std::string       &path,
                 const SnapshotData<dim> &data,
                 const MPI_Comm           comm);

  /**
   * Reads a snapshot that any number of ranks wrote; each rank gets a
   * contiguous part of the points, in the order of the file. A file whose bytes
   * do not match their digest is refused before HDF5 opens it. Collective.
   * @throws InputError, on all ranks, if the file is missing, damaged, of
   *   another program, format or dimension
   */
  template <int dim>
  SnapshotData<dim>
  read_snapshot(const std::string &path, const MPI_Comm comm);

  /**
   * Only the scene of a snapshot, to compare it before anything is built.
   * Errors as above, except that any dimension will do.
   */
  std::string
  read_snapshot_parameters(const std::string &path, const MPI_Comm comm);
} // namespace Morula

#endif
