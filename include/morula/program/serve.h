// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_program_serve_h
#define morula_program_serve_h

#include <functional>
#include <string>
#include <vector>

namespace Morula
{
  /**
   * Does runs as standard input asks for them, one after the other, each in a
   * fork of this process. A fork has the libraries linked and MPI initialized
   * already, which is nearly all of the time that the program takes to start;
   * MPI on one rank needs no other process. It ends without finalizing MPI and
   * without the destructors of the libraries.
   *
   * A run is asked for by the number of words that follow, its working
   * directory, the files that get its standard output and standard error, the
   * file for what it cost (or nothing), and its command line, each ended by a
   * null byte. Printed are the run's process id at once, and at its end the
   * exit code, or minus the number of the signal that ended it, and its peak
   * memory in kB. The run leads a session of its own. The end of the input ends
   * this.
   * @param prepare is called in this process before each fork
   * @param run runs the program with a command line and returns the exit code
   */
  void
  serve(const std::function<void()>                                &prepare,
        const std::function<int(const std::vector<std::string> &)> &run);
} // namespace Morula

#endif
