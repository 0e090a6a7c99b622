// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "output/room.h"

const std::string statistics_header =
  "step,time,dt,cells,total_volume,grown_volume,mean_energy_density,"
  "cell_mean_energy_density,max_energy_density,min_elastic_volume_ratio,"
  "max_elastic_volume_ratio,dividing,held_at_checkpoint,xmin,xmax,ymin,ymax,"
  "zmin,zmax,active_grid_cells,inner_splines,outer_splines,unknowns,"
  "newton_iterations,linear_iterations,rejected_steps,residual,"
  "wall_seconds,min_cells_per_spacing,turns,proximal_paths\n";

/** A row whose every column can be told from the others. */
StatisticsRow
row(const unsigned int step)
{
  StatisticsRow row;
  row.step                            = step;
  row.time                            = 0.25;
  row.dt                              = 3;
  row.cells                           = 4;
  row.tissue.total_volume             = 5;
  row.tissue.grown_volume             = 6;
  row.tissue.mean_energy_density      = 7;
  row.tissue.cell_mean_energy_density = 8;
  row.tissue.max_energy_density       = 9;
  row.tissue.min_elastic_volume_ratio = 10;
  row.tissue.max_elastic_volume_ratio = 11;
  row.dividing                        = 12;
  row.held_at_checkpoint              = 13;
  row.tissue.lower                    = {{14, 16, 18}};
  row.tissue.upper                    = {{15, 17, 19}};
  row.active_grid_cells               = 20;
  row.inner_splines                   = 21;
  row.outer_splines                   = 22;
  row.unknowns                        = 23;
  row.newton_iterations               = 24;
  row.linear_iterations               = 25;
  row.rejected_steps                  = 26;
  row.residual                        = 27e-10;
  row.wall_seconds                    = 28;
  row.lengths.min_cells_per_spacing   = 29;
  row.turns                           = 30;
  row.proximal_paths                  = 31;
  return row;
}

std::string
row_text(const unsigned int step)
{
  return std::to_string(step) +
         ",0.25,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20,21,22,23,24,"
         "25,26,2.7e-09,28,29,30,31\n";
}

void
tear(const std::string &path, const std::string &rest)
{
  MPI_Barrier(MPI_COMM_WORLD);
  on_root(MPI_COMM_WORLD, [&]() { write(path, content(path) + rest); });
}

TEST(Statistics, HaveTheColumnsOfTheContract)
{
  const ScratchDirectory directory;
  const std::string      path = directory / "statistics.csv";
  AppendedCsv file(path, statistics_row({}).header(), MPI_COMM_WORLD);
  EXPECT_EQ(file.extent().n_rows, 0u);
  file.append(statistics_row(row(0)).text());
  file.append(statistics_row(row(1)).text());
  EXPECT_EQ(file.extent().n_rows, 2u);
  file.sync();
  EXPECT_EQ(content(path), statistics_header + row_text(0) + row_text(1));
}

TEST(Statistics, AreCutWhenResumed)
{
  const ScratchDirectory directory;
  const std::string      path = directory / "statistics.csv";
  TableExtent            two, three;
  {
    AppendedCsv file(path, statistics_row({}).header(), MPI_COMM_WORLD);
    for (unsigned int step = 0; step < 4; ++step)
      {
        if (step == 2)
          two = file.extent();
        file.append(statistics_row(row(step)).text());
      }
  }
  tear(path, "4,0.25,3,4,5");
  {
    AppendedCsv file(path, statistics_row({}).header(), two, MPI_COMM_WORLD);
    EXPECT_EQ(content(path), statistics_header + row_text(0) + row_text(1));
    MPI_Barrier(MPI_COMM_WORLD);
    file.append(statistics_row(row(7)).text());
    three = file.extent();
    EXPECT_EQ(three.n_rows, 3u);
  }
  EXPECT_EQ(content(path),
            statistics_header + row_text(0) + row_text(1) + row_text(7));

  // a torn row does not count
  tear(path, "8,0.25");
  const TableExtent four = {4, three.digest};
  EXPECT_THROW(
    AppendedCsv(path, statistics_row({}).header(), four, MPI_COMM_WORLD),
    InputError);
  EXPECT_NO_THROW(
    AppendedCsv(path, statistics_row({}).header(), three, MPI_COMM_WORLD));
}

TEST(Statistics, RefuseToResumeFromOtherFiles)
{
  const ScratchDirectory directory;
  const std::string      path = directory / "statistics.csv";
  const TableExtent      nothing, one = {1, 0};
  EXPECT_THROW(
    AppendedCsv(path, statistics_row({}).header(), nothing, MPI_COMM_WORLD),
    InputError);
  on_root(MPI_COMM_WORLD, [&]() { write(path, "step,time\n0,0\n"); });
  EXPECT_THROW(
    AppendedCsv(path, statistics_row({}).header(), one, MPI_COMM_WORLD),
    InputError);
  EXPECT_EQ(content(path), "step,time\n0,0\n");
}


