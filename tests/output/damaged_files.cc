// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "output/room.h"

using Damage = std::function<std::string(std::string, std::mt19937 &)>;

std::size_t
below(const std::size_t n, std::mt19937 &random)
{
  return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
}

/** The position of a block of @p size bytes. */
std::size_t
block(const std::string &text, const std::size_t size, std::mt19937 &random)
{
  return below(text.size() - size + 1, random);
}

/** What happens to files: the text is changed at random. */
const std::vector<std::pair<std::string, Damage>> kinds = {
  {"one bit",
   [](std::string text, std::mt19937 &random) {
     text[below(text.size(), random)] ^= char(1 << below(8, random));
     return text;
   }},
  {"truncated",
   [](std::string text, std::mt19937 &random) {
     text.resize(below(text.size(), random));
     return text;
   }},
  {"appended",
   [](std::string text, std::mt19937 &random) {
     const std::size_t n = 1 + below(600, random);
     return text + (below(2, random) == 0 ? std::string(n, '\0') :
                                            text.substr(text.size() - n));
   }},
  {"zeroed",
   [](std::string text, std::mt19937 &random) {
     const std::size_t size = std::min<std::size_t>(4096, text.size() / 3);
     return text.replace(block(text, size, random), size, size, '\0');
   }},
  // two blocks of equal size in each other's place
  {"swapped",
   [](std::string text, std::mt19937 &random) {
     const std::size_t size = std::min<std::size_t>(512, text.size() / 4);
     const std::size_t half = text.size() / 2, a = below(half - size, random),
                       b = half + below(half - size, random);
     std::swap_ranges(text.begin() + a, text.begin() + a + size, &text[b]);
     return text;
   }},
  {"lost",
   [](std::string text, std::mt19937 &random) {
     return text.erase(block(text, 64, random), 1 + below(64, random));
   }},
  {"doubled",
   [](std::string text, std::mt19937 &random) {
     const std::size_t at = block(text, 64, random);
     return text.insert(at, text.substr(at, 1 + below(64, random)));
   }},
  {"one digit", [](std::string text, std::mt19937 &random) {
     std::size_t at = 0;
     while (!std::isdigit(static_cast<unsigned char>(text[at])))
       at = below(text.size(), random);
     text[at] = char('0' + (text[at] - '0' + 1 + below(9, random)) % 10);
     return text;
   }}};

/** Calls @p judge with so many different damaged variants of a file. */
void
for_damaged(const std::string                                           &path,
            const unsigned int                                           n,
            const std::function<void(const std::string &, std::string)> &judge)
{
  MPI_Barrier(MPI_COMM_WORLD);
  const std::string whole = content(path);
  std::mt19937      random(20261122); // the same on all ranks
  MPI_Barrier(MPI_COMM_WORLD);        // all have read
  std::set<std::string> seen = {whole};
  while (seen.size() <= n)
    {
      const auto &[name, damage] = kinds[seen.size() % kinds.size()];
      const std::string damaged  = damage(whole, random);
      if (!seen.insert(damaged).second)
        continue;
      on_root(MPI_COMM_WORLD, [&]() { write(path, damaged); });
      judge(name + ", variant " + std::to_string(seen.size() - 1), damaged);
      MPI_Barrier(MPI_COMM_WORLD);
      EXPECT_TRUE(content(path) == damaged) << name << ": touched";
      MPI_Barrier(MPI_COMM_WORLD);
    }
  on_root(MPI_COMM_WORLD, [&]() { write(path, whole); });
}

PointList<3>
points(const unsigned int n)
{
  PointList<3> list;
  list.n_numbers = 5;
  for (unsigned int id = 0; id < n; ++id)
    {
      list.ids.push_back(id);
      list.positions.emplace_back(id, std::sqrt(id), -1. / (1. + id));
      for (unsigned int slot = 0; slot < list.n_numbers; ++slot)
        list.numbers.push_back(std::sin(id + 100. * slot));
    }
  return list;
}

