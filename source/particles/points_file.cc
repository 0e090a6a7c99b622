// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/input_error.h>
#include <morula/particles/point_rows.h>
#include <morula/particles/points_file.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <map>

namespace Morula
{
  namespace
  {
    /** All ranks throw the problem of the first bad line, whoever read it. */
    void
    throw_first(const LineProblem &mine,
                const std::string &file,
                const MPI_Comm     comm)
    {
      const std::uint64_t first = Utilities::MPI::min(mine.line, comm);
      if (first == LineProblem::no_line)
        return;
      const unsigned int my_rank = Utilities::MPI::this_mpi_process(comm);
      const unsigned int rank    = Utilities::MPI::min(
        mine.line == first ? my_rank : numbers::invalid_unsigned_int, comm);
      const std::vector<std::string> text = Utilities::MPI::broadcast(
        comm,
        std::vector<std::string>{mine.value, mine.allowed, mine.remedy},
        rank);
      throw InputError("Tissue/Points file (" + file + ", line " +
                         std::to_string(first) + ")",
                       text[0],
                       text[1],
                       text[2]);
    }

    /** The header line and what it says. */
    struct Header
    {
      std::uint64_t             line       = 0; // its number, from 1
      std::uint64_t             data_begin = 0; // byte after it
      std::uint64_t             file_size  = 0;
      std::vector<unsigned int> columns; // see read_columns()
      LineProblem               problem;
    };

    template <int dim>
    Header
    read_header(std::ifstream &stream)
    {
      Header header;
      stream.seekg(0, std::ios::end);
      header.file_size =
        static_cast<std::uint64_t>(std::max<std::streamoff>(0, stream.tellg()));
      stream.seekg(0);
      for (std::string text; std::getline(stream, text);)
        {
          ++header.line;
          header.data_begin += text.size() + 1;
          if (header.line == 1 && text.rfind("\xEF\xBB\xBF", 0) == 0)
            text.erase(0, 3); // the byte order mark of spreadsheets
          if (is_remark(text))
            continue;
          header.columns = read_columns<dim>(text, header.problem);
          if (!header.problem.allowed.empty())
            header.problem.line = header.line;
          return header;
        }
      header.problem = {std::max<std::uint64_t>(header.line, 1),
                        "",
                        "a header line and one line per cell",
                        "The file is empty: give another one."};
      return header;
    }

    /** The lines that begin in this rank's equal share of the file's bytes. */
    template <int dim>
    PointRows<dim>
    read_share(std::ifstream &stream,
               const Header  &header,
               const double   default_volume,
               const MPI_Comm comm)
    {
      const std::uint64_t rank  = Utilities::MPI::this_mpi_process(comm);
      const std::uint64_t ranks = Utilities::MPI::n_mpi_processes(comm);
      const std::uint64_t bytes =
        std::max(header.file_size, header.data_begin) - header.data_begin;
      std::uint64_t       at  = header.data_begin + bytes * rank / ranks;
      const std::uint64_t end = header.data_begin + bytes * (rank + 1) / ranks;

      PointRows<dim> rows;
      std::string    text;
      stream.clear();
      stream.seekg(static_cast<std::streamoff>(at - 1));
      // the rest of the line before, at least its end
      if (!std::getline(stream, text))
        return rows;
      at += text.size();
      while (at < end && rows.problem.line == LineProblem::no_line &&
             std::getline(stream, text))
        {
          at += text.size() + 1;
          ++rows.n_lines;
          if (!is_remark(text))
            read_row(text, header.columns, default_volume, rows);
        }
      return rows;
    }

    /** Sum of @p mine over the lower ranks. */
    std::uint64_t
    sum_below(const std::uint64_t mine, const MPI_Comm comm)
    {
      std::uint64_t below = 0;
      const int     error =
        MPI_Exscan(&mine, &below, 1, MPI_UINT64_T, MPI_SUM, comm);
      AssertThrowMPI(error);
      return Utilities::MPI::this_mpi_process(comm) == 0 ? 0 : below;
    }

    /**
     * The first line that repeats the place of a line before it. Places are
     * spread over the ranks by their hash; @p rows has global line numbers.
     */
    template <int dim>
    LineProblem
    find_repeated(const PointRows<dim> &rows, const MPI_Comm comm)
    {
      using Place = std::pair<std::array<double, dim>, std::uint64_t>;
      std::map<unsigned int, std::vector<Place>> outgoing;
      const unsigned int n_ranks = Utilities::MPI::n_mpi_processes(comm);
      for (std::size_t i = 0; i < rows.positions.size(); ++i)
        {
          Place       place;
          std::size_t hash = 0;
          for (unsigned int d = 0; d < dim; ++d)
            {
              place.first[d] = rows.positions[i][d];
              hash = hash * 1000003 + std::hash<double>()(place.first[d]);
            }
          place.second = rows.lines[i];
          outgoing[(hash >> 8) % n_ranks].push_back(place);
        }
      std::vector<Place> places;
      for (const auto &from : Utilities::MPI::some_to_some(comm, outgoing))
        places.insert(places.end(), from.second.begin(), from.second.end());
      std::sort(places.begin(), places.end());

      LineProblem problem;
      for (std::size_t i = 1; i < places.size(); ++i)
        if (places[i].first == places[i - 1].first &&
            places[i].second < problem.line)
          problem = {places[i].second,
                     Patterns::Tools::to_string(places[i].first),
                     "one cell at each place, and line " +
                       std::to_string(places[i - 1].second) +
                       " has one there already",
                     "Drop one of the two cells."};
      return problem;
    }
  } // namespace

  template <int dim>
  Founders<dim>
  read_points(const std::string &file,
              const double       default_volume,
              const MPI_Comm     comm)
  {
    std::ifstream stream(file, std::ios::binary);
    if (Utilities::MPI::max(stream.good() ? 0 : 1, comm) != 0)
      throw InputError("Tissue/Points file",
                       file,
                       "a file that every process can read",
                       "Correct the name.");
    const Header header = read_header<dim>(stream);
    throw_first(header.problem, file, comm);

    PointRows<dim> rows = read_share<dim>(stream, header, default_volume, comm);
    const std::uint64_t lines_before =
      header.line + sum_below(rows.n_lines, comm);
    for (std::uint64_t &line : rows.lines)
      line += lines_before;
    if (rows.problem.line != LineProblem::no_line)
      rows.problem.line += lines_before;
    throw_first(rows.problem, file, comm);
    throw_first(find_repeated(rows, comm), file, comm);

    const std::uint64_t n_mine = rows.positions.size();
    const std::uint64_t n      = Utilities::MPI::sum(n_mine, comm);
    if (n == 0 || n >= std::numeric_limits<types::particle_index>::max())
      throw InputError("Tissue/Points file",
                       file,
                       "a file with 1 to 4e9 cells",
                       "It has " + std::to_string(n) + ".");
    Founders<dim> founders;
    founders.first_id =
      static_cast<types::particle_index>(sum_below(n_mine, comm));
    founders.n_global  = static_cast<types::particle_index>(n);
    founders.positions = std::move(rows.positions);
    founders.volumes   = std::move(rows.volumes);
    return founders;
  }

  template Founders<2>
  read_points<2>(const std::string &, const double, const MPI_Comm);
  template Founders<3>
  read_points<3>(const std::string &, const double, const MPI_Comm);
} // namespace Morula
