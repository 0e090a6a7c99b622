// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "seeding/room.h"

/** x, y, (z,) volume of all ranks' cells in id order; checks the ids. */
template <int dim>
std::vector<std::vector<double>>
read_and_gather(const std::string &content)
{
  const TemporaryFile file(".csv", content);
  const auto          mine = read_points<dim>(file.path, 1000., MPI_COMM_WORLD);
  std::vector<std::vector<double>> rows;
  for (std::size_t i = 0; i < mine.positions.size(); ++i)
    {
      rows.emplace_back(mine.positions[i].begin_raw(),
                        mine.positions[i].end_raw());
      rows.back().push_back(mine.volumes.at(i));
    }

  std::vector<std::vector<double>> all;
  const auto pieces = Utilities::MPI::all_gather(MPI_COMM_WORLD, rows);
  for (unsigned int r = 0; r < pieces.size(); ++r)
    {
      if (r == this_rank())
        {
          EXPECT_EQ(mine.first_id, all.size());
        }
      all.insert(all.end(), pieces[r].begin(), pieces[r].end());
    }
  EXPECT_EQ(mine.n_global, all.size());
  return all;
}

/** The message with which a file is refused, on every rank; or nothing. */
template <int dim>
std::string
refusal(const std::string &content)
{
  return complaint_of([&] { read_and_gather<dim>(content); });
}

bool
contains(const std::string &text, const std::string &part)
{
  return text.find(part) != std::string::npos;
}

using Rows = std::vector<std::vector<double>>;

TEST(PointsFile, RowsAreIds)
{
  EXPECT_EQ(read_and_gather<3>("x,y,z,volume\n"
                               "1,2,3,4\n"
                               "-5.5,6e1,+7,8\n"
                               "9,10,11,12"),
            (Rows{{1., 2., 3., 4.}, {-5.5, 60., 7., 8.}, {9., 10., 11., 12.}}));
}

TEST(PointsFile, ManyRowsInOrder)
{
  std::string content = "x,y,z\n";
  Rows        expected;
  for (unsigned int i = 0; i < 1000; ++i)
    {
      // lines of different lengths, with some that do not count
      const double x = i % 7 == 0 ? i + 0.125 : i;
      content += Utilities::to_string(x) + "," + std::to_string(i % 3) + ",0\n";
      expected.push_back({x, static_cast<double>(i % 3), 0., 1000.});
      if (i % 11 == 0)
        content += "# a remark\n\n";
    }
  EXPECT_EQ(read_and_gather<3>(content), expected);
}

TEST(PointsFile, SpreadsheetsAndRemarks)
{
  EXPECT_EQ(read_and_gather<3>("\xEF\xBB\xBF# from the microscope\r\n\r\n"
                               " volume , z,y,x\r\n"
                               " 4, 3 ,2,1\r\n"
                               "   \r\n"
                               "# the end\r\n"),
            (Rows{{1., 2., 3., 4.}}));
}

TEST(PointsFile, TwoDimensions)
{
  EXPECT_EQ(read_and_gather<2>("x,y\n1,2\n"), (Rows{{1., 2., 1000.}}));
  EXPECT_EQ(read_and_gather<2>("x,y,z,volume\n1,2,0,5\n"),
            (Rows{{1., 2., 5.}}));
  EXPECT_TRUE(contains(refusal<2>("x,y,z\n1,2,0\n1,3,1\n"), "line 3"));
}

TEST(PointsFile, Generations)
{
  std::string content = "generation,x,y,z\n";
  for (unsigned int i = 0; i < 100; ++i)
    content += std::to_string(i % 7) + "," + std::to_string(i) + ",0,0\n";
  const TemporaryFile file(".csv", content);
  const auto          mine = read_points<3>(file.path, 1000., MPI_COMM_WORLD);
  ASSERT_EQ(mine.generations.size(), mine.positions.size());
  for (std::size_t i = 0; i < mine.positions.size(); ++i)
    EXPECT_EQ(mine.generations[i], (mine.first_id + i) % 7);

  const TemporaryFile without(".csv", "x,y,z\n1,2,3\n");
  EXPECT_TRUE(
    read_points<3>(without.path, 1000., MPI_COMM_WORLD).generations.empty());
  for (const std::string bad : {"-1", "0.5", "1001", "1e300", "nan", "", "a"})
    EXPECT_TRUE(contains(refusal<3>("x,y,z,generation\n1,2,3,0\n4,5,6," + bad +
                                    "\n7,8,9,0\n"),
                         "line 3"))
      << bad;
}