SnapshotData<3>
state()
{
  SnapshotData<3> data;
  data.program_version       = "1.2";
  data.parameters            = "set Dimension = 3\n";
  data.time                  = 0.3;
  data.numbers["steps"]      = 12;
  data.tables["times"]       = {0.25, 1. / 3.};
  data.integer_tables["box"] = {-1, 2147483647};
  data.cells                 = points(100);
  data.boundary_points       = points(20);
  return data;
}

StatisticsRow
row(const unsigned int step)
{
  StatisticsRow row;
  row.step                = step;
  row.time                = 0.1 * step;
  row.cells               = 1000 + step;
  row.tissue.total_volume = 1e6 / (7. + step);
  return row;
}


TEST(DamagedFiles, OfSnapshotsAreAllRefused)
{
  const ScratchDirectory directory;
  const std::string      path = directory / "snapshot.h5";
  write_snapshot(path, state(), MPI_COMM_WORLD);

  for_damaged(path, 160, [&](const std::string &name, const std::string &) {
    for (const std::string &said :
         {complaint_of([&] { read_snapshot<3>(path, MPI_COMM_WORLD); }),
          complaint_of(
            [&] { read_snapshot_parameters(path, MPI_COMM_WORLD); })})
      {
        EXPECT_NE(said, "") << name << " was believed";
        // without a word of the library that must not see it
        EXPECT_EQ(said.find("cannot read"), std::string::npos)
          << name << ": " << said;
      }
  });
  EXPECT_EQ(read_snapshot<3>(path, MPI_COMM_WORLD).number("steps"), 12.);
}

TEST(DamagedFiles, OfTablesAreAllRefused)
{
  const ScratchDirectory directory;
  const std::string      path = directory / "statistics.csv";
  TableExtent            kept;
  {
    AppendedCsv file(path, statistics_row({}).header(), MPI_COMM_WORLD);
    for (unsigned int step = 0; step < 20; ++step)
      file.append(statistics_row(row(step)).text());
    kept = file.extent();
  }
  MPI_Barrier(MPI_COMM_WORLD);
  const std::string whole = content(path);

  const auto judge = [&](const std::string &name, const std::string &damaged) {
    // what comes behind the rows that are kept is cut off unread
    const bool only_longer = damaged.compare(0, whole.size(), whole) == 0;
    const std::string said = complaint_of([&] {
      AppendedCsv::check(path,
                         statistics_row({}).header(),
                         kept,
                         MPI_COMM_WORLD);
    });
    EXPECT_EQ(said.empty(), only_longer) << name;
  };
  for_damaged(path, 160, judge);
  AppendedCsv::check(path, statistics_row({}).header(), kept, MPI_COMM_WORLD);
}

TEST(Seal, IsTheDigestThatTheDocumentationNames)
{
  // the check value in the catalogues of CRCs
  Digest digest;
  digest.process_bytes("1234", 4);
  digest.process_bytes("56789", 5);
  EXPECT_EQ(digest.checksum(), 0x995dc9bbdf1939fau);
  EXPECT_EQ(digest_text(0x12abu), "00000000000012ab");
  for (const std::uint64_t value : {digest.checksum(), ~digest.checksum()})
    EXPECT_EQ(digest_of_integers(as_integers(value)), value);

  const ScratchDirectory directory;
  const std::string      path = directory / "file";
  on_root(MPI_COMM_WORLD, [&]() {
    write(temporary_path(path), std::string(size_of_seal, 'x') + "123456789");
    seal(path);
  });
  std::string expected =
    "Morula snapshot\nbytes 9\nCRC-64/XZ 995dc9bbdf1939fa\n";
  expected.resize(size_of_seal, '\n');
  EXPECT_EQ(content(path), expected + "123456789");
  EXPECT_NO_THROW(check_seal(path));
  EXPECT_THROW(check_seal(directory / "none"), InputError);
  MPI_Barrier(MPI_COMM_WORLD);
}
