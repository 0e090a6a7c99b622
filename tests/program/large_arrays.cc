// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/program/large_arrays.h>

#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

using namespace Morula;

namespace
{
  /** The kernel's flags for the memory at an address; empty if it tells none.
   */
  std::string
  flags_at(const void *address)
  {
    const auto    wanted = reinterpret_cast<std::uintptr_t>(address);
    std::ifstream file("/proc/self/smaps");
    bool          inside = false;
    for (std::string line; std::getline(file, line);)
      {
        std::istringstream words(line);
        std::uintptr_t     begin, end;
        char               dash;
        if (words >> std::hex >> begin >> dash >> end && dash == '-')
          inside = begin <= wanted && wanted < end;
        else if (inside && line.rfind("VmFlags:", 0) == 0)
          return line + " ";
      }
    return {};
  }
} // namespace

TEST(LargeArrays, ask_for_large_pages)
{
  if (!std::ifstream("/sys/kernel/mm/transparent_hugepage/enabled"))
    GTEST_SKIP() << "This kernel has no large pages.";
  for (const std::size_t megabytes : {1, 8, 64})
    {
      std::vector<double> array(megabytes << 17);
      ask_for_large_pages(array.data(), array.size() * sizeof(double));
      EXPECT_EQ(flags_at(&array[array.size() / 2]).find(" hg ") !=
                  std::string::npos,
                megabytes > 1)
        << megabytes << " MB";
    }
}
