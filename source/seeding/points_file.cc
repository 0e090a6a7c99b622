// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/instantiate.h>
#include <morula/seeding/outliers.h>
#include <morula/seeding/points_file.h>
#include <morula/seeding/points_file_rows.h>
#include <morula/seeding/points_file_words.h>

#include <deal.II/base/mpi.h>

#include <boost/algorithm/string.hpp>
#include <boost/serialization/array.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

namespace Morula
{
  namespace
  {
    /** Throws on all ranks, with the problem of the first bad line of any rank.
     */
    void
    throw_first(const LineProblem &mine,
                const std::string &file,
                const MPI_Comm     comm)
    {
      // All ranks throw the same error or none does. The lowest line wins, as
      // one rank would have found it.
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
      throw InputError(TissueKeys::points_file + " (" + file + ", line " +
                         std::to_string(first) + ")",
                       text[0],
                       text[1],
                       text[2]);
    }

    /** The header line and its meaning. */
    struct Header
    {
      std::uint64_t            line       = 0; // its number, from 1
      std::uint64_t            data_begin = 0; // byte after it
      std::uint64_t            file_size  = 0;
      PointsFormat             format;
      std::vector<std::string> further; // header lines below the first one
      LineProblem              problem;
    };

    /** Whether lines end with a carriage return alone, in the file's beginning.
     */
    char
    find_line_end(const std::string &beginning)
    {
      // The first line end decides for the whole file: some old programs write
      // a carriage return alone.
      const auto end = beginning.find_first_of("\r\n");
      return end == std::string::npos || end + 1 >= beginning.size() ||
                 beginning[end] == '\n' || beginning[end + 1] == '\n' ?
               '\n' :
               '\r';
    }

    /** Why a file that begins so is no text; empty if it is one. */
    std::string
    why_no_text(const std::string &beginning)
    {
      // The marks are the first bytes of UTF-16, and of ZIP, in which
      // spreadsheets are packed.
      for (const std::string mark : {"\xFF\xFE", "\xFE\xFF"})
        if (boost::starts_with(beginning, mark))
          return "It is written in UTF-16: save it as CSV in UTF-8.";
      if (boost::starts_with(beginning, "PK\x03\x04"))
        return "It is a spreadsheet or an archive: export the table as CSV.";
      if (std::any_of(beginning.begin(), beginning.end(), [](const char c) {
            return static_cast<unsigned char>(c) < 0x20 &&
                   std::string("\t\n\v\f\r").find(c) == std::string::npos;
          }))
        return "It holds bytes that no text has, as a file in UTF-16 or a "
               "compressed one does: save it as CSV in UTF-8.";
      return "";
    }

    /** The beginning of a file, as far as its kind shows there. */
    std::string
    beginning_of(std::ifstream &stream)
    {
      // 64 kB show the kind of a file, whatever its length.
      std::string text(std::size_t(1) << 16, ' ');
      stream.seekg(0);
      stream.read(text.data(), static_cast<std::streamsize>(text.size()));
      text.resize(static_cast<std::size_t>(stream.gcount()));
      stream.clear();
      stream.seekg(0);
      return text;
    }

