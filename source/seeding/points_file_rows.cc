// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/seeding/points_file_rows.h>

#include <boost/algorithm/string/join.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>

namespace Morula
{
  namespace
  {
    /** The columns of a points file; their places are their meanings. */
    constexpr unsigned int volume = 3, generation = 4, phase = 5, type = 6,
                           n_meanings                      = 7;
    const std::array<std::string, n_meanings> column_names = {
      {"x", "y", "z", "volume", "generation", "phase", "type"}};

    /** Longest line, in characters. A few numbers and their names are far
     *  shorter; a file without line ends could fill the memory. */
    constexpr std::size_t longest_line = 10000;

    std::string
    trimmed(const std::string &text)
    {
      const char *const blanks = " \t\r\"";
      const auto        begin  = text.find_first_not_of(blanks);
      return begin == std::string::npos ?
               "" :
               text.substr(begin, text.find_last_not_of(blanks) + 1 - begin);
    }

    std::vector<std::string>
    fields(const std::string &line)
    {
      std::vector<std::string> result;
      std::size_t              begin = 0;
      for (std::size_t comma; begin != std::string::npos;
           begin = comma == std::string::npos ? comma : comma + 1)
        {
          comma = line.find(',', begin);
          result.push_back(trimmed(line.substr(begin, comma - begin)));
        }
      return result;
    }

    std::optional<double>
    number(const std::string &text)
    {
      double            value = 0.;
      const char *const end   = text.data() + text.size();
      const auto [rest, error] =
        std::from_chars(text.data() + (text[0] == '+' ? 1 : 0), end, value);
      if (error != std::errc() || rest != end || !std::isfinite(value))
        return {};
      return value;
    }

    /** The number of a type that is given by its name, or by that number. */
    std::optional<double>
    type_number(const std::string &text, const std::vector<std::string> &types)
    {
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
  } // namespace

  bool
  is_blank_or_comment(const std::string &line)
  {
    const std::string text = trimmed(line);
    return text.empty() || text[0] == '#';
  }

  template <int dim>
  std::vector<unsigned int>
  read_columns(const std::string &text, LineProblem &problem)
  {
    std::vector<unsigned int>            columns;
    const auto                          &names = column_names;
    std::array<unsigned int, n_meanings> found{};
    bool                                 known = true;
    for (std::string name : text.size() > longest_line ?
                              std::vector<std::string>{""} :
                              fields(text))
      {
        std::transform(name.begin(),
                       name.end(),
                       name.begin(),
                       [](const char c) {
                         return static_cast<char>(
                           std::tolower(static_cast<unsigned char>(c)));
                       });
        const auto column = static_cast<unsigned int>(
          std::find(names.begin(), names.end(), name) - names.begin());
        columns.push_back(column);
        known = known && column < names.size() && ++found[column] == 1;
      }
    if (!known || found[0] == 0 || found[1] == 0 || (dim == 3 && found[2] == 0))
      {
        problem.value = trimmed(text.substr(0, longest_line));
        problem.allowed =
          dim == 3 ?
            "a header line that names the columns x, y, z and, if there, "
            "volume, generation, phase and type, each once" :
            "a header line that names the columns x, y and, if there, z, "
            "volume, generation, phase and type, each once";
        problem.remedy = "Name the columns in the file's first line.";
      }
    return columns;
  }

  template <int dim>
  void
  read_row(const std::string               &text,
           const std::vector<unsigned int> &columns,
           const double                     default_volume,
           const std::vector<std::string>  &types,
           PointsFileRows<dim>             &rows)
  {
    const bool                     too_long = text.size() > longest_line;
    const std::vector<std::string> entries =
      too_long ? std::vector<std::string>() : fields(text);
    if (entries.size() != columns.size())
      {
        rows.problem = {rows.n_lines,
                        trimmed(text.substr(0, longest_line)),
                        std::to_string(columns.size()) +
                          " numbers separated by commas, as in the header",
                        "Correct the line."};
        return;
      }
    std::array<double, n_meanings> values = {
      {0., 0., 0., default_volume, 0., 0., 0.}};
    for (unsigned int i = 0; i < entries.size(); ++i)
      {
        const std::optional<double> value = columns[i] == type ?
                                              type_number(entries[i], types) :
                                              number(entries[i]);
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
                            "Correct the line."};
            return;
          }
        values[columns[i]] = *value;
      }
    if (!(values[volume] > 0.))
      rows.problem = {rows.n_lines,
                      trimmed(text),
                      "a volume above 0 um^3 (2-D: um^2)",
                      "Correct the volume or drop the cell."};
    check_state(values[generation], values[phase], trimmed(text), rows);
    if (dim == 2 && values[2] != 0.)
      rows.problem = {
        rows.n_lines,
        trimmed(text),
        "z = 0 um in 2-D",
        "Project the cells into the plane, or set Dimension = 3."};
    Point<dim> x;
    for (unsigned int d = 0; d < dim; ++d)
      x[d] = values[d] + 0.; // -0 becomes 0
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


  template std::vector<unsigned int>
  read_columns<2>(const std::string &, LineProblem &);
  template std::vector<unsigned int>
  read_columns<3>(const std::string &, LineProblem &);
  template void
  read_row<2>(const std::string &,
              const std::vector<unsigned int> &,
              const double,
              const std::vector<std::string> &,
              PointsFileRows<2> &);
  template void
  read_row<3>(const std::string &,
              const std::vector<unsigned int> &,
              const double,
              const std::vector<std::string> &,
              PointsFileRows<3> &);
} // namespace Morula
