// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "output/room.h"

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

constexpr unsigned int n_numbers = 7;

/** Property @p column of point @p id: values whose bits are easily lost. */
double
property(const unsigned int id, const unsigned int column)
{
  switch (column)
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
  list.n_numbers = n > 0 ? n_numbers : 0;
  for (unsigned int id = first; id < first + n; ++id)
    {
      list.ids.push_back(id);
      Point<dim> position;
      for (unsigned int d = 0; d < dim; ++d)
        position[d] = std::sqrt(2. + id) * (d + 1);
      list.positions.push_back(position);
      for (unsigned int column = 0; column < n_numbers; ++column)
        list.numbers.push_back(property(id, column));
    }
  return list;
}

constexpr unsigned int n_points_a_rank = 11;

/** Rank 1 has no weights. */
GridCellCounts
weights_of(const unsigned int rank)
{
  if (rank == 1)
    return {};
  return {{7 * rank, 1}, {7 * rank + 3, 4294967295u}, {7 * rank + 4, rank}};
}

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
  data.cell_columns            = "bits 4\nothers 3\n";
  data.boundary_columns        = "all 7\n";
  data.numbers["next id"]      = 4294967296.;
  data.numbers["a/b"]          = from_bits(0x7ff8000000000123ull);
  data.tables["output times"]  = {0.25, 1. / 3.};
  data.tables["nothing"]       = {};
  data.integer_tables["boxes"] = {-1, 2147483647};
  data.cells                   = rank == 1 ?
                                   points<dim>(0, 0) :
                                   points<dim>(4000000000u + 100 * rank, n_points_a_rank);
  data.boundary_points         = points<dim>(7, rank == 0 ? 1 : 0);
  data.grid_weights            = weights_of(rank);
  return data;
}

template <int dim>
void
expect_points(const PointList<dim> &read, const std::vector<unsigned int> &ids)
{
  // every rank holds the slice of the file that is its due
  const unsigned int rank    = this_rank();
  const unsigned int n_ranks = number_of_ranks();
  const std::size_t  begin   = ids.size() * rank / n_ranks;
  const std::size_t  end     = ids.size() * (rank + 1) / n_ranks;
  ASSERT_EQ(read.size(), end - begin);
  ASSERT_EQ(read.n_numbers, n_numbers);
  ASSERT_EQ(read.positions.size(), read.size());
  ASSERT_EQ(read.numbers.size(), n_numbers * read.size());
  for (std::size_t i = 0; i < read.size(); ++i)
    {
      EXPECT_EQ(read.ids[i], ids[begin + i]);
      for (unsigned int d = 0; d < dim; ++d)
        EXPECT_EQ(read.positions[i][d], std::sqrt(2. + read.ids[i]) * (d + 1));
      for (unsigned int column = 0; column < n_numbers; ++column)
        EXPECT_EQ(bits(read.numbers[i * n_numbers + column]),
                  bits(property(read.ids[i], column)));
    }
}

/** Numbers and counts in turn. */
std::vector<unsigned int>
flat(const GridCellCounts &counts)
{
  std::vector<unsigned int> list;
  for (const GridCellCount &count : counts)
    {
      list.push_back(count.number);
      list.push_back(count.n);
    }
  return list;
}

/** Written by the first @p n_writers ranks, read by all. */
template <int dim>
void
round_trip(const unsigned int n_writers)
{
  const ScratchDirectory directory;
  const unsigned int     rank = this_rank();
  MPI_Comm               writers;
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
  EXPECT_EQ(read.cell_columns, written.cell_columns);
  EXPECT_EQ(read.boundary_columns, written.boundary_columns);
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
  GridCellCounts weights, all_weights;
  for (unsigned int writer = 0; writer < n_writers; ++writer)
    for (const GridCellCount &weight : weights_of(writer))
      weights.push_back(weight);
  for (const auto &of_rank :
       Utilities::MPI::all_gather(MPI_COMM_WORLD, flat(read.grid_weights)))
    for (std::size_t i = 0; i < of_rank.size(); i += 2)
      all_weights.push_back({of_rank[i], of_rank[i + 1]});
  EXPECT_EQ(all_weights, weights);
  EXPECT_EQ(directory.files(), std::vector<std::string>{"snapshot.h5"});
}

/** What the InputError says when the file is read. */
template <int dim>
std::string
complaint(const std::string &path)
{
  return complaint_of([&] { read_snapshot<dim>(path, MPI_COMM_WORLD); });
}

TEST(Snapshot, KeepsEveryBitForAnyNumberOfRanks)
{
  for (unsigned int n = 1; n <= number_of_ranks(); ++n)
    {
      round_trip<3>(n);
      round_trip<2>(n);
    }
}

/** Columns of a user's own effect, behind those of every cell. */
template <int dim>
struct Own
{
  CellColumns<dim>       columns;
  Column<double>         dose;
  Column<Tensor<1, dim>> polarity;
  Column<std::uint64_t>  key;

