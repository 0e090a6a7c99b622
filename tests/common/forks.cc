// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/program/program.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

namespace
{
  using Words = std::vector<std::string>;

  /** The next words from standard input: their number, then each of them, all
   *  ended by a null byte. None at the end of the input. */
  Words
  next_words()
  {
    std::string number;
    if (!std::getline(std::cin, number, '\0'))
      return {};
    Words words(std::stoul(number));
    for (std::string &word : words)
      std::getline(std::cin, word, '\0');
    return words;
  }

  void
  redirect(const std::string &path, const int flags, const int descriptor)
  {
    const int file = open(path.c_str(), flags, 0644);
    if (file < 0 || dup2(file, descriptor) < 0)
      _exit(127);
    close(file);
  }
} // namespace

/**
 * Runs of the program for the tests in Python, common/forks.py: each is a fork
 * of this process, which has the libraries linked already. That takes most of
 * the time that Morula needs to start (more than 300,000 symbols of 200
 * libraries); MPI is initialized in the fork, which ends without the
 * destructors of the libraries, a third of what is left. A run is asked for by
 * its directory, the files for standard output and standard error, and the
 * words of the command line; printed are its process id at once, and at its end
 * the exit code, or minus the number of the signal, and its peak memory in kB.
 */
int
main()
{
  for (Words words = next_words(); !words.empty(); words = next_words())
    {
      const pid_t child = fork();
      if (child == 0)
        {
          if (chdir(words[0].c_str()) != 0)
            _exit(127);
          redirect("/dev/null", O_RDONLY, STDIN_FILENO);
          redirect(words[1], O_WRONLY | O_CREAT | O_APPEND, STDOUT_FILENO);
          redirect(words[2], O_WRONLY | O_CREAT | O_APPEND, STDERR_FILENO);
          std::vector<char *> arguments;
          for (auto word = words.begin() + 3; word != words.end(); ++word)
            arguments.push_back(word->data());
          arguments.push_back(nullptr);
          const int code =
            Morula::Program().run(arguments.size() - 1, arguments.data());
          std::cout.flush();
          std::fflush(nullptr);
          _exit(code); // not through the destructors of all libraries
        }
      std::cout << child << std::endl;
      int    status = 0;
      rusage usage{};
      wait4(child, &status, 0, &usage);
      std::cout << (WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status))
                << ' ' << usage.ru_maxrss << std::endl;
    }
}
