// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "base/room.h"

TEST(Json, IsReadBackByAnother)
{
  const std::string           text = "a \"quoted\" \\ path,\n\tand \x01 µm";
  std::stringstream           all(Json::object(
    {{"text", Json::text(text)},
               {"numbers", Json::list({Json::number(0.1), Json::number(1. / 3.)})},
               {"words", Json::texts({"one", "two"})},
               {"none", Json::object({})}}));
  boost::property_tree::ptree found;
  boost::property_tree::read_json(all, found);
  EXPECT_EQ(found.get<std::string>("text"), text);
  std::vector<double> numbers;
  for (const auto &[name, value] : found.get_child("numbers"))
    numbers.push_back(value.get_value<double>());
  EXPECT_EQ(numbers, (std::vector<double>{0.1, 1. / 3.}));
  EXPECT_EQ(found.get_child("words").size(), 2u);
}


TEST(Json, WritesNumbersShortAndNoOthers)
{
  EXPECT_EQ(Json::number(0.1), "0.1");
  EXPECT_EQ(Json::number(125.), "125");
  EXPECT_EQ(Json::number(std::nan("")), "null");
  EXPECT_EQ(Json::number(std::numeric_limits<double>::infinity()), "null");
}
