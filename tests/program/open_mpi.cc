// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "program/room.h"

TEST(OpenMpi, AsksNoXServerForGraphicsCards)
{
  unsetenv("HWLOC_COMPONENTS");
  set_up_open_mpi();
  EXPECT_STREQ(std::getenv("HWLOC_COMPONENTS"), "-gl");
}

TEST(OpenMpi, KeepsTheUsersOwnVariables)
{
  setenv("HWLOC_COMPONENTS", "-pci", 1);
  set_up_open_mpi();
  EXPECT_STREQ(std::getenv("HWLOC_COMPONENTS"), "-pci");
}
