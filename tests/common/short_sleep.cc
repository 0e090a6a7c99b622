// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <time.h>

/**
 * Preloaded into the processes of the tests: a rank of MPI that waits for a
 * message asks for it again and again, with sched_yield() in between. Linux
 * returns from it at once, so the rank that has the answer, but no core, waits
 * for its time slice. With more ranks than cores a run took up to six times as
 * long. A short sleep leaves the core to the other rank.
 */
extern "C" int
sched_yield()
{
  const timespec time = {0, 20000}; // s, ns
  nanosleep(&time, nullptr);
  return 0;
}
