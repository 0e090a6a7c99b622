// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_input_error_h
#define morula_base_input_error_h

#include <stdexcept>
#include <string>

namespace Morula
{
  /**
   * A text that the user wrote, as messages show it. A long text is cut, but
   * never within a character of several bytes. Characters that cannot be
   * printed are replaced by their hexadecimal codes, since a null byte would
   * end the message.
   */
  std::string
  printable(const std::string &text);

  /**
   * Bad input, found before any work is done. The program ends with exit
   * code 1. The message names the key's full path, its value, what is allowed,
   * and what to do.
   */
  class InputError : public std::runtime_error
  {
  public:
    /**
     * @param key     full path of the key, e.g. "Grid/Spacing", or the file or
     *                command-line word in question
     * @param value   the value found, shortened by printable()
     * @param allowed what is allowed, a noun phrase
     * @param remedy  what to do, a full sentence
     */
    InputError(const std::string &key,
               const std::string &value,
               const std::string &allowed,
               const std::string &remedy)
      : std::runtime_error(printable(key) + " = '" + printable(value) +
                           "': allowed is " + allowed + ". " + remedy)
    {}

    /** An error with a complete message. */
    explicit InputError(const std::string &message)
      : std::runtime_error(message)
    {}
  };
} // namespace Morula

#endif
