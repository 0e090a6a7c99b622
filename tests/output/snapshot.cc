// ranks: 1 2 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/output/sealed_file.h>
#include <morula/output/snapshot.h>

#include <gtest/gtest.h>

#include <hdf5.h>

#include <cstdint>
#include <cstring>
#include <limits>

#include "output/scratch_directory.h"

using namespace Morula;

namespace
{
  std::uint64_t
  bits(const double value)
  {
    std::uint64_t b;
    std::memcpy(&b, &value, sizeof(b));
    return b;
  }

  double
  from_bits(const std::uint64_t b)
  {
    double value;
    std::memcpy(&value, &b, sizeof(b));
    return value;
  }

  constexpr unsigned int n_slots = 7;

  /** Property @p slot of point @p id: values whose bits are easily lost. */
  double
  property(const unsigned int id, const unsigned int slot)
  {
    switch (slot)
      {
        case 0:
          return 1. / (3. + id);
        case 1:
          return -0.;
        case 2:
          return std::numeric_limits<double>::denorm_min() * (1. + id);
        case 3:
          return std::numeric_limits<double>::infinity();
        case 4:
          return from_bits(0x7ff8dead00000000ull + id);
        case 5:
          return 4294967295.;
        default:
          return -1e300 / (1. + id);
      }
  }

  /** Points with ids first, first + 1, ... */
  template <int dim>
  PointList<dim>
  points(const unsigned int first, const unsigned int n)
  {
    PointList<dim> list;
    list.n_slots = n > 0 ? n_slots : 0;
    for (unsigned int id = first; id < first + n; ++id)
      {
        list.ids.push_back(id);
        Point<dim> position;
        for (unsigned int d = 0; d < dim; ++d)
          position[d] = std::sqrt(2. + id) * (d + 1);
        list.positions.push_back(position);
        for (unsigned int slot = 0; slot < n_slots; ++slot)
          list.properties.push_back(property(id, slot));
      }
    return list;
  }

  constexpr unsigned int n_points_a_rank = 11;

  /** Rank 1 has no cells, and only rank 0 has boundary points. */
  template <int dim>
  SnapshotData<dim>
  data_of(const MPI_Comm comm)
  {
    const unsigned int rank = Utilities::MPI::this_mpi_process(comm);
    SnapshotData<dim>  data;
    data.program_version         = "1.2";
    data.parameters              = "set Dimension = 3 # \xc2\xb5m\n";
    data.time                    = 0.1 + 0.2;
    data.numbers["next id"]      = 4294967296.;
    data.numbers["a/b"]          = from_bits(0x7ff8000000000123ull);
    data.tables["output times"]  = {0.25, 1. / 3.};
    data.tables["nothing"]       = {};
    data.integer_tables["boxes"] = {-1, 2147483647};
    data.cells                   = rank == 1 ?
                                     points<dim>(0, 0) :
                                     points<dim>(4000000000u + 100 * rank, n_points_a_rank);
    data.boundary_points         = points<dim>(7, rank == 0 ? 1 : 0);
    return data;
  }

  template <int dim>
  void
  expect_points(const PointList<dim>            &read,
                const std::vector<unsigned int> &ids)
  {
    // every rank holds the slice of the file that is its due
    const unsigned int rank = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
    const unsigned int n_ranks =
      Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
    const std::size_t begin = ids.size() * rank / n_ranks;
    const std::size_t end   = ids.size() * (rank + 1) / n_ranks;
    ASSERT_EQ(read.size(), end - begin);
    ASSERT_EQ(read.n_slots, n_slots);
    ASSERT_EQ(read.positions.size(), read.size());
    ASSERT_EQ(read.properties.size(), n_slots * read.size());
    for (std::size_t i = 0; i < read.size(); ++i)
      {
        EXPECT_EQ(read.ids[i], ids[begin + i]);
        for (unsigned int d = 0; d < dim; ++d)
          EXPECT_EQ(read.positions[i][d],
                    std::sqrt(2. + read.ids[i]) * (d + 1));
        for (unsigned int slot = 0; slot < n_slots; ++slot)
          EXPECT_EQ(bits(read.properties[i * n_slots + slot]),
                    bits(property(read.ids[i], slot)));
      }
  }

