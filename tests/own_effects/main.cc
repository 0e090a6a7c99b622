// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// A program with effects of its own.

#include <morula/program/program.h>

#include "own_effects.h"

int
main(int argc, char *argv[])
{
  Morula::Program program;
  Own::add_effects(program.catalogue);
  return program.run(argc, argv);
}
