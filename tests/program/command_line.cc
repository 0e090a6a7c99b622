// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "program/room.h"

std::string
complaint(const std::vector<std::string> &words)
{
  return complaint_of([&] { CommandLine::parse(words); });
}


TEST(CommandLine, NamesTheScene)
{
  const CommandLine line = CommandLine::parse({"a.prm"});
  EXPECT_EQ(line.scene_file, "a.prm");
  EXPECT_TRUE(line.overrides.empty());
  EXPECT_FALSE(line.resume || line.explain || line.parameters || line.version ||
               line.help);
}


TEST(CommandLine, CollectsOverridesInOrder)
{
  const CommandLine line =
    CommandLine::parse({"-s",
                        "Time/End time=2",
                        "a.prm",
                        "-s",
                        "Growth/Isotropic/Stretch=if(X <= 0, -1, 1)",
                        "--resume"});
  EXPECT_EQ(line.scene_file, "a.prm");
  EXPECT_EQ(
    line.overrides,
    (std::vector<std::string>{"Time/End time=2",
                              "Growth/Isotropic/Stretch=if(X <= 0, -1, 1)"}));
  EXPECT_TRUE(line.resume);
  EXPECT_FALSE(line.explain);
}


TEST(CommandLine, KnowsItsOptions)
{
  EXPECT_TRUE(CommandLine::parse({"a.prm", "--explain"}).explain);
  EXPECT_TRUE(CommandLine::parse({"a.prm", "--replace"}).replace);
  EXPECT_FALSE(CommandLine::parse({"a.prm"}).replace);
  EXPECT_TRUE(CommandLine::parse({"--parameters"}).parameters);
  EXPECT_TRUE(CommandLine::parse({"--version"}).version);
  EXPECT_TRUE(CommandLine::parse({"--serve"}).serve);
  EXPECT_FALSE(CommandLine::parse({"a.prm", "--explain"}).json);
  EXPECT_TRUE(CommandLine::parse({"a.prm", "--explain=json"}).json);
  const CommandLine keys =
    CommandLine::parse({"--parameters=json", "lumen", "a.prm", "volume"});
  EXPECT_TRUE(keys.parameters && keys.json);
  EXPECT_EQ(keys.scene_file, "a.prm");
  EXPECT_EQ(keys.words, (std::vector<std::string>{"lumen", "volume"}));
  EXPECT_EQ(CommandLine::parse({"--parameters", "a.prm"}).scene_file, "a.prm");
  EXPECT_TRUE(CommandLine::parse({"--help"}).help);
  EXPECT_TRUE(CommandLine::parse({"explain", "a.prm"}).explain);
  EXPECT_EQ(CommandLine::parse({"keys", "lumen"}).words.at(0), "lumen");
}


TEST(CommandLine, RefusesWhatItDoesNotKnow)
{
  for (const auto &[words, part] :
       std::vector<std::pair<std::vector<std::string>, std::string>>{
         {{}, "Name the scene"},
         {{"--resume"}, "Name the scene"},
         {{"a.prm", "b.prm"}, "'a.prm' and 'b.prm'"},
         {{"a.prm", "--rezume"}, "--rezume"},
         {{"a.prm", "--res"}, "--res"},
         {{"a.prm", "--resume", "--replace"}, "leave one of the two out"},
         {{"a.prm", "-s"}, "required argument"},
         {{"a.prm", "--explain=xml"}, "no value but json and text"},
         {{"--parameters=xml"}, "no value but json and text"},
         {{"--parameters", "a.prm", "b.prm"}, "'a.prm' and 'b.prm'"},
         {{"a.prm", "-x"}, "-x"}})
    {
      expect_parts(complaint(words), {part});
    }
}


TEST(CommandLine, PrintsParametersThatCanBeReadBack)
{
  std::stringstream out;
  print_parameters(out);
  EXPECT_THROW(print_parameters(out,
                                CommandLine::parse({"--parameters", "xyz"})),
               InputError);
  std::ostringstream few;
  print_parameters(few, CommandLine::parse({"--parameters", "LUMEN", "gas"}));
  expect_parts(few.str(), {"Lumen pressure"});
  EXPECT_EQ(few.str().find("Lumen where"), std::string::npos);
  // Words of the field find keys, also those of sections that scenes name.
  for (const auto &[words, part] :
       std::vector<std::pair<std::vector<std::string>, std::string>>{
         {{"viscosity"}, "set Relaxation time"},
         {{"cell", "size"}, "set Cell spacing"},
         {{"uptake"}, "set Consumption"},
         {{"morogen", "uptake"}, ""},
         {{"apoptosis"}, "subsection Death"},
         {{"stiffness"}, "set Young's modulus"},
         {{"adhesion"}, "set With OTHER"},
         {{"drag"}, "subsection Friction"},
         {{"necrosis"}, "subsection Death"},
         {{"surface", "tension"}, "set Surface tension"},
         {{"morphogen"}, "subsection Fields"}})
    {
      CommandLine line = CommandLine::parse({"keys"});
      line.words       = words;
      std::ostringstream found;
      if (part.empty())
        EXPECT_THROW(print_parameters(found, line), InputError);
      else
        print_parameters(found, line);
      expect_parts(found.str(), {part});
    }
  std::size_t n_keys = 0;
  for (const Statement &statement : read_statements(out, "output"))
    n_keys += !statement.is_section;
  EXPECT_GE(n_keys, 49u);
  expect_parts(out.str(),
               {"subsection Cell cycle",
                "set Spacing = 50",
                "# With Method = paper: 1000\n",
                "Allowed: a number >= 0",
                "Allowed: any one of none, cell cycle.",
                "kPa",
                "day"});
}