TEST(Lineage, IsInIdOrder)
{
  const ScratchDirectory directory;
  const std::string      path    = directory / "lineage.csv";
  const unsigned int     rank    = this_rank();
  const unsigned int     n_ranks = number_of_ranks();
  const std::string      header  = "id,parent,generation,birth_time,x,y,z\n";

  AppendedCsv file(path,
                   lineage_row(Birth<3>{}, false).header(),
                   MPI_COMM_WORLD);
  const auto  append = [&](const std::vector<Birth<3>> &births) {
    file.append(lineage_rows(births, false, MPI_COMM_WORLD));
  };
  // the last rank holds the first founder
  const types::particle_index id = n_ranks - 1 - rank;
  append({{id, -1, 0, 0., Point<3>(1.5, 2., id)}});
  std::string expected = header;
  for (unsigned int i = 0; i < n_ranks; ++i)
    {
      const std::string name = std::to_string(i);
      expected += name + ",-1,0,0,1.5,2," + name + "\n";
    }
  const std::size_t end_of_founders = expected.size();
  EXPECT_EQ(content(path), expected);
  EXPECT_EQ(file.extent().n_rows, n_ranks);
  MPI_Barrier(MPI_COMM_WORLD);

  // two daughters on one rank, none elsewhere, and a step without any
  std::vector<Birth<3>> births;
  if (rank == n_ranks - 1)
    births = {{11, 0, 1, 0.625, Point<3>(0., 0., 1e-7)},
              {10, 0, 1, 0.625, Point<3>(0., 0., -1e-7)}};
  append(births);
  append({});
  expected += "10,0,1,0.625,0,0,-1e-07\n11,0,1,0.625,0,0,1e-07\n";
  EXPECT_EQ(content(path), expected);
  EXPECT_EQ(file.extent().n_rows, n_ranks + 2);
  MPI_Barrier(MPI_COMM_WORLD);

  Digest founders;
  founders.process_bytes(expected.data(), end_of_founders);
  AppendedCsv resumed(path,
                      lineage_row(Birth<3>{}, false).header(),
                      {n_ranks, founders.checksum()},
                      MPI_COMM_WORLD);
  EXPECT_EQ(content(path), expected.substr(0, end_of_founders));
}

TEST(Lineage, HasAZeroZInTwoDimensions)
{
  const ScratchDirectory directory;
  const std::string      path = directory / "lineage.csv";
  AppendedCsv            file(path,
                   lineage_row(Birth<3>{}, false).header(),
                   MPI_COMM_WORLD);
  std::vector<Birth<2>>  births;
  if (this_rank() == 0)
    births = {{3, 1, 2, 1. / 3., Point<2>(4., 5.)}};
  file.append(lineage_rows(births, false, MPI_COMM_WORLD));
  EXPECT_EQ(content(path),
            "id,parent,generation,birth_time,x,y,z\n"
            "3,1,2,0.3333333333,4,5,0\n");
}

TEST(Rows, AreInTheOrderOfTheirKeys)
{
  // Rows of equal keys stay as they are, and some ranks have nothing.
  std::vector<int>         keys;
  std::vector<std::string> rows;
  const unsigned int       rank = this_rank();
  if (rank != 1)
    {
      keys = {7, int(rank), 7};
      for (const char *const name : {"first", "other", "second"})
        rows.push_back(name + std::to_string(rank) + '\n');
    }
  EXPECT_EQ(rows_in_order(keys, rows, MPI_COMM_SELF),
            rank == 1 ? "" :
                        "other" + std::to_string(rank) + "\nfirst" +
                          std::to_string(rank) + "\nsecond" +
                          std::to_string(rank) + '\n');
  keys.resize(std::min<std::size_t>(keys.size(), rank == 0 ? 3 : 2), 0);
  rows.resize(keys.size());
  const std::string all = rows_in_order(keys, rows, MPI_COMM_WORLD);
  EXPECT_EQ(all,
            rank > 0 ? "" :
            number_of_ranks() == 1 ?
                       "other0\nfirst0\nsecond0\n" :
                       "other0\nother2\nfirst0\nsecond0\nfirst2\n");
}

TEST(AppendedFiles, SayOnAllRanksThatTheDiskIsFull)
{
  const ScratchDirectory directory;
  AppendedCsv file(directory / "table.csv", "rank\n", MPI_COMM_WORLD);
  file.append("1\n");
  const FullDisk full(50);
  EXPECT_THROW(file.append(std::string(99, '0') + '\n'), std::runtime_error);
}
