// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/program/serve.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>

namespace Morula
{
  namespace
  {
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
  } // namespace


  void
  serve(const std::function<void()>                                &prepare,
        const std::function<int(const std::vector<std::string> &)> &run)
  {
    for (Words request = next_request(); !request.empty();
         request       = next_request())
      {
        // The number of the process is printed and flushed at once, so that the
        // run can be ended while it works. Its end is waited for here: runs
        // come one after the other, and wait4() tells the peak memory of this
        // one alone. Exit code and memory are printed last, which says that all
        // files are complete.
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
            << ", \"peak_bytes\": " << 1024 * usage.ru_maxrss << "}\n";
        std::cout << code << ' ' << usage.ru_maxrss << std::endl;
      }
  }
} // namespace Morula
