// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/instantiate.h>
#include <morula/output/hdf5_file.h>
#include <morula/output/output_file.h>
#include <morula/output/sealed_file.h>
#include <morula/output/snapshot.h>

#include <boost/serialization/map.hpp>
#include <boost/serialization/vector.hpp>

#include <cmath>
#include <cstdio>

namespace Morula
{
  namespace
  {
    /** An id as it stands in a snapshot: HDF5 has names for the types of C, not
     *  for those of fixed width. */
    using SnapshotId =
      std::conditional_t<sizeof(dealii::types::particle_index) ==
                           sizeof(unsigned int),
                         unsigned int,
                         unsigned long long>;

    /** Names of an attribute and of a table. */
    constexpr const char *snapshot_format_name  = "Morula snapshot format";
    constexpr const char *snapshot_weights_name = "grid weights";

    template <int dim>
    void
    write_points(Hdf5File             &file,
                 const std::string    &group,
                 const PointList<dim> &points,
                 const std::string    &columns,
                 const MPI_Comm        comm)
    {
      // Ranks without points may not know how long the rows are, but all ranks
      // must give the same size.
      // Each rank writes its own points, behind those of lower ranks. So the
      // order in the file is that of the ranks, and a run on another number of
      // ranks reads slices of its own.
      const unsigned int n_numbers =
        Utilities::MPI::max(points.n_numbers, comm);

      const std::vector<SnapshotId> ids(points.ids.begin(), points.ids.end());
      std::vector<double>           coordinates;
      coordinates.reserve(dim * points.size());
      for (const Point<dim> &position : points.positions)
        for (unsigned int d = 0; d < dim; ++d)
          coordinates.push_back(position[d]);

      file.group(group);
      file.rows(group + "/ids", ids.data(), ids.size(), 1);
      file.rows(group + "/positions", coordinates.data(), ids.size(), dim);
      file.rows(group + "/properties",
                points.numbers.data(),
                ids.size(),
                n_numbers);
      file.text(group + "/columns", columns);
    }

    /**
     * Rank 0's data without the points. HDF5 demands that all ranks write the
     * same attributes; wall times, for one, are not.
     */
    template <int dim>
    SnapshotData<dim>
    shared_parts_of_root(const SnapshotData<dim> &data, const MPI_Comm comm)
    {
      // What HDF5 calls attributes is written by all ranks together and must
      // agree. So all of it comes from rank 0; the points are not part of it.
      SnapshotData<dim> shared;
      shared.program_version =
        Utilities::MPI::broadcast(comm, data.program_version);
      shared.parameters = Utilities::MPI::broadcast(comm, data.parameters);
      shared.time       = Utilities::MPI::broadcast(comm, data.time);
      shared.numbers    = Utilities::MPI::broadcast(comm, data.numbers);
      shared.tables     = Utilities::MPI::broadcast(comm, data.tables);
      shared.integer_tables =
        Utilities::MPI::broadcast(comm, data.integer_tables);
      shared.cell_columns = Utilities::MPI::broadcast(comm, data.cell_columns);
      shared.boundary_columns =
        Utilities::MPI::broadcast(comm, data.boundary_columns);
      return shared;
    }

    /** Upper bound of what the file takes, bytes. */
    template <int dim>
    std::size_t
    size_in_file(const SnapshotData<dim> &data,
                 const SnapshotData<dim> &shared,
                 const MPI_Comm           comm)
    {
      // A generous bound of what HDF5 needs besides the values for a data set
      // or an attribute.
      constexpr std::size_t n_bytes_an_object = 2048;
      std::size_t           n_objects         = 32 + shared.numbers.size();
      std::size_t           n_values          = 0;
      for (const auto &table : shared.tables)
        n_values += table.second.size();
      for (const auto &table : shared.integer_tables)
        n_values += table.second.size();
      n_objects += shared.tables.size() + shared.integer_tables.size();

      std::size_t n_point_values = 0;
      for (const auto *points : {&data.cells, &data.boundary_points})
        n_point_values += points->size() * (1 + dim) + points->numbers.size();
      n_point_values += data.grid_weights.size(); // of half a double twice
      return (n_values + Utilities::MPI::sum(n_point_values, comm)) *
               sizeof(double) +
             shared.parameters.size() + shared.cell_columns.size() +
             shared.boundary_columns.size() + n_objects * n_bytes_an_object;
    }

