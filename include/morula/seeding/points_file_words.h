// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_points_file_words_h
#define morula_seeding_points_file_words_h

#include <optional>
#include <string>
#include <vector>

namespace Morula::PointsFileWords
{
  /** The text without blanks and quotes around it, and without the carriage
   *  return of Windows. */
  std::string
  trimmed(const std::string &text);

  /** A text in UTF-8; what cannot be that is taken for Latin-1. */
  std::string
  in_utf8(const std::string &text);

  /** The entries of a line, trimmed and in UTF-8. A separator within quotes
   *  belongs to a text, and a blank stands for any number of them. */
  std::vector<std::string>
  fields(const std::string &line, const char separator);

  /** The finite number that a word is, with a decimal point and perhaps an
   *  exponent after e or, as Fortran has it, d. */
  std::optional<double>
  number(std::string word);

  /** What to do about a word that is no number, as a sentence. */
  std::string
  remedy_for(const std::string &word);
} // namespace Morula::PointsFileWords

#endif
