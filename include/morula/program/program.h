// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_program_program_h
#define morula_program_program_h

#include <morula/scene/catalogue.h>
#include <morula/scene/scene.h>

#include <functional>

namespace Morula
{
  /** Runs the scene, from its snapshot if @p resume. What `morula` does. */
  void
  simulate(const Scene &scene, const bool resume);

  /**
   * The main() of Morula, and of programs that do something else with a scene:
   * MPI, command line, --help, --version, --parameters, --explain, and errors
   * as messages and exit codes.
   */
  struct Program
  {
    /** Effects that scenes may name besides the library's own. */
    Catalogue catalogue;

    /** What is done with a scene that has been read and accepted. */
    std::function<void(const Scene &, const bool resume)> work = simulate;

    /** The only value of Dimension that @ref work can do with; 0: any. */
    unsigned int dimension = 0;

    /** Whether @ref work can --resume. */
    bool resumes = true;

    /**
     * Where a signal has stopped the run, ends the program by that signal, as
     * who has sent it expects: a shell then ends its loop.
     * @return the exit code: 0 for success, 1 for bad input (InputError), 2 for
     *         any other exception
     */
    int
    run(int argc, char *argv[]) const;

  private:
    int
    run_with_mpi(int argc, char *argv[], int &stop_signal) const;
  };
} // namespace Morula

#endif
