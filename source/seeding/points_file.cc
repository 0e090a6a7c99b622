// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/input_error.h>
#include <morula/base/instantiate.h>
#include <morula/base/near_tree.h>
#include <morula/seeding/seeding.h>

#include <deal.II/base/mpi.templates.h>
#include <deal.II/base/patterns.h>

#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <numeric>
#include <optional>

namespace Morula
{
  namespace
  {
    /** Cells nearer than this fraction of their length coincide. Division could
     *  not tell their regions apart: see daughter_distances(). */
    constexpr double contact = 1e-3;

    /** What columns mean: the places of their names in this list. */
    const std::vector<std::string> column_names = {
      "x", "y", "z", "volume", "generation", "phase", "type"};
    constexpr unsigned int volume = 3, generation = 4, phase = 5, type = 6,
                           skipped = 7, moment = 8, n_meanings = 9;

    /** The lines of a points file, one after the other. */
    class Lines
    {
    public:
      explicit Lines(const std::string &file)
        : file(file)
        , stream(file, std::ios::binary)
      {}

      /** Goes to the next line that is neither blank nor a remark. Returns
       *  false at the end. */
      bool
      next()
      {
        while (std::getline(stream, text))
          {
            ++number;
            if (number == 1 && boost::starts_with(text, "\xEF\xBB\xBF"))
              text.erase(0, 3); // spreadsheets mark UTF-8 so
            boost::trim(text);
            if (text.empty() || text[0] == '#')
              continue;
            boost::split(entries, text, boost::is_any_of(","));
            for (std::string &entry : entries)
              boost::trim(entry);
            return true;
          }
        return false;
      }

      /** @param column counted from 1; 0: the line is wrong as a whole */
      [[noreturn]] void
      refuse(const std::size_t  column,
             const std::string &value,
             const std::string &allowed,
             const std::string &remedy) const
      {
        refuse_line(file, number, column, value, allowed, remedy);
      }

      /** As refuse(), of any line. */
      [[noreturn]] static void
      refuse_line(const std::string  &file,
                  const std::uint64_t line,
                  const std::size_t   column,
                  const std::string  &value,
                  const std::string  &allowed,
                  const std::string  &remedy)
      {
        throw InputError(TissueKeys::points_file + " (" + file + ", line " +
                           std::to_string(line) +
                           (column > 0 ? ", column " + std::to_string(column) :
                                         "") +
                           ")",
                         value,
                         allowed,
                         remedy);
      }

      std::string              text;
      std::vector<std::string> entries;
      std::uint64_t            number = 0; // from 1

    private:
      const std::string file;
      std::ifstream     stream;
    };

    /** The finite number that a word is. */
    std::optional<double>
    number(const std::string &word)
    {
      double            value = 0.;
      const char *const end   = word.data() + word.size();
      // std::from_chars() does not depend on the locale, but knows no plus
      // sign.
      const auto [rest, error] =
        std::from_chars(word.data() + (word[0] == '+' ? 1 : 0), end, value);
      if (error != std::errc() || rest != end || !std::isfinite(value))
        return {};
      return value;
    }

    /** The number of a type that is given by its name, or by that number. */
    std::optional<double>
    type_number(const std::string &text, const std::vector<std::string> &types)
    {
      // A name goes first, as a type may be called by a number.
      const auto place = std::find(types.begin(), types.end(), text);
      if (place != types.end())
        return place - types.begin();
      const std::optional<double> value = number(text);
      return value && *value == std::floor(*value) && *value >= 0. &&
                 *value < types.size() ?
               value :
               std::nullopt;
    }

    unsigned int
    meaning_of(const std::string &title)
    {
      if (boost::iequals(title, "frame") || boost::iequals(title, "t") ||
          boost::iequals(title, "time"))
        return moment;
      // What is none of the names gets the number behind the last one.
      return std::find(column_names.begin(), column_names.end(), title) -
             column_names.begin();
    }

    /** The meanings of the columns, by the header line. */
    template <int dim>
    std::vector<unsigned int>
    read_header(Lines &lines)
    {
      if (!lines.next())
        lines.refuse(0,
                     "",
                     "a header line and one line per cell",
                     "The file is empty: give another one.");
      std::vector<unsigned int> columns;
      for (const std::string &title : lines.entries)
        columns.push_back(meaning_of(title));
      for (unsigned int meaning = 0; meaning < column_names.size(); ++meaning)
        {
          const auto n = std::count(columns.begin(), columns.end(), meaning);
          if (n > 1 || (n == 0 && meaning < dim))
            lines.refuse(
              0,
              lines.text,
              std::string("a header line that names the columns x, y") +
                (dim == 3 ? ", z" : "") +
                " and, if there, volume, generation, phase and type, each once",
              n > 1 ?
                "There are " + std::to_string(n) + " columns '" +
                  column_names[meaning] + "': rename or drop all but one." :
                "There is no column '" + column_names[meaning] +
                  "'. Commas separate the names, which have small "
                  "letters and no units; morula import writes such a "
                  "file from other tables.");
        }
      return columns;
    }

