// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_complaint_h
#define morula_tests_complaint_h

#include <morula/base/input_error.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace Morula
{
  /** The InputError with which @p action ends on this rank; empty without. */
  template <typename Action>
  std::string
  complaint_of(const Action &action)
  {
    try
      {
        action();
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "";
  }

  /** Expects all @p parts in a message. */
  inline void
  expect_parts(const std::string              &message,
               const std::vector<std::string> &parts)
  {
    for (const std::string &part : parts)
      EXPECT_NE(message.find(part), std::string::npos)
        << "'" << part << "' is missing in: " << message;
  }
} // namespace Morula

#endif