  /** Written by the first @p n_writers ranks, read by all. */
  template <int dim>
  void
  round_trip(const unsigned int n_writers)
  {
    const ScratchDirectory directory;
    const unsigned int rank = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
    MPI_Comm           writers;
    MPI_Comm_split(MPI_COMM_WORLD, rank < n_writers ? 0 : 1, rank, &writers);
    if (rank < n_writers)
      write_snapshot(directory / "snapshot.h5", data_of<dim>(writers), writers);
    MPI_Comm_free(&writers);
    MPI_Barrier(MPI_COMM_WORLD);

    const auto read =
      read_snapshot<dim>(directory / "snapshot.h5", MPI_COMM_WORLD);
    const auto written = data_of<dim>(MPI_COMM_SELF);
    EXPECT_EQ(read.program_version, written.program_version);
    EXPECT_EQ(read.parameters, written.parameters);
    EXPECT_EQ(bits(read.time), bits(written.time));
    EXPECT_EQ(read.numbers.size(), written.numbers.size());
    for (const auto &number : written.numbers)
      EXPECT_EQ(bits(read.numbers.at(number.first)), bits(number.second));
    EXPECT_EQ(read.tables, written.tables);
    EXPECT_EQ(read.integer_tables, written.integer_tables);

    std::vector<unsigned int> ids;
    for (unsigned int writer = 0; writer < n_writers; ++writer)
      for (unsigned int i = 0; i < (writer == 1 ? 0 : n_points_a_rank); ++i)
        ids.push_back(4000000000u + 100 * writer + i);
    expect_points(read.cells, ids);
    expect_points(read.boundary_points, {7});
    MPI_Barrier(MPI_COMM_WORLD); // before anyone looks for strangers
    EXPECT_EQ(directory.files(), std::vector<std::string>{"snapshot.h5"});
  }

