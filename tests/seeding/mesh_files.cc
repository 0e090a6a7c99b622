// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "seeding/room.h"

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

/** What is written into files: a box of 3 x 4 x 5 um. */
const std::vector<Point<3>>                  corners = {{0, 0, 0},
                                                        {3, 0, 0},
                                                        {3, 4, 0},
                                                        {0, 4, 0},
                                                        {0, 0, 5},
                                                        {3, 0, 5},
                                                        {3, 4, 5},
                                                        {0, 4, 5}};
const std::vector<std::vector<unsigned int>> box     = {{0, 2, 1},
                                                        {0, 3, 2},
                                                        {4, 5, 6},
                                                        {4, 6, 7},
                                                        {0, 1, 5},
                                                        {0, 5, 4},
                                                        {1, 2, 6},
                                                        {1, 6, 5},
                                                        {2, 3, 7},
                                                        {2, 7, 6},
                                                        {3, 0, 4},
                                                        {3, 4, 7}};

std::string
text_of(const Point<3> &x, const std::string &separator)
{
  std::ostringstream text;
  text.precision(17);
  text << x[0] << separator << x[1] << separator << x[2];
  return text.str();
}

/** The box as a text in the STL format. Triangles that do not come first move
 *  their vertices by up to @p error, relative. */
std::string
stl(const std::string &name = "box", const double error = 0.)
{
  std::string  text = "solid " + name + "\n";
  unsigned int n    = 0;
  for (const auto &triangle : box)
    {
      text += "  facet normal 0 0 0\n    outer loop\n";
      for (const unsigned int v : triangle)
        text += "      vertex " +
                text_of((1. + error * (++n % 5) / 4.) * corners[v], " ") + "\n";
      text += "    endloop\n  endfacet\n";
    }
  return text + "endsolid " + name + "\n";
}

/** Vertices and triangles, each line with a word before it. */
std::string
lists(const std::string &vertex,
      const std::string &polygon,
      const unsigned int first)
{
  std::string text;
  for (const Point<3> &x : corners)
    text += vertex + text_of(x, " ") + "\n";
  for (const auto &t : box)
    text += polygon + std::to_string(t[0] + first) + " " +
            std::to_string(t[1] + first) + " " + std::to_string(t[2] + first) +
            "\n";
  return text;
}

std::string
replaced(std::string text, const std::string &old, const std::string &instead)
{
  return boost::replace_all_copy(text, old, instead);
}

/** The volume inside a mesh, µm^3. */
double
volume(const std::string &content, const std::string &ending)
{
  const TemporaryFile file(ending, content);
  const SurfaceMesh   mesh("Tissue/Surface mesh", file.path);
  double              result = 0.;
  for (const SurfaceTriangle &triangle : mesh.triangles())
    result += triangle.vertices[0] *
              cross_product_3d(triangle.vertices[1], triangle.vertices[2]) / 6.;
  return result;
}

TEST(MeshFiles, TextsAsTheWorldWritesThem)
{
  const std::string mark = "\xEF\xBB\xBF";
  const std::string off  = "OFF\n8 12 0\n" + lists("", "3 ", 0);
  const std::string obj  = "o box\n" + lists("v ", "f ", 1);
  const std::string ply  = "ply\nformat ascii 1.0\nelement vertex 8\n"
                           "property float x\nproperty float y\n"
                           "property float z\nelement face 12\n"
                           "property list uchar int vertex_indices\n"
                           "end_header\n" +
                          lists("", "3 ", 0);
  for (const auto &[text, ending] :
       std::vector<std::pair<std::string, std::string>>{
         {stl(), ".stl"}, {off, ".off"}, {obj, ".obj"}, {ply, ".ply"}})
    for (const std::string &variant : {text,
                                       mark + text,
                                       " " + text,
                                       "\n\n" + text,
                                       replaced(text, "\n", "\r\n"),
                                       replaced(text, "\n", "\r"),
                                       replaced(text, "\n", "\n\n"),
                                       replaced(text, "\n", " \n\t"),
                                       boost::to_upper_copy(text),
                                       boost::to_lower_copy(text)})
      EXPECT_NEAR(volume(variant, ending), 60., 1e-12) << ending << ":\n"
                                                       << variant;
  EXPECT_NEAR(volume(stl("facet vertex solid"), ".stl"), 60., 1e-12);
  EXPECT_NEAR(volume(replaced(stl(), " box", ""), ".stl"), 60., 1e-12);
  EXPECT_NEAR(volume("l 1 2\ncall x\n" + replaced(obj, " ", "\t"), ".obj"),
              60.,
              1e-12);
  EXPECT_NEAR(volume(replaced(ply, "ply\n", "ply\ncomment by hand\n"), ".ply"),
              60.,
              1e-12);
}

