// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/surface_mesh.h>

#include <gtest/gtest.h>

#include <string>

#include "common/complaint.h"
#include "common/temporary_file.h"

using namespace Morula;

namespace
{
  /** Why a mesh is refused; empty if it is not. */
  std::string
  refusal(const std::string &content, const std::string &ending)
  {
    const TemporaryFile file(ending, content);
    return complaint_of(
      [&] { SurfaceMesh mesh("Tissue/Surface mesh", file.path); });
  }

  bool
  contains(const std::string &text, const std::string &part)
  {
    return text.find(part) != std::string::npos;
  }
} // namespace

TEST(MeshFiles, RefusesFilesThatAreCutOff)
{
  const std::string facet = "facet normal 0 0 0\nouter loop\nvertex 0 0 0\n"
                            "vertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  EXPECT_TRUE(contains(refusal("solid a\n" + facet, ".stl"), "cut off"));
  EXPECT_TRUE(
    contains(refusal("solid a\n" + facet + "endsolid a\n", ".stl"), "open"));
  EXPECT_TRUE(contains(refusal(std::string(83, ' '), ".stl"), "cut off"));
  // a binary file with one of two triangles, whose header says 'solid'
  std::string binary = "solid" + std::string(75, ' ');
  binary += std::string("\2\0\0\0", 4) + std::string(50, '\0');
  EXPECT_TRUE(contains(refusal(binary, ".STL"), "1 whole triangles"));
  EXPECT_TRUE(contains(refusal("", ".ply"), "empty"));
}
