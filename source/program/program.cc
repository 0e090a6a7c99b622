// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/input_error.h>
#include <morula/output/directory.h>
#include <morula/program/command_line.h>
#include <morula/program/program.h>
#include <morula/program/ranks.h>
#include <morula/scene/checks.h>
#include <morula/simulation/simulation.h>

#include <deal.II/base/exceptions.h>
#include <deal.II/base/mpi.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <new>
#include <sstream>

#ifdef __GLIBC__
#  include <malloc.h>
#endif

namespace Morula
{
  namespace
  {
    /**
     * Gives large arrays a memory mapping of their own, which returns to the
     * system when they are freed: those of 2 MB and more on one rank, and on
     * several what is a rank's share of that. glibc does so by default, from
     * 128 kB on at first, but SuperLU_DIST, which Trilinos may link, switches
     * it off for the whole process when it is loaded. The holes that such
     * arrays then leave in the heap cost 0.6 GB for a million cells
     * (doc/performance.md, Numbers of cells).
     */
    void
    map_large_arrays()
    {
#ifdef __GLIBC__
      const unsigned int n_ranks =
        Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
      mallopt(M_MMAP_MAX, 1 << 16);
      mallopt(M_MMAP_THRESHOLD, std::max((1u << 21) / n_ranks, 1u << 16));
#endif
    }

    /** Does once what libraries do on their first use, in a step of small
     *  scenes, so that no fork need do it again. */
    void
    warm_up(const Catalogue &catalogue, const unsigned int dimension)
    {
      std::string place =
        (std::filesystem::temp_directory_path() / "morula-XXXXXX").string();
      if (mkdtemp(place.data()) == nullptr)
        return;                   // then forks are slower
      std::ostringstream    said; // standard output is for those who ask
      std::streambuf *const out = std::cout.rdbuf(said.rdbuf());
      for (const unsigned int dim : {2, 3})
        if (dimension == 0 || dim == dimension)
          try
            {
              Scene scene(catalogue);
              // The scene is small, but goes through seeding, cell cycle,
              // solver and output, whose libraries have work to do on their
              // first use. A program for one dimension warms up only that one.
              scene.dimension                       = dim;
              scene.keys<CellCycleParameters>().law = "cell cycle";
              scene.tissue.radius                   = 40.;
              scene.time.end_time                   = 0.05;
              scene.output.formats   = std::vector<std::string>{"csv"};
              scene.output_directory = place + "/" + std::to_string(dim);
              scene.check();
              simulate(scene, false);
            }
          catch (const std::exception &)
            {} // then forks are slower
      std::cout.rdbuf(out);
      std::error_code error;
      std::filesystem::remove_all(place, error);
    }

    using Words = std::vector<std::string>;

    /** What a request has before the command line. */
    enum Place : unsigned int
    {
      directory,
      output,
      errors,
      cost,
      n_places
    };

    /** The next request from standard input; nothing at the end. */
    Words
    next_request()
    {
      // First stands the number of words, since words may be empty. A request
      // that ends too early is taken for the end of the input.
      std::string number;
      if (!std::getline(std::cin, number, '\0'))
        return {};
      Words words(std::strtoul(number.c_str(), nullptr, 10));
      for (std::string &word : words)
        std::getline(std::cin, word, '\0');
      return std::cin && words.size() >= n_places ? words : Words();
    }

    /** Lets a descriptor of this process mean a file. */
    void
    redirect(const std::string &path, const int flags, const int descriptor)
    {
      const int file = open(path.c_str(), flags, 0644);
      if (file < 0 || dup2(file, descriptor) < 0)
        _exit(127);
      close(file);
    }

    /** What the fork does: it never returns. */
    [[noreturn]] void
    do_run(const Words                                    &request,
           const std::function<int(const Words &command)> &run)
    {
      // The session lets whoever asked end the run with all that it starts.
      // What the process has open is replaced before the run says its first
      // word. 127 is what a shell returns for a command that it cannot start.
      // The fork ends by _exit(): finalizing MPI or destroying static objects
      // would end what belongs to the parent.
      setsid();
      if (chdir(request[directory].c_str()) != 0)
        _exit(127);
      constexpr int flags = O_WRONLY | O_CREAT | O_APPEND;
      redirect("/dev/null", O_RDONLY, STDIN_FILENO);
      redirect(request[output], flags, STDOUT_FILENO);
      redirect(request[errors], flags, STDERR_FILENO);
      const int code = run({request.begin() + n_places, request.end()});
      std::cout.flush();
      std::fflush(nullptr);
      _exit(code);
    }

