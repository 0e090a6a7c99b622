// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_input_error_h
#define morula_base_input_error_h

#include <stdexcept>
#include <string>

namespace Morula
{
  /**
   * A text of the user's as messages show it: the beginning of a long one
   * (without the second half of a character of several bytes), and what cannot
   * be printed as its hexadecimal code, since a null byte would end the
   * message.
   */
  std::string
  shown(const std::string &text);

  /**
   * Bad input: found before any work is done. The program ends with exit
   * code 1. The message names the key's full path, the value, what is
   * allowed, and what to do.
   */
  class InputError : public std::runtime_error
  {
  public:
    /**
     * @param key     full path of the key, e.g. "Grid/Spacing", or the file or
     *                command-line word in question
     * @param value   the value found, shortened by shown()
     * @param allowed what is allowed, a noun phrase
     * @param remedy  what to do, a full sentence
     */
    InputError(const std::string &key,
               const std::string &value,
               const std::string &allowed,
               const std::string &remedy)
      : std::runtime_error(shown(key) + " = '" + shown(value) +
                           "': allowed is " + allowed + ". " + remedy)
    {}

    /** With the message of another one. */
    explicit InputError(const std::string &message)
      : std::runtime_error(message)
    {}
  };
} // namespace Morula

#endif