    /** Reads until below the header: the line with names, and further ones of
     *  words. */
    template <int dim>
    Header
    read_header(std::ifstream &stream)
    {
      Header header;
      // Every rank reads the header, so that all know the columns without a
      // message. The first line that is neither blank nor a comment names them.
      // Lines of words below it, such as units, belong to the header, too,
      // until one could be a cell. What is counted on the way is where the rows
      // begin, in bytes and in lines, since ranks share the bytes and messages
      // name lines.
      stream.seekg(0, std::ios::end);
      header.file_size =
        static_cast<std::uint64_t>(std::max<std::streamoff>(0, stream.tellg()));
      const std::string beginning = beginning_of(stream);
      if (const std::string why = why_no_text(beginning); !why.empty())
        {
          header.problem = {1, "", "a table as text", why};
          return header;
        }
      const char line_end = find_line_end(beginning);
      bool       found    = false;
      for (std::string text; std::getline(stream, text, line_end);)
        {
          if (header.line == 0 && text.rfind("\xEF\xBB\xBF", 0) == 0)
            {
              // Spreadsheets write a byte order mark before UTF-8.
              text.erase(0, 3);
              header.data_begin += 3;
            }
          const bool skipped =
            is_blank_or_comment(text) ||
            // By this line a spreadsheet is told the separator.
            (!found && boost::istarts_with(text, "sep="));
          if (found && !skipped)
            {
              if (!is_further_header(text, header.format, header.problem))
                break;
              header.further.push_back(text);
            }
          ++header.line;
          header.data_begin += text.size() + 1;
          if (!found && !skipped)
            {
              found                  = true;
              header.format          = read_columns<dim>(text, header.problem);
              header.format.line_end = line_end;
            }
          if (!header.problem.allowed.empty())
            {
              header.problem.line = header.line;
              return header;
            }
        }
      if (!found)
        header.problem = {std::max<std::uint64_t>(header.line, 1),
                          "",
                          "a header line and one line per cell",
                          "The file is empty: give another one."};
      return header;
    }

    /** Reads the lines that begin in this rank's share of the file's bytes. All
     *  ranks have equal shares. */
    template <int dim>
    PointsFileRows<dim>
    read_share(std::ifstream                  &stream,
               const Header                   &header,
               const double                    default_volume,
               const std::vector<std::string> &types,
               const MPI_Comm                  comm)
    {
      const std::uint64_t rank  = Utilities::MPI::this_mpi_process(comm);
      const std::uint64_t ranks = Utilities::MPI::n_mpi_processes(comm);
      const std::uint64_t bytes =
        std::max(header.file_size, header.data_begin) - header.data_begin;
      // Ranks share the bytes, not the lines, whose places nobody knows. A line
      // belongs to the rank in whose share it begins. So each rank starts one
      // byte before its share and skips what is left of the line there, which
      // another rank reads to its end.
      std::uint64_t       at  = header.data_begin + bytes * rank / ranks;
      const std::uint64_t end = header.data_begin + bytes * (rank + 1) / ranks;

      PointsFileRows<dim> rows;
      std::string         text;
      stream.clear();
      stream.seekg(static_cast<std::streamoff>(at - 1));
      const char line_end = header.format.line_end;
      // This skips the rest of the line before, at least its end.
      if (!std::getline(stream, text, line_end))
        return rows;
      at += text.size();
      while (at < end && rows.problem.line == LineProblem::no_line &&
             std::getline(stream, text, line_end))
        {
          at += text.size() + 1;
          ++rows.n_lines;
          if (!is_blank_or_comment(text))
            read_row(text, header.format, default_volume, types, rows);
        }
      return rows;
    }

    double
    sum_of(const std::vector<double> &values)
    {
      return std::accumulate(values.begin(), values.end(), 0.);
    }

    /** Sum of @p mine over the lower ranks. */
    std::uint64_t
    sum_below(const std::uint64_t mine, const MPI_Comm comm)
    {
      std::uint64_t below = 0;
      const int     error =
        MPI_Exscan(&mine, &below, 1, MPI_UINT64_T, MPI_SUM, comm);
      AssertThrowMPI(error);
      // MPI_Exscan() leaves it undefined on rank 0.
      return Utilities::MPI::this_mpi_process(comm) == 0 ? 0 : below;
    }

    /** Refuses the cells of several moments, which stand among each other. */
    template <int dim>
    void
    check_moment(const PointsFileRows<dim> &rows,
                 const std::string         &file,
                 const MPI_Comm             comm)
    {
      const double first = Utilities::MPI::min(rows.first_time, comm);
      const double last  = Utilities::MPI::max(rows.last_time, comm);
      if (first < last)
        throw InputError(TissueKeys::points_file,
                         file,
                         "the cells of one moment",
                         "The column 'frame', 't' or 'time' goes from " +
                           as_text(first) + " to " + as_text(last) +
                           ": keep the rows of one moment.");
    }

    /** Cells nearer than this fraction of their length coincide. Division could
     *  not tell their regions apart: see daughter_distances(). */
    constexpr double contact = 1e-3;

