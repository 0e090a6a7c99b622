// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/input_error.h>
#include <morula/base/instantiate.h>
#include <morula/output/hdf5_file.h>
#include <morula/output/sealed_file.h>
#include <morula/output/snapshot.h>
#include <morula/output/snapshot_names.h>

#include <deal.II/base/mpi.h>

#include <stdexcept>
#include <utility>

// How a snapshot is read.

namespace Morula
{
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

    /** This rank's slice of the weights. */
    GridCellCounts
    read_weights(const Hdf5File &file, const MPI_Comm comm)
    {
      // Sizes are checked before memory is taken by them.
      const auto size = file.size(snapshot_weights_name);
      if (size.size() != 2 || size[1] != 2)
        throw std::runtime_error("the grid weights do not fit");
      const auto [begin, end] = slice(size[0], comm);
      const auto rows =
        file.rows<unsigned int>(snapshot_weights_name, begin, end);
      GridCellCounts weights;
      for (std::size_t i = 0; i < rows.size(); i += 2)
        weights.push_back({rows[i], rows[i + 1]});
      return weights;
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

    /** What the rows of points are, if the file says so. */
    std::string
    read_columns(const Hdf5File &file, const std::string &group)
    {
      for (const std::string &name : file.dataset_names(group))
        if (name == "columns")
          return file.text(group + "/columns");
      return "";
    }

    /** Refuses a file whose bytes are not those that were written: the HDF5
     *  library must not see it. */
    void
    check_seal(const std::string &path)
    {
      switch (examine_seal(path))
        {
          case SealState::missing:
            throw InputError("--resume",
                             path,
                             "a snapshot that can be read",
                             "There is none: start the run without --resume, "
                             "and with --replace if there are files of it.");
          case SealState::plain_hdf5:
            refuse_snapshot(path,
                            "a snapshot that begins with a digest (this is the "
                            "HDF5 file of another program, or of a Morula that "
                            "wrote none)");
          case SealState::foreign:
            refuse_snapshot(path,
                            "a snapshot of Morula (this file does not begin as "
                            "one)");
          case SealState::damaged:
            refuse_snapshot(path,
                            "an undamaged snapshot (this file's bytes are not "
                            "those that Morula wrote: their digest differs)");
          case SealState::whole:
            return;
        }
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
      data.cell_columns     = read_columns(file, "cells");
      data.boundary_columns = read_columns(file, "boundary points");
      data.grid_weights     = read_weights(file, comm);
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