    /** Refuses rows of other columns. @param what the points are */
    template <int dim>
    void
    check_rows(const std::string    &path,
               const std::string    &what,
               const PointList<dim> &points,
               const std::string    &layout,
               const Columns        &columns)
    {
      if (const std::string text = columns.differences(layout); !text.empty())
        refuse_snapshot(path,
                        "a snapshot whose " + what +
                          " have the columns that the scene's effects declare "
                          "(this one " +
                          text + ")");
      // A rank without points may not know how long the rows are.
      if (points.size() > 0 && points.n_numbers != columns.n_numbers())
        refuse_snapshot(path,
                        "a snapshot whose " + what + " have " +
                          std::to_string(columns.n_numbers()) +
                          " numbers each (they have " +
                          std::to_string(points.n_numbers) + ")");
    }
  } // namespace

  void
  refuse_snapshot(const std::string &path, const std::string &allowed)
  {
    throw InputError("--resume",
                     path,
                     allowed,
                     "Resume with the program and the scene that wrote the "
                     "snapshot, or start the run anew.");
  }

  template <int dim>
  double
  SnapshotData<dim>::number(const std::string &name) const
  {
    const auto found = numbers.find(name);
    if (found == numbers.end() || !std::isfinite(found->second))
      refuse_snapshot(file,
                      "a snapshot with the number '" + name +
                        "' (this one lacks it)");
    return found->second;
  }

  template <int dim>
  const std::vector<double> &
  SnapshotData<dim>::table(const std::string &name) const
  {
    const auto found = tables.find(name);
    if (found == tables.end())
      refuse_snapshot(file,
                      "a snapshot with the table '" + name +
                        "' (this one lacks it)");
    return found->second;
  }

  template <int dim>
  const std::vector<int> &
  SnapshotData<dim>::integer_table(const std::string &name,
                                   const std::size_t  size) const
  {
    const auto found = integer_tables.find(name);
    if (found == integer_tables.end() || found->second.size() != size)
      refuse_snapshot(file,
                      "a snapshot with the table '" + name + "' of " +
                        std::to_string(size) +
                        " integers (this one lacks it, or has another size)");
    return found->second;
  }

  template <int dim>
  void
  check_columns(const SnapshotData<dim> &data,
                const Columns           &cell_columns,
                const Columns           &boundary_columns,
                const MPI_Comm           comm)
  {
    everywhere(comm, [&]() {
      check_rows(
        data.file, "cells", data.cells, data.cell_columns, cell_columns);
      check_rows(data.file,
                 "boundary points",
                 data.boundary_points,
                 data.boundary_columns,
                 boundary_columns);
    });
  }

