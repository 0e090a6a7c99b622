// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/program/program.h>
#include <morula/scene/checks.h>

#include <deal.II/base/timer.h>

#include <boost/algorithm/string.hpp>
#include <gtest/gtest.h>

#include <sys/resource.h>

#include <filesystem>
#include <sstream>

#include "common/complaint.h"
#include "output/scratch_directory.h"

using namespace Morula;
namespace fs = std::filesystem;

// refusals.txt: what the program refuses before any work.

namespace
{
  const fs::path tests = fs::path(MORULA_SOURCE_DIRECTORY) / "tests";

  std::vector<std::string>
  parts_of(const std::string &text, const std::string &separator)
  {
    std::vector<std::string> parts;
    boost::iter_split(parts, text, boost::first_finder(separator));
    return parts;
  }

  /** 125 cells side by side; each row ends with @p end. */
  std::string
  block(const std::string &end)
  {
    std::ostringstream rows;
    for (unsigned int i = 0; i < 125; ++i)
      rows << 12 * (i / 25) << ',' << 12 * (i / 5 % 5) << ',' << 12 * (i % 5)
           << end << '\n';
    return rows.str();
  }

  struct Refusal
  {
    std::string                        row;  // of the table
    std::vector<std::string>           said; // parts of the message
    std::map<std::string, std::string> keys;
    std::map<std::string, std::string> files; // content by name
  };

  /** Reads the rows, with what they name filled in. */
  class TableOfRefusals
  {
  public:
    explicit TableOfRefusals(const std::string &files)
    {
      texts = {{"{files}", files},
               {"\\n", "\n"},
               {"\\0", std::string(1, '\0')},
               {"{empty}", ""},
               {"{block}", block("")},
               {"{block of 1728}", block(",1728")}};
      std::ifstream file(tests / "program/refusals.txt");
      for (std::string line; std::getline(file, line);)
        if (line.empty() || line[0] == '#')
          continue;
        else if (line[0] == '{')
          texts[line.substr(0, line.find('}') + 1)] =
            line.substr(line.find('=') + 2);
        else if (line[0] == '@')
          sets[line.substr(0, line.find(' '))] =
            line.substr(line.find('|') + 2);
        else
          rows.push_back(line);
    }

    Refusal
    refusal(const std::string &row) const
    {
      std::vector<std::string> parts = parts_of(row, " | ");
      Refusal                  refusal{row, {}, {}, {}};
      for (auto part = parts.begin() + 2; part != parts.end(); ++part)
        add(*part, refusal);
      add(parts[0], refusal);

      // The message may be about another key, or about a line of a file.
      refusal.said            = parts_of(parts[1], " & ");
      const std::string first = refusal.said.front();
      const auto [key, value] = key_and_value(parts[0]);
      if (!boost::ends_with(first, " ="))
        {
          refusal.said.push_back(key);
          if (first[0] != '\'' && !boost::starts_with(first, "line "))
            refusal.said.push_back("'" + filled(value) + "'");
        }
      return refusal;
    }

    std::vector<std::string> rows;

  private:
    std::string
    filled(std::string text) const
    {
      // The table's own texts have line ends, which come last.
      for (auto pair = texts.rbegin(); pair != texts.rend(); ++pair)
        boost::replace_all(text, pair->first, pair->second);
      return text;
    }

    static std::pair<std::string, std::string>
    key_and_value(const std::string &text)
    {
      const std::size_t at = text.find(" =");
      return {text.substr(0, at), boost::trim_copy(text.substr(at + 2))};
    }

    /** Adds KEY = VALUE, FILE: CONTENT, or a set of these. */
    void
    add(const std::string &part, Refusal &refusal) const
    {
      const std::size_t colon = part.find(": ");
      if (part[0] == '@')
        for (const std::string &of_set : parts_of(sets.at(part), " | "))
          add(of_set, refusal);
      else if (colon < part.find(" ="))
        refusal.files[part.substr(0, colon)] = filled(part.substr(colon + 2));
      else
        {
          const auto [key, value] = key_and_value(part);
          refusal.keys[key]       = filled(value);
        }
    }

    std::map<std::string, std::string> texts, sets;
  };

  /** What a run does before any work. */
  void
  check(const Refusal &refusal, const fs::path &output)
  {
    std::vector<std::string> overrides = {"Output directory=" +
                                          output.string()};
    for (const auto &[key, value] : refusal.keys)
      overrides.push_back(key + "=" + value);
    const Scene scene =
      Scene::read((tests / "programs/small-cube.prm").string(), overrides);
    scene.check();
    check_memory(scene, initial_size(scene), MPI_COMM_WORLD);
    std::ostringstream said;
    explain(scene, said, MPI_COMM_WORLD);
  }
} // namespace


TEST(Refusals, AreSaidAtOnceWithKeyValueAndRemedy)
{
  const ScratchDirectory directory;
  const TableOfRefusals  table(directory / "");
  fs::current_path(tests / "scenes"); // whose files rows name
  ASSERT_GE(table.rows.size(), 240u);
  for (const std::string &row : table.rows)
    {
      SCOPED_TRACE(row);
      const Refusal refusal = table.refusal(row);
      for (const auto &[name, content] : refusal.files)
        std::ofstream(directory / name, std::ios::binary) << content;
      const fs::path      output = directory / "output";
      const dealii::Timer timer;
      const std::string message = complaint_of([&] { check(refusal, output); });
      expect_parts(message, refusal.said);
      EXPECT_LT(message.size(), 1500u);
      EXPECT_LT(timer.cpu_time(), 5.);
      EXPECT_FALSE(fs::exists(output));
      for (const auto &[name, content] : refusal.files)
        fs::remove(directory / name);
    }

  // Nothing is made as large as some of these scenes ask for.
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  EXPECT_LT(usage.ru_maxrss, 1000000); // kB
}