    /** Refuses a number that its column cannot have. */
    template <int dim>
    void
    check_value(const Lines              &lines,
                const std::size_t         column,
                const unsigned int        meaning,
                const double              value,
                const SeedingLimits<dim> &limits)
    {
      const auto refuse = [&](const std::string &allowed,
                              const std::string &remedy) {
        lines.refuse(column, lines.entries[column - 1], allowed, remedy);
      };
      if (meaning < dim && !(std::abs(value) <= limits.farthest))
        refuse("a place at most " + as_text(limits.farthest) +
                 " um from the origin (a number of times Grid/Spacing)",
               "Correct the line. If the file is in another unit, scale it to "
               "um.");
      // A third dimension is no cell's in 2-D, but z = 0 may stand there.
      if (dim == 2 && meaning == 2 && value != 0.)
        refuse("z = 0 um in 2-D",
               "Project the cells into the plane, or set Dimension = 3.");
      if (meaning == volume && !(value > 0.))
        refuse("a volume above 0 um^3 (2-D: um^2)",
               "Correct the volume or drop the cell.");
      if (meaning == generation &&
          !(value == std::floor(value) && value >= 0. && value <= 1000.))
        refuse("a generation that is a whole number from 0 to 1000",
               "Correct it: it counts the divisions since the founder.");
      if (meaning == phase && value != 0. && value != 1. && value != 2. &&
          value != 4. && value != 9.)
        refuse("a phase that is 0 (G0), 1 (S), 2 (G2), 4 (G1) or 9 (never "
               "divides)",
               "Correct it; M, 3, is no phase that lasts.");
    }

    /** The numbers of the line, by meaning; the volume is that of a cell
     *  without one before. */
    template <int dim>
    void
    read_row(const Lines                     &lines,
             const std::vector<unsigned int> &columns,
             const SeedingLimits<dim>        &limits,
             std::array<double, n_meanings>  &values)
    {
      if (lines.entries.size() != columns.size())
        lines.refuse(0,
                     lines.text,
                     std::to_string(columns.size()) +
                       " entries separated by commas, as in the header",
                     "This line has " + std::to_string(lines.entries.size()) +
                       ": complete it, or drop the columns that it lacks. "
                       "Numbers have decimal points, not commas.");
      for (std::size_t i = 0; i < columns.size(); ++i)
        {
          const unsigned int meaning = columns[i];
          const std::string &entry   = lines.entries[i];
          if (meaning == skipped)
            continue;
          const auto value =
            meaning == type ? type_number(entry, limits.types) : number(entry);
          if (!value && meaning == type)
            lines.refuse(i + 1,
                         entry,
                         limits.types.empty() ?
                           "no column 'type', as the scene has no types of "
                           "cells" :
                           "one of the types " +
                             boost::join(limits.types, ", ") +
                             ", or its number from 0 on",
                         "Correct the line, or name the type in the scene.");
          if (!value)
            lines.refuse(
              i + 1,
              entry,
              "a finite number with a decimal point, in um (volumes: "
              "um^3, 2-D: um^2)",
              "Correct the line.");
          check_value(lines, i + 1, meaning, *value, limits);
          values[meaning] = *value;
        }
    }

    /** All cells of a file, on one rank. */
    template <int dim>
    struct Table
    {
      Founders<dim>              cells;
      std::vector<std::uint64_t> lines; // on which they stand
    };

