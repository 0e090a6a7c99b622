// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/program/program.h>

int
main(int argc, char *argv[])
{
  return Morula::Program().run(argc, argv);
}