  template <int dim>
  void
  write_snapshot(const std::string       &path,
                 const SnapshotData<dim> &data,
                 const MPI_Comm           comm)
  {
    // The common parts come from rank 0, everything else from all ranks. The
    // file is written under another name and takes the place of the last
    // snapshot only at the end, when its digest stands in front of it: a run
    // that is killed in between leaves the last good one. All calls are
    // collective.
    const SnapshotData<dim> shared = shared_parts_of_root(data, comm);

    // When the disk is full MPI I/O fails on some ranks only and the others
    // wait for ever, and HDF5 crashes at the end of the program. So it does not
    // begin without the room for it. The reservation ends with the temporary
    // object.
    const std::size_t size = size_in_file(data, shared, comm);
    on_root(comm, [&]() {
      OutputFile(path, OutputFile::Mode::replace).reserve(size);
    });

    Hdf5File file(temporary_path(path), comm);
    file.attribute("/", snapshot_format_name, snapshot_format);
    file.attribute("/", "dimension", dim);
    file.attribute("/", "time", shared.time);
    file.text("program version", shared.program_version);
    file.text("parameters", shared.parameters);
    file.group("numbers");
    for (const auto &number : shared.numbers)
      file.attribute("numbers", number.first, number.second);
    file.group("tables");
    for (const auto &table : shared.tables)
      file.table("tables/" + table.first, table.second);
    file.group("integer tables");
    for (const auto &table : shared.integer_tables)
      file.table("integer tables/" + table.first, table.second);
    write_points(file, "cells", data.cells, shared.cell_columns, comm);
    write_points(file,
                 "boundary points",
                 data.boundary_points,
                 shared.boundary_columns,
                 comm);
    // One row for each grid cell: its number and its weight.
    std::vector<unsigned int> weights;
    for (const GridCellCount &weight : data.grid_weights)
      weights.insert(weights.end(), {weight.number, weight.n});
    file.rows(snapshot_weights_name,
              weights.data(),
              data.grid_weights.size(),
              2);
    // All ranks know whether any has failed.
    if (!file.close())
      {
        const std::string reason = file.reason();
        on_root(comm, [&]() {
          std::remove(temporary_path(path).c_str());
          throw std::runtime_error("cannot write the snapshot '" + path +
                                   "': " + reason +
                                   ". The last good snapshot, if there is "
                                   "one, stays");
        });
      }
    on_root(comm, [&]() { seal(path); });
  }

  void
  try_snapshot(const std::string &path, const MPI_Comm comm)
  {
    // Another name than that of a snapshot which is being written.
    const std::string trial = temporary_path(path + ".trial");
    Hdf5File          file(trial, comm);
    file.attribute("/", snapshot_format_name, snapshot_format);
    file.text("parameters", "");
    const bool        works  = file.close();
    const std::string reason = works ? "" : file.reason();
    on_root(comm, [&]() {
      std::remove(trial.c_str());
      if (!works)
        throw InputError("Output directory",
                         path,
                         "a directory in which snapshots can be written",
                         "The HDF5 library says: " + reason +
                           ". Choose another directory.");
    });
  }

  template struct SnapshotData<2>;
  template struct SnapshotData<3>;
  MORULA_INSTANTIATE(check_columns);
  MORULA_INSTANTIATE(write_snapshot);


  namespace
  {
    /** Rows [n r / size, n (r + 1) / size) of n, for rank r. */
    std::pair<hsize_t, hsize_t>
    slice(const hsize_t n, const MPI_Comm comm)
    {
      // The file's rows belong to nobody: each rank reads an equal share of
      // them, and the tissue sends the points where they belong.
      const hsize_t rank    = Utilities::MPI::this_mpi_process(comm);
      const hsize_t n_ranks = Utilities::MPI::n_mpi_processes(comm);
      return {n * rank / n_ranks, n * (rank + 1) / n_ranks};
    }

    /** This rank's slice of the points. */
    template <int dim>
    PointList<dim>
    read_points(const Hdf5File    &file,
                const std::string &group,
                const MPI_Comm     comm)
    {
      // The three tables of a group must have the same number of rows. A file
      // from elsewhere, or one that is damaged, may not.
      const auto ids        = file.size(group + "/ids");
      const auto positions  = file.size(group + "/positions");
      const auto properties = file.size(group + "/properties");
      if (ids.size() != 2 || positions.size() != 2 || properties.size() != 2 ||
          ids[1] != 1 || positions[0] != ids[0] || properties[0] != ids[0] ||
          positions[1] != dim)
        throw std::runtime_error("the points '" + group + "' do not fit");

      const auto [begin, end] = slice(ids[0], comm);

      PointList<dim> points(properties[1]);
      const auto local_ids = file.rows<SnapshotId>(group + "/ids", begin, end);
      points.ids.assign(local_ids.begin(), local_ids.end());
      const auto coordinates =
        file.rows<double>(group + "/positions", begin, end);
      points.positions.resize(points.ids.size());
      for (std::size_t i = 0; i < coordinates.size(); ++i)
        points.positions[i / dim][i % dim] = coordinates[i];
      points.numbers = file.rows<double>(group + "/properties", begin, end);
      return points;
    }