    /**
     * Does runs as standard input asks for them, one after the other, each in a
     * fork of this process. A fork has the libraries linked and MPI initialized
     * already, which is nearly all of the time that the program takes to start;
     * MPI on one rank needs no other process. It ends without finalizing MPI
     * and without the destructors of the libraries.
     *
     * A run is asked for by the number of words that follow, its working
     * directory, the files that get its standard output and standard error, the
     * file for what it cost (or nothing), and its command line, each ended by a
     * null byte. Printed are the run's process id at once, and at its end the
     * exit code, or minus the number of the signal that ended it, and its peak
     * memory in kB. The run leads a session of its own. The end of the input
     * ends this.
     * @param prepare is called in this process before each fork
     * @param run runs the program with a command line and returns the exit code
     */
    void
    serve(const std::function<void()>                                &prepare,
          const std::function<int(const std::vector<std::string> &)> &run)
    {
      for (Words request = next_request(); !request.empty();
           request       = next_request())
        {
          // The number of the process is printed and flushed at once, so that
          // the run can be ended while it works. Its end is waited for here:
          // runs come one after the other, and wait4() tells the peak memory of
          // this one alone. Exit code and memory are printed last, which says
          // that all files are complete.
          const auto begin = std::chrono::steady_clock::now();
          prepare();
          const pid_t child = fork();
          if (child == 0)
            do_run(request, run);
          std::cout << child << std::endl;
          int    status = 0;
          rusage usage{};
          wait4(child, &status, 0, &usage);
          const int code =
            WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
          const std::chrono::duration<double> seconds =
            std::chrono::steady_clock::now() - begin;
          if (!request[cost].empty())
            std::ofstream(request[cost])
              << "{\"exit\": " << code
              << ", \"process_seconds\": " << seconds.count()
              << ", \"processor_seconds\": "
              << usage.ru_utime.tv_sec + usage.ru_stime.tv_sec +
                   1e-6 * (usage.ru_utime.tv_usec + usage.ru_stime.tv_usec)
              << ", \"peak_bytes\": " << 1024 * usage.ru_maxrss << "}\n";
          std::cout << code << ' ' << usage.ru_maxrss << std::endl;
        }
    }

    /** Prints help, version or keys if the command line asks for them.
     *  @return whether it does */
    bool
    print_information(const CommandLine &command, const Catalogue &catalogue)
    {
      if (!command.help && !command.version && !command.parameters)
        return false;
      // All ranks make the text, since each of them must learn of a scene that
      // is refused. Only the first one prints it.
      std::ostringstream text;
      if (command.help)
        print_help(text, command);
      else if (command.version)
        print_version(text);
      else
        print_parameters(text, command, catalogue);
      if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
        std::cout << text.str();
      return true;
    }

    /** Checks a scene, and explains or runs it as the command line asks. Sets
     *  @p resume_hint once the scene is accepted. */
    void
    check_and_run(const CommandLine &command,
                  const Program     &program,
                  const Scene       &scene,
                  std::string       &resume_hint)
    {
      // The keys come first, since that costs nothing. --explain makes the
      // further checks by itself. A run is tested for memory before cells are
      // placed, and only a run that is accepted can have a snapshot to go on
      // from.
      scene.check();
      if (program.dimension != 0 && scene.dimension != program.dimension)
        throw InputError("Dimension",
                         std::to_string(scene.dimension),
                         std::to_string(program.dimension),
                         "This program knows no other dimension.");
      if (command.explain)
        return explain(scene, std::cout, MPI_COMM_WORLD, command.json);
      check_memory(scene, initial_size(scene), MPI_COMM_WORLD);
      if (program.resumes)
        resume_hint = "If there is a snapshot.h5 in '" +
                      scene.output_directory + "', 'morula " +
                      command.scene_file + " ... --resume' goes on from there.";
      program.work(scene, command.resume);
    }

    /** Does what the command line asks for. */
    void
    execute(const CommandLine &command,
            const Program     &program,
            std::string       &resume_hint)
    {
      if (print_information(command, program.catalogue))
        return;
      if (command.resume && !program.resumes)
        throw InputError(
          "This program makes several runs, which --resume cannot "
          "go on with: leave it out.");

      Scene scene =
        Scene::read(command.scene_file, command.overrides, program.catalogue);
      scene.replace      = command.replace;
      scene.command_line = "morula " + command.text;
      // An error that is found after the reading gets the file and the line of
      // its key here, in one place. What the reading itself refuses has them
      // already.
      try
        {
          check_and_run(command, program, scene, resume_hint);
        }
      catch (const InputError &error)
        {
          throw InputError(scene.located(error.what()));
        }
    }
  } // namespace


