// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/seeding/points_file_words.h>

#include <boost/locale/encoding_utf.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace Morula::PointsFileWords
{
  std::string
  trimmed(const std::string &text)
  {
    // Quotes around an entry do not count, nor the carriage return of
    // Windows.
    const char *const blanks = " \t\r\"";
    const auto        begin  = text.find_first_not_of(blanks);
    return begin == std::string::npos ?
             "" :
             text.substr(begin, text.find_last_not_of(blanks) + 1 - begin);
  }


  std::string
  in_utf8(const std::string &text)
  {
    // Most lines have no sign beyond ASCII.
    if (std::all_of(text.begin(), text.end(), [](const char c) {
          return static_cast<unsigned char>(c) < 0x80u;
        }))
      return text;
    try
      {
        boost::locale::conv::utf_to_utf<char32_t>(text,
                                                  boost::locale::conv::stop);
        return text;
      }
    catch (const boost::locale::conv::conversion_error &)
      {
        // Latin-1 has the numbers of Unicode's first 256 signs.
        std::u32string signs;
        for (const char c : text)
          signs += static_cast<unsigned char>(c);
        return boost::locale::conv::utf_to_utf<char>(signs);
      }
  }


  std::vector<std::string>
  fields(const std::string &line, const char separator)
  {
    std::vector<std::string> result(1);
    const std::string        text   = in_utf8(line);
    bool                     quoted = false;
    for (const char c : separator == ' ' ? trimmed(text) : text)
      {
        // Several blanks in a row are one separator, several commas are empty
        // entries.
        quoted = quoted != (c == '"');
        if (quoted || c != separator)
          result.back() += c;
        else if (separator != ' ' || !result.back().empty())
          result.emplace_back();
      }
    for (std::string &entry : result)
      entry = trimmed(entry);
    return result;
  }


  std::optional<double>
  number(std::string word)
  {
    if (word.empty())
      return {};
    // Fortran writes the letter D before the exponent of its doubles.
    for (char &letter : word)
      if (letter == 'd' || letter == 'D')
        letter = 'e';
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


  std::string
  remedy_for(const std::string &word)
  {
    // A sign between digits is a decimal point or parts thousands, by the
    // country. Where both stand, or one stands twice, it is clear which is
    // which.
    const auto comma = word.rfind(','), point = word.rfind('.');
    const bool has_comma = comma != std::string::npos;
    if (word.find_first_not_of("+-0123456789.,'_ ") == std::string::npos)
      {
        if (has_comma && point != std::string::npos && point < comma)
          return "Its points part thousands: leave them out, and write a "
                 "decimal point instead of the decimal comma.";
        if ((has_comma && point != std::string::npos) ||
            word.find(',') != comma ||
            word.find_first_of("'_ ") != std::string::npos)
          return "Leave out the signs that part thousands, as in 1000.0.";
        if (word.find('.') != point)
          return "Leave out the points that part thousands, as in 1000000.";
      }
    return has_comma ? "Write decimal points instead of decimal commas." :
                       "Correct the line.";
  }
} // namespace Morula::PointsFileWords