    /** Checks format, and lets @p read read the file. */
    template <typename Read>
    void
    read_checked(const std::string &path, const Read &read)
    {
      try
        {
          // Whatever the HDF5 library complains of becomes a refusal of the
          // snapshot. An InputError says more already, and passes.
          const Hdf5File file(path);
          const int format = file.attribute<int>("/", snapshot_format_name);
          if (format != snapshot_format)
            refuse_snapshot(path,
                            "a snapshot of format " +
                              std::to_string(snapshot_format) +
                              " (this is of format " + std::to_string(format) +
                              ")");
          read(file);
        }
      catch (const InputError &)
        {
          throw;
        }
      catch (const std::exception &error)
        {
          refuse_snapshot(path,
                          std::string("an undamaged snapshot (") +
                            error.what() + ")");
        }
    }
  } // namespace


  template <int dim>
  SnapshotData<dim>
  read_snapshot(const std::string &path, const MPI_Comm comm)
  {
    // The seal is examined first: a damaged file must not reach the HDF5
    // library. Each rank then opens the file by itself, reads all common parts,
    // and its own share of the points. What one rank cannot read ends the run
    // on all of them.
    SnapshotData<dim> data;
    data.file       = path;
    const auto read = [&](const Hdf5File &file) {
      const int dimension = file.attribute<int>("/", "dimension");
      if (dimension != dim)
        refuse_snapshot(path,
                        "a snapshot in " + std::to_string(dim) +
                          " dimensions (this one has " +
                          std::to_string(dimension) + ")");
      data.time            = file.attribute<double>("/", "time");
      data.program_version = file.text("program version");
      data.parameters      = file.text("parameters");
      for (const std::string &name : file.attribute_names("numbers"))
        data.numbers[name] = file.attribute<double>("numbers", name);
      for (const std::string &name : file.dataset_names("tables"))
        data.tables[name] = file.table<double>("tables/" + name);
      for (const std::string &name : file.dataset_names("integer tables"))
        data.integer_tables[name] = file.table<int>("integer tables/" + name);
      data.cells            = read_points<dim>(file, "cells", comm);
      data.boundary_points  = read_points<dim>(file, "boundary points", comm);
      data.cell_columns     = file.text("cells/columns");
      data.boundary_columns = file.text("boundary points/columns");
      // Sizes are checked before memory is taken by them.
      const auto size = file.size(snapshot_weights_name);
      if (size.size() != 2 || size[1] != 2)
        throw std::runtime_error("the grid weights do not fit");
      const auto [begin, end] = slice(size[0], comm);
      const auto rows =
        file.rows<unsigned int>(snapshot_weights_name, begin, end);
      for (std::size_t i = 0; i < rows.size(); i += 2)
        data.grid_weights.push_back({rows[i], rows[i + 1]});
    };
    on_root(comm, [&]() { check_seal(path); });
    everywhere(comm, [&]() { read_checked(path, read); });
    return data;
  }

  std::string
  read_snapshot_parameters(const std::string &path, const MPI_Comm comm)
  {
    std::string parameters;
    on_root(comm, [&]() { check_seal(path); });
    everywhere(comm, [&]() {
      read_checked(path, [&](const Hdf5File &file) {
        parameters = file.text("parameters");
      });
    });
    return parameters;
  }

  MORULA_INSTANTIATE(read_snapshot);
} // namespace Morula
