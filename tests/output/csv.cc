// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "output/room.h"

std::string
number(const double value)
{
  std::string text;
  append_number(text, value);
  return text;
}

std::string
printed(const double value)
{
  char text[64];
  std::snprintf(text, sizeof(text), "%.10g", value);
  return text;
}

/** This rank's part of the points 0 ... n-1, dealt out and backwards. */
PointFields<3>
dealt_points(const int n)
{
  const int      rank    = this_rank();
  const int      n_ranks = number_of_ranks();
  PointFields<3> fields;
  fields.names         = {"id", "third", "root"};
  fields.n_csv_columns = 2;
  for (int id = n - 1; id >= 0; --id)
    if (id % n_ranks == rank)
      {
        fields.ids.push_back(id);
        fields.positions.emplace_back(id, 0., 0.);
        for (const double value : {double(id), id / 3., std::sqrt(id)})
          fields.values.push_back(value);
      }
  return fields;
}

TEST(Csv, PrintsNumbersLikePrintf)
{
  EXPECT_EQ(number(0.1), "0.1");
  EXPECT_EQ(number(2. / 3.), "0.6666666667");
  EXPECT_EQ(number(65752), "65752");
  EXPECT_EQ(number(-1), "-1");
  EXPECT_EQ(number(-0.), "0");
  EXPECT_EQ(number(1e-4), "0.0001");
  EXPECT_EQ(number(1.5e-5), "1.5e-05");
  EXPECT_EQ(number(12345678912.), "1.234567891e+10");
  for (const double value : {std::numeric_limits<double>::max(),
                             std::numeric_limits<double>::denorm_min(),
                             -std::numeric_limits<double>::infinity(),
                             double(NAN),
                             9999999999.5,
                             999999999.95})
    EXPECT_EQ(number(value), printed(value));

  std::mt19937                           generator(1);
  std::uniform_real_distribution<double> exponent(-12., 12.);
  for (unsigned int i = 0; i < 10000; ++i)
    {
      const double value = std::pow(10., exponent(generator));
      ASSERT_EQ(number(-value), printed(-value));
    }
}

TEST(Csv, WritesRowsInIdOrder)
{
  const ScratchDirectory directory;
  const std::string      path = directory / "cells-0000.csv";
  const auto parts = gather_to_root(dealt_points(1000), MPI_COMM_WORLD);
  on_root(MPI_COMM_WORLD, [&]() { write_atomically(path, csv_text(parts)); });

  std::string expected = "id,third\n";
  for (int id = 0; id < 1000; ++id)
    expected += printed(id) + ',' + printed(id / 3.) + '\n';
  EXPECT_EQ(content(path), expected);
}