TEST(PointsFile, Phases)
{
  const TemporaryFile file(".csv",
                           "x,phase,y,z\n0,0,0,0\n9,1,0,0\n"
                           "18,2,0,0\n27,4,0,0\n36,9,0,0\n");
  const auto          mine = read_points<3>(file.path, 1000., MPI_COMM_WORLD);
  std::vector<unsigned int> phases;
  for (const auto &part :
       Utilities::MPI::all_gather(MPI_COMM_WORLD, mine.phases))
    phases.insert(phases.end(), part.begin(), part.end());
  EXPECT_EQ(phases, (std::vector<unsigned int>{0, 1, 2, 4, 9}));
  EXPECT_TRUE(mine.generations.empty());
  for (const std::string bad : {"3", "5", "-1", "1.5", "G1"})
    EXPECT_TRUE(
      contains(refusal<3>("x,y,z,phase\n1,2,3,0\n4,5,6," + bad + "\n"),
               "line 3"))
      << bad;
}

TEST(PointsFile, Types)
{
  const TemporaryFile file(".csv",
                           "x,y,z,type\n0,0,0,stem\n9,0,0, transit \n"
                           "18,0,0,0\n27,0,0,1\n");
  SeedingLimits<3>    limits;
  limits.types    = {"stem", "transit"};
  const auto mine = read_points<3>(file.path, 1000., MPI_COMM_WORLD, limits);
  std::vector<unsigned int> types;
  for (const auto &part :
       Utilities::MPI::all_gather(MPI_COMM_WORLD, mine.types))
    types.insert(types.end(), part.begin(), part.end());
  EXPECT_EQ(types, (std::vector<unsigned int>{0, 1, 0, 1}));
  for (const std::string bad : {"2", "-1", "0.5", "Stem", ""})
    {
      const TemporaryFile wrong(".csv",
                                "x,y,z,type\n0,0,0,1\n9,0,0," + bad + "\n");
      EXPECT_THROW(read_points<3>(wrong.path, 1000., MPI_COMM_WORLD, limits),
                   InputError)
        << bad;
    }
  // in a scene without types
  EXPECT_TRUE(contains(refusal<3>("x,y,z,type\n1,2,3,stem\n"), "no column"));
}

TEST(PointsFile, RefusesWrongHeaders)
{
  EXPECT_TRUE(contains(refusal<3>(""), "empty"));
  EXPECT_TRUE(contains(refusal<3>("1,2,3\n4,5,6\n"), "line 1"));
  EXPECT_TRUE(contains(refusal<3>("# no z\nx,y\n1,2\n"), "line 2"));
  EXPECT_TRUE(contains(refusal<3>("x,y,z,x\n1,2,3,4\n"), "line 1"));
  EXPECT_TRUE(contains(refusal<3>("x,y,z\n\n# nothing\n"), "1 to 4e9"));
  EXPECT_TRUE(contains(refusal<3>("x,y,z"), "1 to 4e9"));
}

TEST(PointsFile, SkipsWhatItDoesNotKnow)
{
  const std::string content = ",name,x,y,z,X,volume\n"
                              "0,a b,1,2,3,6.2,4\n"
                              "1,,5,6,7,none,8\n";
  EXPECT_EQ(read_and_gather<3>(content),
            (Rows{{1., 2., 3., 4.}, {5., 6., 7., 8.}}));
  const TemporaryFile file(".csv", content);
  EXPECT_EQ(read_points<3>(file.path, 1., MPI_COMM_WORLD).skipped_columns,
            (std::vector<std::string>{"", "name", "X"}));
}

TEST(PointsFile, RefusesSeveralMoments)
{
  for (const std::string name : {"FRAME", "t", "time"})
    {
      const std::string one = "x,y,z," + name + "\n1,2,3,7\n31,2,3,7\n";
      EXPECT_EQ(refusal<3>(one), "");
      EXPECT_TRUE(contains(refusal<3>(one + "1,2,4,8\n"), "goes from 7 to 8"));
    }
}