    template <int dim>
    Table<dim>
    read_table(const std::string        &file,
               const double              default_volume,
               const SeedingLimits<dim> &limits)
    {
      // A row that is right is appended to the lists, and to those of state
      // only if there is such a column, since absent effects need no storage.
      // The first bad line ends the reading. Cells of several moments, which
      // would stand among each other, are refused as well.
      Table<dim>                      table;
      Lines                           lines(file);
      const std::vector<unsigned int> columns = read_header<dim>(lines);
      for (std::size_t i = 0; i < columns.size(); ++i)
        if (columns[i] == skipped)
          table.cells.skipped_columns.push_back(lines.entries[i]);
      const auto keep =
        [&](const unsigned int meaning, const double value, auto &list) {
          if (std::count(columns.begin(), columns.end(), meaning) > 0)
            list.push_back(static_cast<unsigned int>(value));
        };
      std::optional<double> first_moment;
      while (lines.next())
        {
          std::array<double, n_meanings> values = {
            {0., 0., 0., default_volume}};
          read_row(lines, columns, limits, values);
          if (first_moment.value_or(values[moment]) != values[moment])
            lines.refuse(0,
                         lines.text,
                         "the cells of one moment",
                         "The column 'frame', 't' or 'time' goes from " +
                           as_text(*first_moment) + " to " +
                           as_text(values[moment]) +
                           ": keep the rows of one moment.");
          first_moment = values[moment];
          if (!(std::pow(values[volume], 1. / dim) <= limits.cell_length))
            lines.refuse(0,
                         as_text(values[volume]),
                         "a volume of at most " +
                           as_text(std::pow(limits.cell_length, dim)) + " um^" +
                           std::to_string(dim) + ": cells are no longer than " +
                           as_text(limits.cell_length) +
                           " um (a number of times Grid/Spacing)",
                         "Correct the volume, or raise Grid/Spacing: a cell "
                         "deforms as a whole.");
          Point<dim> x;
          for (unsigned int d = 0; d < dim; ++d)
            x[d] = values[d] + 0.; // -0, which would print as such, becomes 0.
          table.cells.positions.push_back(x);
          table.cells.volumes.push_back(values[volume]);
          keep(generation, values[generation], table.cells.generations);
          keep(phase, values[phase], table.cells.phases);
          keep(type, values[type], table.cells.types);
          table.lines.push_back(lines.number);
        }
      return table;
    }

    /** Refuses the first cell that coincides with one before it. */
    template <int dim>
    void
    check_repeated(const std::string &file, const Table<dim> &table)
    {
      const std::vector<Point<dim>> &positions = table.cells.positions;
      std::vector<double>            lengths;
      for (const double V : table.cells.volumes)
        lengths.push_back(std::pow(V, 1. / dim));
      const NearTree<dim> tree(positions);
      for (std::size_t i = 0; i < positions.size(); ++i)
        for (const unsigned int k :
             tree.within(positions[i], contact * lengths[i]))
          if (k < i && positions[i].distance(positions[k]) <
                         contact * std::min(lengths[i], lengths[k]))
            Lines::refuse_line(file,
                               table.lines[i],
                               0,
                               Patterns::Tools::to_string(positions[i]),
                               "one cell at each place, in um, and line " +
                                 std::to_string(table.lines[k]) +
                                 " has one there already, nearer than 1e-3 of "
                                 "a cell's length",
                               "Drop one of the two cells. If all lie so near, "
                               "scale the file to um.");
    }
  } // namespace

  template <int dim>
  Founders<dim>
  read_points(const std::string        &file,
              const double              default_volume,
              const MPI_Comm            comm,
              const SeedingLimits<dim> &limits)
  {
    // Rank 0 reads and checks, the cheap tests first, and all ranks throw
    // together. Then every rank gets all cells for a moment, which takes far
    // less memory than they do later, asks whether there is enough, and keeps
    // its share. Ids follow the order of the file.
    Founders<dim> all;
    on_root(comm, [&]() {
      Table<dim> table = read_table<dim>(file, default_volume, limits);
      if (table.lines.empty() ||
          table.lines.size() >=
            std::numeric_limits<types::particle_index>::max())
        throw InputError(TissueKeys::points_file,
                         file,
                         "a file with 1 to 4e9 cells",
                         "It has " + std::to_string(table.lines.size()) + ".");
      check_repeated(file, table);
      all = std::move(table.cells);
    });
    all.positions       = Utilities::MPI::broadcast(comm, all.positions);
    all.volumes         = Utilities::MPI::broadcast(comm, all.volumes);
    all.skipped_columns = Utilities::MPI::broadcast(comm, all.skipped_columns);
    if (limits.check_memory)
      limits.check_memory(BoundingBox<dim>(all.positions),
                          all.positions.size(),
                          std::accumulate(all.volumes.begin(),
                                          all.volumes.end(),
                                          0.));

    const auto [begin, end] = share(all.positions.size(), comm);
    all.first_id            = static_cast<types::particle_index>(begin);
    all.n_global = static_cast<types::particle_index>(all.positions.size());
    const auto keep_share = [first = begin, last = end](auto &list) {
      if (!list.empty())
        list = {list.begin() + first, list.begin() + last};
    };
    keep_share(all.positions);
    keep_share(all.volumes);
    for (auto *const list : {&all.generations, &all.phases, &all.types})
      {
        *list = Utilities::MPI::broadcast(comm, *list);
        keep_share(*list);
      }
    return all;
  }

  MORULA_INSTANTIATE(read_points);
} // namespace Morula