  /** What the InputError says when the file is read. */
  template <int dim>
  std::string
  complaint(const std::string &path)
  {
    try
      {
        read_snapshot<dim>(path, MPI_COMM_WORLD);
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "";
  }
} // namespace

TEST(Snapshot, KeepsEveryBitForAnyNumberOfRanks)
{
  for (unsigned int n = 1; n <= Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
       ++n)
    {
      round_trip<3>(n);
      round_trip<2>(n);
    }
}

TEST(Snapshot, IsTheSameFileEveryTime)
{
  const ScratchDirectory directory;
  for (const char *name : {"a.h5", "b.h5"})
    write_snapshot(directory / name,
                   data_of<3>(MPI_COMM_WORLD),
                   MPI_COMM_WORLD);
  EXPECT_GT(content(directory / "a.h5").size(), 1000u);
  EXPECT_EQ(content(directory / "a.h5"), content(directory / "b.h5"));
}

TEST(Snapshot, TakesSharedDataFromTheFirstRank)
{
  const ScratchDirectory directory;
  const unsigned int rank = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  auto               data = data_of<3>(MPI_COMM_WORLD);
  data.numbers["seconds"] = 10. + rank;
  data.tables["times"].assign(1 + rank, rank);
  data.parameters += std::string(rank, ' ');
  write_snapshot(directory / "s.h5", data, MPI_COMM_WORLD);
  const auto read = read_snapshot<3>(directory / "s.h5", MPI_COMM_WORLD);
  EXPECT_EQ(read.numbers.at("seconds"), 10.);
  EXPECT_EQ(read.tables.at("times"), std::vector<double>{0.});
  EXPECT_EQ(read.parameters, data_of<3>(MPI_COMM_SELF).parameters);
}

TEST(Snapshot, GivesTheSceneAlone)
{
  const ScratchDirectory directory;
  auto                   data = data_of<3>(MPI_COMM_WORLD);
  write_snapshot(directory / "s.h5", data, MPI_COMM_WORLD);
  EXPECT_EQ(read_snapshot_parameters(directory / "s.h5", MPI_COMM_WORLD),
            data.parameters);
  data.parameters = "";
  write_snapshot(directory / "s.h5", data, MPI_COMM_WORLD);
  EXPECT_EQ(read_snapshot_parameters(directory / "s.h5", MPI_COMM_WORLD), "");
}

TEST(Snapshot, RefusesMissingAndForeignFiles)
{
  const ScratchDirectory directory;
  on_root(MPI_COMM_WORLD, [&]() {
    write(directory / "empty.h5", "");
    write(directory / "text.h5", "id,x,y,z\n");
    hid_t file =
      H5Fcreate((directory / "foreign.h5").c_str(), H5F_ACC_TRUNC, 0, 0);
    H5Fclose(file);
  });
  EXPECT_NE(complaint<3>(directory / "no.h5").find("without --resume"),
            std::string::npos);
  for (const char *name : {"empty.h5", "text.h5"})
    EXPECT_NE(complaint<3>(directory / name).find("does not begin as one"),
              std::string::npos);
  EXPECT_NE(complaint<3>(directory / "foreign.h5").find("another program"),
            std::string::npos);
  EXPECT_THROW(read_snapshot_parameters(directory / "no.h5", MPI_COMM_WORLD),
               InputError);
}

TEST(Snapshot, RefusesOtherDimensionsAndFormats)
{
  const ScratchDirectory directory;
  const std::string      path = directory / "s.h5";
  write_snapshot(path, data_of<2>(MPI_COMM_WORLD), MPI_COMM_WORLD);
  EXPECT_NE(complaint<3>(path).find("3 dimensions (this one has 2)"),
            std::string::npos);
  EXPECT_EQ(complaint<2>(path), "");

  on_root(MPI_COMM_WORLD, [&]() {
    const int   other = snapshot_format + 1;
    const hid_t file  = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    const hid_t attribute =
      H5Aopen(file, "Morula snapshot format", H5P_DEFAULT);
    H5Awrite(attribute, H5T_NATIVE_INT, &other);
    H5Aclose(attribute);
    H5Fclose(file);
  });
  EXPECT_NE(complaint<2>(path).find("their digest differs"), std::string::npos);
  MPI_Barrier(MPI_COMM_WORLD);
  on_root(MPI_COMM_WORLD, [&]() { seal(path); });
  EXPECT_NE(complaint<2>(path).find("this is of format"), std::string::npos);
}

TEST(Snapshot, RefusesTruncatedFiles)
{
  const ScratchDirectory directory;
  const std::string      path = directory / "s.h5";
  write_snapshot(path, data_of<3>(MPI_COMM_WORLD), MPI_COMM_WORLD);
  const std::string whole = content(path);
  for (const std::size_t size :
       {whole.size() - 1, whole.size() / 2, std::size_t(100), std::size_t(17)})
    {
      MPI_Barrier(MPI_COMM_WORLD);
      on_root(MPI_COMM_WORLD, [&]() { write(path, whole.substr(0, size)); });
      EXPECT_NE(complaint<3>(path).find("an undamaged snapshot"),
                std::string::npos)
        << size;
    }
}

TEST(Snapshot, LeavesTheOldFileWhenTheDiskIsFull)
{
  const ScratchDirectory directory;
  const std::string      path = directory / "s.h5";
  auto                   data = data_of<3>(MPI_COMM_WORLD);
  write_snapshot(path, data, MPI_COMM_WORLD);
  const std::string old = content(path);

  data.tables["large"].assign(100000, 1.);
  {
    const FullDisk full(50000);
    EXPECT_THROW(write_snapshot(path, data, MPI_COMM_WORLD),
                 std::runtime_error);
  }
  EXPECT_EQ(content(path), old);
  MPI_Barrier(MPI_COMM_WORLD);
  EXPECT_EQ(directory.files(), std::vector<std::string>{"s.h5"});
  EXPECT_THROW(write_snapshot(directory / "none/s.h5", data, MPI_COMM_WORLD),
               std::runtime_error);
}