TEST(PointsFile, SaysWhyItIsRefused)
{
  EXPECT_TRUE(contains(refusal<3>("1;2;3\n4;5;6\n"), "no column 'x'"));
  EXPECT_TRUE(
    contains(refusal<3>("x (nm),y (nm),z (nm)\n1,2,3\n"), "no column 'x'"));
  EXPECT_TRUE(contains(refusal<3>("x,y,w\n1,2,3\n"), "no column 'z'"));
  EXPECT_TRUE(contains(refusal<3>("x,y,z,x\n1,2,3,4\n"), "2 columns 'x'"));
  EXPECT_TRUE(
    contains(refusal<3>("x,y,z,type,volume\n1,2,3,a\n"), "This line has 4"));
  EXPECT_TRUE(contains(refusal<3>("x,y,z\n1,5,2,5,3,5\n"), "decimal points"));
  EXPECT_TRUE(
    contains(refusal<3>("x,y,z\n1,2,3\n4,5,1.0D0\n"), "line 3, column 3)"));
  EXPECT_TRUE(
    contains(refusal<3>(std::string("\xFF\xFEx\0,\0y\0", 8)), "no column 'x'"));
  EXPECT_TRUE(contains(refusal<3>(std::string("x,y,z\n1,2,3\0\n", 13)),
                       "line 2, column 3)"));
  EXPECT_TRUE(
    contains(refusal<3>("x,y,z\n" + std::string(20000, '1')), "line 2)"));
}

TEST(PointsFile, NamesTheFirstBadLine)
{
  // rows in different ranks' shares
  std::string start = "x,y,z,volume\n", many;
  for (unsigned int i = 0; i < 100; ++i)
    many += std::to_string(i) + ",0,0,1\n";
  const std::string bad[] = {"1,2,3\n",
                             "1,2,3,4,5\n",
                             "1,2,a,4\n",
                             "1,2,,4\n",
                             "1,2,3,0\n",
                             "1,2,3,-1\n",
                             "nan,2,3,4\n",
                             "inf,2,3,4\n",
                             "1;2;3;4\n",
                             "1,2,3,4 um\n"};
  for (const std::string &line : bad)
    {
      EXPECT_TRUE(contains(refusal<3>(start + many + line + many), "line 102"))
        << line;
      EXPECT_TRUE(contains(refusal<3>(start + line + many + line), "line 2"))
        << line;
    }
}

TEST(PointsFile, RefusesTwoCellsAtOnePlace)
{
  std::string content = "x,y,z\n0,-0.0,1\n";
  for (unsigned int i = 0; i < 50; ++i)
    content += std::to_string(i) + ",5,5\n";
  EXPECT_EQ(refusal<3>(content), "");
  const std::string message = refusal<3>(content + "0,0,1.0\n3,5,5\n");
  EXPECT_TRUE(contains(message, "line 53)"));
  EXPECT_TRUE(contains(message, "line 2 "));
}

TEST(PointsFile, RefusesCellsThatNearlyCoincide)
{
  // lengths are 10 um: what is nearer than 0.01 um coincides
  std::string content = "x,y,z\n";
  for (unsigned int i = 0; i < 50; ++i)
    content += std::to_string(i) + ",0,0\n";
  for (const std::string &near :
       std::vector<std::string>{"20.000000000001,0,0",
                                "20,0,-1e-12",
                                "20.0099,0,0",
                                "19.9931,0.007,0",
                                "20.0057,-0.0057,0.0057"})
    {
      const std::string message = refusal<3>(content + near + "\n");
      EXPECT_TRUE(contains(message, "line 52)")) << near;
      EXPECT_TRUE(contains(message, "line 22 ")) << near;
    }
  EXPECT_EQ(refusal<3>(content + "20.0101,0,0\n19.9929,0.0072,0\n"), "");
  // as the cells' own volumes say
  const std::string small = "x,y,z,volume\n0,0,0,1e-3\n0.0002,0,0,1e-3\n";
  EXPECT_EQ(refusal<3>(small + "9,9,9,1000\n"), "");
  EXPECT_NE(refusal<3>(small + "0.00025,0,0,1e-3\n"), "");
}

TEST(PointsFile, IsSeededWithoutSurface)
{
  const TemporaryFile file(".csv", "x,y,z\n0,0,0\n9,0,0\n");
  TissueParameters    parameters;
  parameters.shape        = "points";
  parameters.points_file  = file.path;
  parameters.cell_spacing = 9.;
  const auto founders     = seed_founders<3>(parameters, MPI_COMM_WORLD);
  EXPECT_EQ(founders.n_global, 2u);
  for (const double volume : founders.volumes)
    EXPECT_DOUBLE_EQ(volume, 729.);
  const auto surface = seed_surface<3>(parameters, MPI_COMM_WORLD);
  EXPECT_EQ(surface.n_global, 0u);
  EXPECT_EQ(surface.positions.size(), 0u);
}