TEST(MeshFiles, HeaderOfABinaryFile)
{
  std::string body;
  const auto  append = [&body](const auto value) {
    body.append(reinterpret_cast<const char *>(&value), sizeof(value));
  };
  for (const Point<3> &x : corners)
    for (unsigned int d = 0; d < 3; ++d)
      append(static_cast<float>(x[d]));
  for (const auto &triangle : box)
    {
      append(static_cast<unsigned char>(3));
      for (const unsigned int vertex : triangle)
        append(static_cast<std::int32_t>(vertex));
    }
  const std::string header =
    "ply\ncomment by hand\nformat binary_little_endian 1.0\n"
    "element vertex 8\nproperty float x\nproperty float y\n"
    "property float z\nelement face 12\n"
    "property list uchar int vertex_indices\nend_header\n";
  for (const std::string end : {"\n", "\r\n"})
    EXPECT_NEAR(volume(replaced(header, "\n", end) + body, ".ply"), 60., 1e-12);
}

TEST(MeshFiles, MergesWhatDiffersByRounding)
{
  for (const double error : {4e-16, 1e-12, 1e-7})
    EXPECT_NEAR(volume(stl("box", error), ".stl"),
                60.,
                60. * 4. * error + 1e-12);
  // the corner at the origin stands still: each other one has up to five places
  EXPECT_TRUE(contains(refusal(stl("box", 1e-4), ".stl"), "open"));
}

TEST(MeshFiles, SaysWhatAFileIs)
{
  EXPECT_TRUE(contains(refusal(" \n\t\r\n", ".stl"), "empty"));
  // A text without a triangle is read as one.
  EXPECT_TRUE(contains(refusal("<html>\n</html>\n", ".stl"), "cut off"));
  for (const std::string text :
       {"PK\x03\x04", "version https://git-lfs.github.com/spec/v1\n"})
    EXPECT_TRUE(contains(refusal(text, ".ply"), "cannot be read"));
  EXPECT_TRUE(
    contains(refusal(replaced(stl(), "vertex 3", "vertex 3,0"), ".stl"),
             "decimal points"));
  EXPECT_NE(refusal("OFF\n8 12 0\n" + lists("", "3 ", 3), ".off"), "");
  EXPECT_NE(refusal(lists("v ", "f ", 2), ".obj"), "");
}

TEST(MeshFiles, RefusesFilesThatAreCutOff)
{
  const std::string facet = "facet normal 0 0 0\nouter loop\nvertex 0 0 0\n"
                            "vertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  EXPECT_TRUE(contains(refusal("solid a\n" + facet, ".stl"), "cut off"));
  EXPECT_TRUE(
    contains(refusal("solid a\n" + facet + "endsolid a\n", ".stl"), "open"));
  EXPECT_TRUE(contains(refusal(std::string(83, '\0'), ".stl"), "cut off"));
  // a binary file with one of two triangles, whose header says 'solid'
  std::string binary = "solid" + std::string(75, ' ');
  binary += std::string("\2\0\0\0", 4) + std::string(50, '\0');
  EXPECT_TRUE(contains(refusal(binary, ".STL"), "1 whole triangles"));
  EXPECT_TRUE(contains(refusal("", ".ply"), "empty"));
}

