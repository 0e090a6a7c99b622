// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/seeding/points_file_rows.h>
#include <morula/seeding/points_file_words.h>

#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace Morula
{
  namespace
  {
    using PointsFileWords::fields;
    using PointsFileWords::in_utf8;
    using PointsFileWords::number;
    using PointsFileWords::remedy_for;
    using PointsFileWords::trimmed;

    /** The columns of a points file; their places are their meanings. */
    constexpr unsigned int volume = 3, generation = 4, phase = 5, type = 6,
                           moment = 7, skipped = 8, n_meanings = skipped;
    const std::array<std::string, moment> column_names = {
      {"x", "y", "z", "volume", "generation", "phase", "type"}};

    /** Longest line, in characters. A few numbers and their names are far
     *  shorter; a file without line ends could fill the memory. */
    constexpr std::size_t longest_line = 10000;

    std::string
    name_of(const char separator)
    {
      switch (separator)
        {
          case ' ':
            return "blanks";
          case ',':
            return "commas";
          case ';':
            return "semicolons";
          default:
            return "tabs";
        }
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
      if (value && *value == std::floor(*value) && *value >= 0. &&
          *value < types.size())
        return value;
      return {};
    }

    bool
    is_phase(const double value)
    {
      // G0, S, G2, G1 and "never divides"; see check_state().
      return value == 0. || value == 1. || value == 2. || value == 4. ||
             value == 9.;
    }

    bool
    is_generation(const double value)
    {
      return value == std::floor(value) && value >= 0. && value <= 1000.;
    }

    std::string
    allowed_types(const std::vector<std::string> &types)
    {
      return types.empty() ?
               "no column 'type', as the scene has no types of cells" :
               "one of the types " + boost::algorithm::join(types, ", ") +
                 ", or its number from 0 on";
    }

    /** Refuses what no cell can be, in the line @p text. */
    template <int dim>
    void
    check_state(const double         given_generation,
                const double         given_phase,
                const std::string   &text,
                PointsFileRows<dim> &rows)
    {
      if (!is_generation(given_generation))
        rows.problem = {rows.n_lines,
                        text,
                        "a generation that is a whole number from 0 to 1000",
                        "Correct it: it counts the divisions since the "
                        "founder."};
      if (!is_phase(given_phase))
        rows.problem = {rows.n_lines,
                        text,
                        "a phase that is 0 (G0), 1 (S), 2 (G2), 4 (G1) or 9 "
                        "(never divides)",
                        "Correct it; M, 3, is no phase that lasts."};
    }
    /** The rest of @p name and the unit in brackets behind it, if any. */
    std::pair<std::string, std::string>
    split_unit(const std::string &name)
    {
      // A unit stands in round or square brackets at the end.
      const auto open = name.find_first_of("([");
      if (open == std::string::npos ||
          name.find_last_of(")]") != name.size() - 1)
        return {name, ""};
      return {trimmed(name.substr(0, open)),
              trimmed(name.substr(open + 1, name.size() - open - 2))};
    }

    /** Whether a unit is another one than µm, µm^2 or µm^3: it may be written
     *  in many ways. */
    bool
    is_other_unit(const std::string &unit)
    {
      // Two signs of Unicode look like the Greek letter.
      const std::array<std::string, 4> known = {
        {"um", "micro", "\xC2\xB5m", "\xCE\xBCm"}};
      return !unit.empty() &&
             std::none_of(known.begin(), known.end(), [&](const auto &begin) {
               return boost::algorithm::istarts_with(unit, begin);
             });
    }

    /** What is said of a column of coordinates in another unit. */
    void
    set_unit_problem(const std::string &text,
                     const std::string &unit,
                     LineProblem       &problem)
    {
      problem.value   = text;
      problem.allowed = "coordinates in um, volumes in um^3 (2-D: um^2)";
      problem.remedy  = "The file says '" + unit +
                       "': convert the columns to um, and correct the unit.";
    }

    /** The meaning of a column by its name. */
    unsigned int
    meaning_of(const std::string &title)
    {
      // Names are compared in small letters and without a unit. "Position X"
      // and the like are the headers of common programs.
      std::string name =
        boost::algorithm::to_lower_copy(split_unit(title).first);
      if (boost::algorithm::starts_with(name, "position"))
        name = boost::algorithm::trim_left_copy_if(
          name.substr(8), boost::algorithm::is_any_of("_-. "));
      if (name == "frame" || name == "t" || name == "time")
        return moment;
      const auto place =
        std::find(column_names.begin(), column_names.end(), name);
      return place == column_names.end() ? skipped :
                                           place - column_names.begin();
    }

    /** The columns, if entries are separated by @p separator, and how many
     *  coordinates are among them. */
    std::pair<std::vector<unsigned int>, unsigned int>
    columns_with(const std::string &text, const char separator)
    {
      std::vector<unsigned int>            columns;
      std::array<unsigned int, n_meanings> found{};
      for (const std::string &title : fields(text, separator))
        {
          columns.push_back(meaning_of(title));
          if (columns.back() < n_meanings)
            ++found[columns.back()];
        }
      return {columns, (found[0] > 0) + (found[1] > 0) + (found[2] > 0)};
    }

    /** The separator by which most coordinates are found, and then most
     *  columns. */
    char
    find_separator(const std::string &text)
    {
      // A name may hold any of these signs, so the one that makes sense of the
      // line is the separator.
      char                                 best = ',';
      std::pair<unsigned int, std::size_t> most = {0, 0};
      for (const char separator : {',', ';', '\t', ' '})
        {
          const auto [columns, coordinates] = columns_with(text, separator);
          const std::pair<unsigned int, std::size_t> has = {coordinates,
                                                            columns.size()};
          if (has > most)
            {
              most = has;
              best = separator;
            }
        }
      return best;
    }

    /** What is wrong with a header line, in words; empty if nothing is. */
    template <int dim>
    std::string
    header_fault(const std::vector<std::string>  &titles,
                 const std::vector<unsigned int> &columns)
    {
      // A file without a header is told from one with strange names.
      if (std::all_of(titles.begin(), titles.end(), [](const auto &title) {
            return number(title).has_value();
          }))
        return "This line has numbers only, so that the file seems to have no "
               "header: write one in front, such as 'x,y,z'.";
      std::string missing;
      for (unsigned int meaning = 0; meaning < moment; ++meaning)
        {
          const auto n = std::count(columns.begin(), columns.end(), meaning);
          if (n > 1)
            return "There are " + std::to_string(n) + " columns '" +
                   column_names[meaning] + "': rename or drop all but one.";
          if (n == 0 && meaning < dim)
            missing +=
              (missing.empty() ? "'" : ", '") + column_names[meaning] + "'";
        }
      return missing.empty() ? "" :
                               "There is no column " + missing +
                                 ": rename those that hold the coordinates.";
    }
  } // namespace

  bool
  is_blank_or_comment(const std::string &line)
  {
    const auto first = line.find_first_not_of(" \t\r\",;");
    return first == std::string::npos || line[first] == '#';
  }

  template <int dim>
  PointsFormat
  read_columns(const std::string &text, LineProblem &problem)
  {
    PointsFormat format;
    // Each step uses the one before: the separator gives the entries, their
    // names give the columns, and only a header without a fault is asked for
    // units. What is not recognised is skipped, and said in a warning by the
    // caller.
    const std::string line = text.substr(0, longest_line);
    format.separator       = find_separator(line);
    format.columns         = columns_with(line, format.separator).first;
    const auto titles      = fields(line, format.separator);
    const auto fault       = text.size() > longest_line ?
                               "This line is too long for a header." :
                               header_fault<dim>(titles, format.columns);
    if (!fault.empty())
      {
        problem.value = in_utf8(trimmed(line));
        problem.allowed =
          dim == 3 ?
            "a header line that names the columns x, y, z and, if there, "
            "volume, generation, phase and type, each once" :
            "a header line that names the columns x, y and, if there, z, "
            "volume, generation, phase and type, each once";
        problem.remedy = fault;
        return format;
      }
    for (std::size_t i = 0; i < titles.size(); ++i)
      {
        const bool is_read = format.columns[i] < moment;
        (is_read ? format.read : format.skipped)
          .push_back(titles[i].empty() ? "(no name)" : titles[i]);
        if (const auto unit = split_unit(titles[i]).second;
            format.columns[i] <= volume && is_other_unit(unit))
          set_unit_problem(titles[i], unit, problem);
      }
    return format;
  }

  bool
  is_further_header(const std::string  &text,
                    const PointsFormat &format,
                    LineProblem        &problem)
  {
    // A further line of the header has as many entries as there are columns,
    // and words where coordinates stand. What could be a number, also an
    // infinite one, is a row.
    if (text.size() > longest_line)
      return false;
    const auto entries = fields(text, format.separator);
    if (entries.size() != format.columns.size())
      return false;
    for (std::size_t i = 0; i < entries.size(); ++i)
      if (format.columns[i] < volume &&
          (entries[i].empty() ||
           entries[i].find_first_of("0123456789") != std::string::npos ||
           boost::algorithm::istarts_with(entries[i], "nan") ||
           boost::algorithm::ifind_first(entries[i], "inf")))
        return false;
    for (std::size_t i = 0; i < entries.size(); ++i)
      if (const auto unit = split_unit(entries[i]).second;
          format.columns[i] <= volume && is_other_unit(unit))
        set_unit_problem(entries[i], unit, problem);
    return true;
  }

  template <int dim>
  void
  read_row(const std::string              &text,
           const PointsFormat             &format,
           const double                    default_volume,
           const std::vector<std::string> &types,
           PointsFileRows<dim>            &rows)
  {
    const auto &columns = format.columns;
    // Each entry goes to the meaning of its column; what no column gives has a
    // default. The first thing that is wrong becomes the problem of this rank,
    // with the line's number in its share, and ends the reading: the caller
    // finds the first of all ranks. A row that is right is appended to the
    // lists, and to those of state only if there is such a column, since absent
    // effects need no storage.
    std::vector<std::string> entries =
      fields(text.substr(0, longest_line), format.separator);
    // Spreadsheets fill rows up to the width of the sheet.
    while (entries.size() > columns.size() && entries.back().empty())
      entries.pop_back();
    if (text.size() > longest_line || entries.size() != columns.size())
      {
        rows.problem = {
          rows.n_lines,
          in_utf8(trimmed(text.substr(0, longest_line))),
          std::to_string(columns.size()) + " entries separated by " +
            name_of(format.separator) + ", as in the header",
          "This line has " + std::to_string(entries.size()) +
            ": complete it, or drop the columns that it lacks. Numbers have "
            "decimal points, not commas."};
        return;
      }
    // The order is that of the meanings: x, y, z, volume, generation, phase,
    // type, moment.
    std::array<double, n_meanings> values = {
      {0., 0., 0., default_volume, 0., 0., 0., 0.}};
    for (unsigned int i = 0; i < entries.size(); ++i)
      {
        if (columns[i] == skipped)
          continue;
        const std::optional<double> value = columns[i] == type ?
                                              type_number(entries[i], types) :
                                              number(entries[i]);
        // Rows of several moments are refused later, when the range over all
        // ranks is known.
        if (columns[i] == moment)
          {
            if (value)
              {
                rows.first_time = std::min(rows.first_time, *value);
                rows.last_time  = std::max(rows.last_time, *value);
              }
            continue;
          }
        // A wrong type has a message of its own: it depends on the scene.
        if (!value && columns[i] == type)
          {
            rows.problem = {rows.n_lines,
                            entries[i],
                            allowed_types(types),
                            "Correct the line, or name the type in the scene."};
            return;
          }
        if (!value)
          {
            rows.problem = {rows.n_lines,
                            entries[i],
                            "a finite number with a decimal point, in um "
                            "(volumes: um^3, 2-D: um^2)",
                            remedy_for(entries[i])};
            return;
          }
        values[columns[i]] = *value;
      }
    if (!(values[volume] > 0.))
      rows.problem = {rows.n_lines,
                      in_utf8(trimmed(text)),
                      "a volume above 0 um^3 (2-D: um^2)",
                      "Correct the volume or drop the cell."};
    check_state(values[generation],
                values[phase],
                in_utf8(trimmed(text)),
                rows);
    // A third dimension is no cell's in 2-D, but z = 0 may stand there.
    if (dim == 2 && values[2] != 0.)
      rows.problem = {
        rows.n_lines,
        in_utf8(trimmed(text)),
        "z = 0 um in 2-D",
        "Project the cells into the plane, or set Dimension = 3."};
    Point<dim> x;
    for (unsigned int d = 0; d < dim; ++d)
      x[d] = values[d] + 0.; // -0, which would print as such, becomes 0.
    rows.positions.push_back(x);
    rows.volumes.push_back(values[volume]);
    const auto keep = [&](const unsigned int meaning, auto &list) {
      if (std::find(columns.begin(), columns.end(), meaning) != columns.end())
        list.push_back(static_cast<unsigned int>(values[meaning]));
    };
    keep(generation, rows.generations);
    keep(phase, rows.phases);
    keep(type, rows.types);
    rows.lines.push_back(rows.n_lines);
  }


  MORULA_INSTANTIATE(read_columns);
  MORULA_INSTANTIATE(read_row);
} // namespace Morula