    /** A cell of the file in a bin of space. */
    template <int dim>
    struct BinEntry
    {
      std::array<double, dim> bin, position;
      std::uint64_t           line;
      double                  length; // V^(1/dim), µm

      template <class Archive>
      void
      serialize(Archive &archive, const unsigned int)
      {
        archive & bin & position & line & length;
      }
    };

    /**
     * This rank's bins of space with their cells, which are sorted by line. The
     * hash of a bin decides its rank. A cell near the rim of a bin is also in
     * the neighbouring bins.
     */
    template <int dim>
    std::vector<BinEntry<dim>>
    bins(const PointsFileRows<dim> &rows, const MPI_Comm comm)
    {
      double longest = 0.;
      for (const double volume : rows.volumes)
        longest = std::max(longest, std::pow(volume, 1. / dim));
      // Cells nearer than `reach` may coincide. Bins are wider than that, so a
      // cell has to be looked for in its own bin only if each cell also stands
      // in all bins that its reach touches: at most one for each corner of the
      // box around it.
      const double reach = contact * Utilities::MPI::max(longest, comm);
      const double width = 4. * reach;

      std::map<unsigned int, std::vector<BinEntry<dim>>> outgoing;
      const unsigned int n_ranks = Utilities::MPI::n_mpi_processes(comm);
      for (std::size_t i = 0; i < rows.positions.size(); ++i)
        {
          std::set<std::array<double, dim>> around;
          for (unsigned int corner = 0; corner < (1u << dim); ++corner)
            {
              std::array<double, dim> bin;
              for (unsigned int d = 0; d < dim; ++d)
                bin[d] = std::floor((rows.positions[i][d] +
                                     ((corner >> d) & 1 ? reach : -reach)) /
                                    width);
              around.insert(bin);
            }
          BinEntry<dim> entry;
          entry.line   = rows.lines[i];
          entry.length = std::pow(rows.volumes[i], 1. / dim);
          for (unsigned int d = 0; d < dim; ++d)
            entry.position[d] = rows.positions[i][d];
          for (const auto &bin : around)
            {
              std::size_t hash = 0;
              for (const double index : bin)
                // Any hash will do that spreads neighbouring bins over the
                // ranks.
                hash = hash * 1000003 + std::hash<double>()(index);
              entry.bin = bin;
              outgoing[(hash >> 8) % n_ranks].push_back(entry);
            }
        }
      std::vector<BinEntry<dim>> mine;
      for (const auto &from : Utilities::MPI::some_to_some(comm, outgoing))
        mine.insert(mine.end(), from.second.begin(), from.second.end());
      // Sorted by bin, cells that may coincide stand together; by line, the
      // first of them comes first.
      std::sort(mine.begin(), mine.end(), [](const auto &a, const auto &b) {
        return std::tie(a.bin, a.line) < std::tie(b.bin, b.line);
      });
      return mine;
    }

    /**
     * The first line whose cell coincides with that of a line before it.
     * @param rows rows with global line numbers
     */
    template <int dim>
    LineProblem
    find_repeated(const PointsFileRows<dim> &rows, const MPI_Comm comm)
    {
      const std::vector<BinEntry<dim>> entries = bins(rows, comm);
      const auto coincide = [](const auto &a, const auto &b) {
        double square = 0.;
        for (unsigned int d = 0; d < dim; ++d)
          square += Utilities::fixed_power<2>(a.position[d] - b.position[d]);
        return std::sqrt(square) < contact * std::min(a.length, b.length);
      };
      LineProblem problem;
      for (std::size_t begin = 0, i = 0; i < entries.size(); ++i)
        {
          // One pass over the bins: each entry is compared with those before it
          // in its bin.
          if (entries[i].bin != entries[begin].bin)
            begin = i;
          if (entries[i].line >= problem.line)
            continue;
          for (std::size_t k = begin; k < i; ++k)
            if (coincide(entries[k], entries[i]))
              {
                problem = {entries[i].line,
                           Patterns::Tools::to_string(entries[i].position),
                           "one cell at each place, in um, and line " +
                             std::to_string(entries[k].line) +
                             " has one there already, nearer than 1e-3 of a "
                             "cell's length",
                           "Drop one of the two cells. If all lie so near, "
                           "scale the file to um."};
                break;
              }
        }
      return problem;
    }
  } // namespace