TEST(MeshFiles, RefusesWhatNoReaderCouldTake)
{
  const std::string off = "OFF\n8 12 0\n" + lists("", "3 ", 0);
  const std::string obj = "# by hand\n\no box\n" + lists("v ", "f ", 1);
  const std::string ply = "ply\nformat ascii 1.0\nelement vertex 8\n"
                          "property float x\nproperty float y\n"
                          "property float z\nelement face 12\n"
                          "property list uchar int vertex_indices\n"
                          "end_header\n" +
                          lists("", "3 ", 0);
  for (const auto &[text, ending] :
       std::vector<std::pair<std::string, std::string>>{
         {replaced(obj, "f 3 8 7", "f 3 80 7"), ".obj"},
         {replaced(obj, "f 3 8 7", "f -9 8 7"), ".obj"},
         {replaced(obj, "v 3 4 5", "v 3 nan 5"), ".obj"},
         {replaced(obj, "v 3 4 5", "v 3 \\\n 5"), ".obj"},
         {replaced(off, "3 2 3 7", "3 2 3 8"), ".off"},
         {replaced(off, "3 2 3 7", "2 2 x"), ".off"},
         {replaced(off, "\n3 4 5\n", "\n3 inf 5\n"), ".off"},
         {off.substr(0, off.size() - 16), ".off"},
         {"OFF 8\n", ".off"},
         {replaced(ply, "\n3 4 5\n", "\n3 4 -nan\n"), ".ply"},
         {replaced(ply, "3 2 3 7", "3 2 3 x"), ".ply"},
         {ply.substr(0, ply.find("3 4 0")), ".ply"},
         {replaced(ply, "end_header\n", ""), ".ply"},
         {replaced(stl(), "vertex 3 4 5\n", "vertex 3 4 5\nvertex 1 1 1\n"),
          ".stl"},
         {replaced(stl(), "vertex 3 4 5", "vertex 3 4 infinite"), ".stl"}})
    EXPECT_NE(refusal(text, ending), "") << ending << ":\n" << text;
}

TEST(MeshFiles, RecordsOfABinaryFile)
{
  const auto bytes = [](const bool big, const auto value) {
    std::string text(reinterpret_cast<const char *>(&value), sizeof(value));
    if (big)
      std::reverse(text.begin(), text.end());
    return text;
  };
  for (const bool big : {false, true})
    {
      std::string text = std::string("ply\nformat binary_") +
                         (big ? "big" : "little") +
                         "_endian 1.0\nelement vertex 8\nproperty float x\n"
                         "property float y\nproperty float z\nelement face 12\n"
                         "property list uchar int vertex_indices\nend_header\n";
      for (const Point<3> &x : corners)
        for (unsigned int d = 0; d < 3; ++d)
          text += bytes(big, static_cast<float>(x[d]));
      std::string wrong;
      for (const auto &triangle : box)
        {
          wrong = text;
          text += '\3', wrong += '\3';
          for (const unsigned int vertex : triangle)
            {
              text += bytes(big, static_cast<std::int32_t>(vertex));
              wrong += bytes(big, static_cast<std::int32_t>(vertex + 10));
            }
        }
      EXPECT_NEAR(volume(text, ".ply"), 60., 1e-12);
      EXPECT_NE(refusal(text.substr(0, text.size() - 20), ".ply"), "");
      // CGAL reads it in silence.
      EXPECT_TRUE(contains(refusal(wrong, ".ply"), "names a vertex"));
    }
}

TEST(MeshFiles, DropsFacesThatAreThereTwiceOrFlat)
{
  const std::string end   = "endsolid box\n";
  const std::string facet = "facet normal 0 0 0\nouter loop\nvertex 0 0 0\n"
                            "vertex 3 4 0\nvertex 3 0 0\nendloop\nendfacet\n";
  const std::string turned =
    replaced(replaced(replaced(facet, "3 4 0", "A"), "3 0 0", "3 4 0"),
             "A",
             "3 0 0");
  const std::string flat = replaced(facet, "3 4 0", "0 0 0");
  for (const std::string &more : {facet, turned, flat + flat})
    EXPECT_NEAR(volume(replaced(stl(), end, more + end), ".stl"), 60., 1e-12);
}
