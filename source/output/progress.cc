// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/progress.h>

#include <deal.II/base/mpi.h>

#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <vector>

namespace Morula
{
  using namespace dealii;

  namespace
  {
    template <typename... Values>
    std::string
    format(const char *pattern, const Values... values)
    {
      // Long enough for all patterns of this file.
      char text[256];
      std::snprintf(text, sizeof(text), pattern, values...);
      return text;
    }

    /** Width of a terminal in characters; 0 if unknown or no terminal. */
    unsigned int
    columns_of(const int descriptor)
    {
      winsize size{};
      return ioctl(descriptor, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
    }

    /**
     * Width of the terminal behind stdout; 0 if the output goes elsewhere. Open
     * MPI's mpirun gives its processes a terminal without a size, even where
     * mpirun itself writes into a file. Then the stdout of mpirun tells.
     */
    unsigned int
    terminal_columns()
    {
      const unsigned int columns = columns_of(STDOUT_FILENO);
      // Without a terminal the width is 0. With one of no size mpirun may be in
      // between.
      if (columns > 0 || isatty(STDOUT_FILENO) == 0)
        return columns;

      const std::string path = "/proc/" + std::to_string(getppid()) + "/fd/1";
      const int         descriptor = open(path.c_str(), O_WRONLY | O_NOCTTY);
      if (descriptor < 0)
        return 0;
      const unsigned int columns_of_parent = columns_of(descriptor);
      close(descriptor);
      return columns_of_parent;
    }

    /** A name and its value, padded so that the values align. */
    std::string
    summary_line(const char *name, const std::string &value)
    {
      return format("\n  %-16s", name) + value;
    }
  } // namespace

  std::string
  progress_line(const StepReport &report,
                const double      end_time,
                const double      seconds_left)
  {
    std::string line = format(
      "step %u: day %.6g of %.6g, dt %.3g, %llu cells, %u Newton iterations, "
      "%s",
      report.step,
      report.time,
      end_time,
      report.dt,
      static_cast<unsigned long long>(report.cells),
      report.newton_iterations,
      duration(report.wall_seconds).c_str());
    if (seconds_left > 0.)
      line += ", about " + duration(seconds_left) + " left";
    return line;
  }

  std::string
  progress_bar(const StepReport  &report,
               const double       start_time,
               const double       end_time,
               const double       seconds_left,
               const unsigned int width)
  {
    // The line has a bar, and behind it as many parts as the terminal's width
    // allows, the most important ones first. The bar gets what is left, within
    // bounds. Where not even a bar fits, the percentage stands alone, or
    // nothing.
    const double fraction =
      end_time > start_time ?
        std::clamp((report.time - start_time) / (end_time - start_time),
                   0.,
                   1.) :
        1.;

    // A shorter bar says nothing, a longer one no more.
    constexpr std::size_t smallest_bar = 10, largest_bar = 40;
    constexpr std::size_t brackets_and_space = 3;
    constexpr std::size_t with_bar = smallest_bar + brackets_and_space;

    // The most important part comes first.
    const std::vector<std::string> parts = {
      seconds_left >= 0. ? duration(seconds_left) + " left" : "",
      format("day %.4g of %.4g", report.time, end_time),
      format("%llu cells", static_cast<unsigned long long>(report.cells)),
      format("%u Newton", report.newton_iterations)};
    // Rounded down, so that 100 % means the end.
    std::string text = format("%3.0f %%", std::floor(100. * fraction));
    if (text.size() + with_bar >= width)
      return text.size() < width ? text : "";
    for (const std::string &part : parts)
      if (!part.empty() && text.size() + 2 + part.size() + with_bar < width)
        text += "  " + part;

    const std::size_t length =
      std::min(width - 1 - text.size() - brackets_and_space, largest_bar);
    const std::size_t filled = static_cast<std::size_t>(fraction * length);
    return '[' + std::string(filled, '#') + std::string(length - filled, '.') +
           "] " + text;
  }

  std::string
  summary_block(const FinalReport &summary)
  {
    // The three sections of the timings that took longest are named, with their
    // share of the wall time. What a scene does not have gives no line.
    std::vector<std::pair<std::string, double>> sections;
    for (const auto &section : summary.sections)
      sections.emplace_back(section.first, section.second.wall_seconds);
    std::stable_sort(sections.begin(),
                     sections.end(),
                     [](const auto &a, const auto &b) {
                       return a.second > b.second;
                     });
    constexpr std::size_t n_shown = 3;
    sections.resize(std::min(sections.size(), n_shown));

    std::string dearest;
    for (const auto &section : sections)
      dearest += (dearest.empty() ? "" : ", ") + section.first +
                 format(" %.0f %%",
                        summary.wall_seconds > 0. ?
                          100. * section.second / summary.wall_seconds :
                          0.);

    std::string text = summary.outcome;
    text += summary_line("day", format("%.6g", summary.time));
    text += summary_line(
      "cells", format("%llu", static_cast<unsigned long long>(summary.cells)));
    text +=
      summary_line("volume",
                   format("%.6g um^%u", summary.volume, summary.dimension));
    text += summary_line("steps",
                         format("%u, %u rejected",
                                summary.steps,
                                summary.rejected_steps));
    text += summary_line("wall time", duration(summary.wall_seconds));
    if (!dearest.empty())
      text += summary_line("spent mostly in", dearest);
    if (summary.error_in_time)
      text += summary_line("error in time",
                           format("about %.2g %% of growth and strain",
                                  100. * *summary.error_in_time));
    text += summary_line("files in", summary.directory);
    return text;
  }

  Progress::Progress(const std::string &log_path,
                     const bool         resume,
                     const double       start_time,
                     const double       end_time,
                     const MPI_Comm     comm)
    : start_time(start_time)
    , end_time(end_time)
    , is_root(Utilities::MPI::this_mpi_process(comm) == 0)
    , time_left(start_time, end_time)
    , log(log_path, resume, comm)
  {}

  void
  Progress::message(const std::string &text)
  {
    clear_bar();
    if (is_root)
      std::cout << text << std::endl;
    log.write(text);
  }

  void
  Progress::step(const StepReport &report)
  {
    time_left.add(report.time, report.wall_seconds);
    const double      seconds_left = time_left.seconds();
    const std::string line = progress_line(report, end_time, seconds_left);

    // Only rank 0 writes on the terminal. A terminal gets a bar that is written
    // over; a file gets a line a step.
    const unsigned int columns = is_root ? terminal_columns() : 0;
    if (columns > 0)
      {
        // "\033[K" clears what is left of a longer bar.
        std::cout
          << '\r'
          << progress_bar(report, start_time, end_time, seconds_left, columns)
          << "\033[K" << std::flush;
        bar_shown = true;
      }
    else if (is_root)
      std::cout << line << std::endl;
    log.write(line);
  }

  void
  Progress::finish(const FinalReport &summary)
  {
    if (bar_shown)
      std::cout << std::endl;
    bar_shown = false;
    message(summary_block(summary));
  }

  void
  Progress::fail(const std::string &text) noexcept
  {
    if (bar_shown)
      std::cout << std::endl;
    bar_shown = false;
    log.write_if_possible(text);
    // Nothing is thrown here: an error is being reported.
  }

  void
  Progress::clear_bar()
  {
    if (bar_shown)
      std::cout << "\r\033[K" << std::flush;
    bar_shown = false;
  }
} // namespace Morula