  template <int dim>
  Founders<dim>
  read_points(const std::string        &file,
              const double              default_volume,
              const MPI_Comm            comm,
              const SeedingLimits<dim> &limits)
  {
    // Every rank opens the file and reads the header, then its own share of the
    // rows. Numbers of lines are local at first, and become those of the file
    // once all ranks know how many lines the others have. Then come the tests,
    // the cheap ones first; each throws on all ranks together. What needs
    // memory in proportion to the tissue comes behind the test of memory. At
    // last the rows become founders, whose ids follow the order of the file.
    std::ifstream stream(file, std::ios::binary);
    if (Utilities::MPI::max(stream.good() ? 0 : 1, comm) != 0)
      throw InputError(TissueKeys::points_file,
                       file,
                       "a file that every process can read",
                       "Correct the name.");
    const Header header = read_header<dim>(stream);
    throw_first(header.problem, file, comm);

    // Problems of rows come before those of the file as a whole.
    PointsFileRows<dim> rows =
      read_share<dim>(stream, header, default_volume, limits.types, comm);
    const std::uint64_t lines_before =
      header.line + sum_below(rows.n_lines, comm);
    for (std::uint64_t &line : rows.lines)
      line += lines_before;
    if (rows.problem.line != LineProblem::no_line)
      rows.problem.line += lines_before;
    throw_first(rows.problem, file, comm);
    const std::uint64_t n_mine = rows.positions.size();
    const std::uint64_t n      = Utilities::MPI::sum(n_mine, comm);
    check_moment(rows, file, comm);
    throw_first(find_row_beyond_limits(rows, limits), file, comm);
    throw_first(find_outlier(rows, limits.extent, n, comm), file, comm);
    if (limits.check_memory && n > 0)
      limits.check_memory(bounding_box(rows, comm),
                          n,
                          Utilities::MPI::sum(sum_of(rows.volumes), comm));
    throw_first(find_repeated(rows, comm), file, comm);
    if (n == 0 || n >= std::numeric_limits<types::particle_index>::max())
      throw InputError(TissueKeys::points_file,
                       file,
                       "a file with 1 to 4e9 cells",
                       "It has " + std::to_string(n) + ".");
    Founders<dim> founders;
    founders.first_id =
      static_cast<types::particle_index>(sum_below(n_mine, comm));
    founders.n_global    = static_cast<types::particle_index>(n);
    founders.positions   = std::move(rows.positions);
    founders.volumes     = std::move(rows.volumes);
    founders.generations = std::move(rows.generations);
    founders.phases      = std::move(rows.phases);
    founders.types       = std::move(rows.types);
    return founders;
  }

  template <int dim>
  void
  review_points_file(const std::string &file, Review &review)
  {
    std::ifstream stream(file, std::ios::binary);
    const Header  header = read_header<dim>(stream);
    // Names that are not known may be misspelt, and a line of words may be a
    // cell with a fault: neither is an error, both are worth a warning.
    if (!header.format.skipped.empty())
      review.warn(
        TissueKeys::points_file,
        file,
        "its columns '" + boost::join(header.format.skipped, "', '") +
          "' say nothing about cells here and are skipped. Read are '" +
          boost::join(header.format.read, "', '") + "'.",
        "Columns that count are x, y, z, volume, generation, phase "
        "and type: correct the name of one that is misspelt.");
    if (!header.further.empty())
      review.warn(TissueKeys::points_file,
                  file,
                  "its line '" +
                    boost::trim_copy(
                      PointsFileWords::in_utf8(header.further.back())) +
                    "' is taken for a line of the header, and skipped" +
                    (header.further.size() == 1 ?
                       "." :
                       ", as " + std::to_string(header.further.size() - 1) +
                         " before it."),
                  "If it is a cell, correct its coordinates.");
  }

  MORULA_INSTANTIATE(review_points_file);
  MORULA_INSTANTIATE(read_points);
} // namespace Morula
