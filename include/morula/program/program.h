// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_program_program_h
#define morula_program_program_h

#include <morula/effects/catalogue.h>
#include <morula/scene/scene.h>

#include <mpi.h>

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

namespace Morula
{
  /** Runs the scene as `morula` does, from its snapshot if @p resume. */
  void
  simulate(const Scene &scene, const bool resume);

  /**
   * Seeds the tissue, makes all checks, and prints on rank 0 what the scene
   * will simulate: numbers of cells and boundary points, effects that are on
   * and off, the columns of a cell, the expected cells and memory, estimates of
   * unknowns and time, and the warnings. Simulates nothing and writes no file.
   * Collective.
   * @param json print it as a JSON object, with all keys as used
   * @throws InputError
   */
  void
  explain(const Scene   &scene,
          std::ostream  &out,
          const MPI_Comm comm,
          const bool     json = false);

  /**
   * The main() of Morula, and of programs that do other work with a scene. It
   * handles MPI, command line, --help, --version, --parameters, --explain and
   * --serve, and turns errors into messages and exit codes.
   */
  struct Program
  {
    /** Effects that scenes may name, besides the library's own. */
    Catalogue catalogue;

    /** The work to do with a scene that has been read and accepted. */
    std::function<void(const Scene &, const bool resume)> work = simulate;

    /** The only Dimension that @ref work can handle; 0 for any. */
    unsigned int dimension = 0;

    /** Whether @ref work can --resume. */
    bool resumes = true;

    /**
     * Runs the program. If a signal has stopped the run, the program ends by
     * that signal, as the sender expects: a shell then ends its loop.
     * @return the exit code: 0 for success, 1 for bad input (InputError), 2 for
     *         any other exception
     */
    int
    run(int argc, char *argv[]) const;

  private:
    int
    run_with_mpi(int argc, char *argv[], int &stop_signal) const;

    /** Runs the program with these words, without its name. */
    int
    run_words(const std::vector<std::string> &words, int &stop_signal) const;
  };
} // namespace Morula

#endif
