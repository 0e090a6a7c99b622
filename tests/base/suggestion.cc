// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "base/room.h"

TEST(Suggestion, CountsEdits)
{
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("abc", ""), 3u);
  EXPECT_EQ(edit_distance("Spacing", "Spacing"), 0u);
  EXPECT_EQ(edit_distance("Spacing", "Spcing"), 1u);   // a deletion
  EXPECT_EQ(edit_distance("Spacing", "Spaceing"), 1u); // an insertion
  EXPECT_EQ(edit_distance("Spacing", "Spating"), 1u);  // a replacement
  EXPECT_EQ(edit_distance("Grid", "Gird"), 1u);        // a swap
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("sitting", "kitten"), 3u);
  EXPECT_EQ(edit_distance("ca", "abc"), 3u); // swaps are not edited again
}


TEST(Suggestion, FindsTheMostSimilarWord)
{
  const std::vector<std::string> shapes = {"sphere", "box", "ellipsoid"};
  EXPECT_EQ(most_similar("spere", shapes), "sphere");
  EXPECT_EQ(most_similar("SPHERE", shapes), "sphere");
  EXPECT_EQ(most_similar("elipsoide", shapes), "ellipsoid");
  EXPECT_EQ(most_similar("bx", shapes), "box");
  EXPECT_EQ(most_similar("torus", shapes), "");
  EXPECT_EQ(most_similar("", shapes), "");
  EXPECT_EQ(most_similar("x", shapes), "");
  EXPECT_EQ(most_similar(std::string(100000, 'b'), shapes), "");
  EXPECT_EQ(most_similar("box", {}), "");
}


TEST(Suggestion, KnowsTheWordsOfTheField)
{
  using Words = std::vector<std::string>;
  EXPECT_EQ(words_of_keys("Uptake"), Words{"Consumption"});
  EXPECT_EQ(words_of_keys("cell size"), Words{"Cell spacing"});
  EXPECT_EQ(words_of_keys("adhesion"), (Words{"Tension/With", "Fusion time"}));
  EXPECT_EQ(words_of_keys("Spacing"), Words());
  EXPECT_EQ(words_of_keys("drug"), (Words{"Death", "Fields", "Cell numbers"}));
  EXPECT_EQ(similar_word("viscocity"), "viscosity");
  EXPECT_EQ(similar_word("apoptsis"), "apoptosis");
  EXPECT_EQ(similar_word("qwertz"), "");
}


TEST(Suggestion, FindsPaths)
{
  const std::vector<std::string> keys = {"Dimension",
                                         "Time/End time",
                                         "Grid/Spacing",
                                         "Growth/Law",
                                         "Growth/Isotropic/Stretch",
                                         "Proliferation/Law"};
  EXPECT_EQ(suggest_path("Grid/Spcing", keys), "Did you mean 'Grid/Spacing'?");
  EXPECT_EQ(suggest_path("Gird/Spacing", keys), "Did you mean 'Grid/Spacing'?");
  EXPECT_EQ(suggest_path("grid/spacing", keys), "Did you mean 'Grid/Spacing'?");
  EXPECT_EQ(suggest_path("Growth/Stretch", keys),
            "Did you mean 'Growth/Isotropic/Stretch'?");
  EXPECT_EQ(suggest_path("Time/Dimension", keys), "Did you mean 'Dimension'?");
  EXPECT_EQ(suggest_path("Material/Law", keys),
            "Did you mean 'Growth/Law' or 'Proliferation/Law'?");
  EXPECT_EQ(suggest_path("Completely/Different", keys), "");
}