  Own()
  {
    dose     = columns.template add<double>({"dose", "nM", "dose received"});
    polarity = columns.template add<Tensor<1, dim>>({"polarity", "", "axis"});
    key      = columns.template add<std::uint64_t>({"key", "", "a key"});
  }
};

constexpr unsigned int n_cells = 60;

double
dose_of(const unsigned int id)
{
  return 1. / (3. + id);
}

std::uint64_t
key_of(const unsigned int id)
{
  return 0xfedcba9876543210ull - id;
}

/** The state of a tissue with these columns. */
template <int dim>
SnapshotData<dim>
snapshot_of(const Tissue<dim> &tissue)
{
  SnapshotData<dim> data;
  data.cells            = tissue.cells().copy();
  data.boundary_points  = tissue.boundary_points().copy();
  data.cell_columns     = tissue.cells().columns().layout();
  data.boundary_columns = tissue.boundary_points().columns().layout();
  return data;
}

/** What check_columns() says of a snapshot of a cell with own columns. */
std::string
refusal(const SnapshotData<3>    &data,
        const CellColumns<3>     &columns,
        const BoundaryColumns<3> &boundary = BoundaryColumns<3>())
{
  return complaint_of(
    [&] { check_columns(data, columns, boundary, MPI_COMM_WORLD); });
}

TEST_2D_3D(Snapshot, KeepsColumnsOfAnEffectForAnyNumberOfRanks)
{
  const ScratchDirectory directory;
  const std::string      path = directory / "s.h5";
  const Own<dim>         own;
  const auto             is_first = this_rank() == 0;
  PointList<dim>         founders(own.columns.n_numbers());
  for (unsigned int id = 0; is_first && id < n_cells; ++id)
    {
      Point<dim> X;
      X[0] = 20. * id;
      founders.add(id, X, own.columns.founder(X, 8000.));
    }
  Tissue<dim> tissue(GridParameters(), own.columns, MPI_COMM_WORLD);
  tissue.place(founders, PointList<dim>());
  for (unsigned int p = 0; p < tissue.cells().size(); ++p)
    {
      const auto         cell = tissue.cell(p);
      const unsigned int id   = tissue.cells().id(p);
      Tensor<1, dim>     axis;
      axis[id % dim] = -1.;
      cell.set(own.dose, dose_of(id));
      cell.set(own.polarity, axis);
      cell.set(own.key, key_of(id));
    }
  write_snapshot(path, snapshot_of(tissue), MPI_COMM_WORLD);

  const auto  read = read_snapshot<dim>(path, MPI_COMM_WORLD);
  Tissue<dim> again(GridParameters(), own.columns, MPI_COMM_WORLD);
  check_columns(read,
                again.cells().columns(),
                again.boundary_points().columns(),
                MPI_COMM_WORLD);
  again.restore(read.cells,
                read.boundary_points,
                tissue.grid().box().first(),
                tissue.grid().box().n(),
                tissue.grid().weights());
  const Cells<dim> &cells = again.cells();
  EXPECT_EQ(sum_over_ranks(cells.size()), n_cells);
  for (unsigned int p = 0; p < cells.size(); ++p)
    {
      const unsigned int id = cells.id(p);
      EXPECT_EQ(bits(cells.get(own.dose, p)), bits(dose_of(id)));
      EXPECT_EQ(cells.get(own.polarity, p)[id % dim], -1.);
      EXPECT_EQ(cells.get(own.key, p), key_of(id));
      EXPECT_EQ(cells.volume(p), 8000.);
    }
}

TEST(Snapshot, RefusesOtherColumnsByName)
{
  const Own<3>    own;
  SnapshotData<3> data;
  data.file             = "there/snapshot.h5";
  data.cell_columns     = own.columns.layout();
  data.boundary_columns = BoundaryColumns<3>().layout();
  EXPECT_EQ(refusal(data, own.columns), "");

  CellColumns<3> other;
  other.add<double>({"rate", "1/day", "a rate"});
  const std::string text = refusal(data, other);
  expect_parts(text,
               {"there/snapshot.h5",
                "whose cells have the columns",
                "this one lacks 'rate'",
                "has 'dose'",
                "has 'polarity'",
                "start the run anew"});
  EXPECT_NE(refusal(data, own.columns, BoundaryColumns<3>(true))
              .find("boundary points have the columns that the scene's effects "
                    "declare (this one lacks 'edge_1'"),
            std::string::npos);
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
  const unsigned int     rank = this_rank();
  auto                   data = data_of<3>(MPI_COMM_WORLD);
  data.numbers["seconds"]     = 10. + rank;
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
  on_root(MPI_COMM_WORLD, [&]() {
    std::filesystem::rename(path, temporary_path(path));
    seal(path);
  });
  EXPECT_NE(complaint<2>(path).find("this is of format"), std::string::npos);
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
  EXPECT_EQ(directory.files(), std::vector<std::string>{"s.h5"});
  EXPECT_THROW(write_snapshot(directory / "none/s.h5", data, MPI_COMM_WORLD),
               std::runtime_error);
}