  void
  simulate(const Scene &scene, const bool resume)
  {
    // RunFiles checks this again when it locks the directory. Here the check
    // comes before the work of placing cells.
    on_root(MPI_COMM_WORLD, [&]() {
      DirectoryLock::check_free(scene.output_directory);
      if (!resume)
        check_replaceable(scene.output_directory, scene.file, scene.replace);
    });
    if (scene.dimension == 2)
      Simulation<2>(scene, MPI_COMM_WORLD, resume).run();
    else
      Simulation<3>(scene, MPI_COMM_WORLD, resume).run();
  }


  int
  Program::run(int argc, char *argv[]) const
  {
    // A tool is another program, and has nothing to do with MPI.
    if (run_tool(argv))
      return 1;
    // MPI is finalized as run_with_mpi() returns. Raised earlier, the signal
    // would end the process before that.
    int       stop_signal = 0;
    const int exit_code   = run_with_mpi(argc, argv, stop_signal);
    if (stop_signal != 0)
      std::raise(stop_signal);
    return exit_code;
  }


  int
  Program::run_with_mpi(int argc, char *argv[], int &stop_signal) const
  {
    // The order matters: Open MPI reads its environment in MPI_Init, which is
    // in the constructor of mpi, and the share of a rank in map_large_arrays()
    // needs MPI. deal.II must throw instead of abort, so that an error of one
    // rank can end all of them. One thread a rank is asked for: the ranks share
    // the cores. PETSc would handle SIGHUP even where nohup lets it be ignored.
    set_up_open_mpi();
    // Libraries get the program's name only: PETSc would complain on the
    // standard output about every option that it does not know.
    char            *name[]    = {argv[0], nullptr};
    char           **only_name = name;
    int              n_words   = 1;
    struct sigaction hangup{};
    sigaction(SIGHUP, nullptr, &hangup);
    Utilities::MPI::MPI_InitFinalize mpi(n_words, only_name, 1);
    sigaction(SIGHUP, &hangup, nullptr);
    map_large_arrays();
    deal_II_exceptions::disable_abort_on_exception();
    deal_II_exceptions::suppress_stacktrace_in_exceptions();

    const std::vector<std::string> words(argv + 1, argv + argc);
    if (words != std::vector<std::string>{"--serve"} ||
        Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1)
      return run_words(words, stop_signal);
    // Serving is for one rank: forks of several would share the connections
    // between them.
    unsigned int n_asked = 0;
    serve(
      [&]() {
        // A single run does not pay for it: a start of the program is as quick.
        // Who asks for a third run will ask for more.
        if (++n_asked == 3)
          warm_up(catalogue, dimension);
      },
      [this](const std::vector<std::string> &command) {
        int       signal = 0;
        const int code   = run_words(command, signal);
        if (signal != 0)
          std::raise(signal);
        return code;
      });
    return 0;
  }


  int
  Program::run_words(const std::vector<std::string> &words,
                     int                            &stop_signal) const
  {
    // Each kind of exception has its exit code and message. The kinds stand
    // from the special to the general, as the first that fits catches: input
    // that is refused, a signal that has stopped the run after a snapshot, lack
    // of memory, and the rest. Every rank calls end_all_ranks(), which is
    // collective. The hint is empty until the scene is accepted: before that
    // there is nothing to go on from.
    std::string resume_hint, message;
    int         exit_code = 2;
    try
      {
        const CommandLine command = CommandLine::parse(words);
        if (command.serve)
          throw InputError("--serve takes no other argument and one rank: it "
                           "reads from standard input what to run.");
        execute(command, *this, resume_hint);
        return 0;
      }
    catch (const InputError &error)
      {
        exit_code = 1;
        message   = error.what();
      }
    catch (const StoppedBySignal &stop)
      {
        stop_signal = stop.signal;
        message     = std::string(stop.what()) + '\n' + resume_hint;
      }
    catch (const std::bad_alloc &)
      {
        message = "The run failed: out of memory. " + resume_hint;
      }
    catch (const std::exception &error)
      {
        message =
          std::string("The run failed: ") + error.what() + "\n" + resume_hint;
      }
    catch (...)
      {
        message = "The run failed for an unknown reason. " + resume_hint;
      }
    return end_all_ranks(exit_code, message, MPI_COMM_WORLD);
  }
} // namespace Morula
