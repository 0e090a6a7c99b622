// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_expression_syntax_h
#define morula_base_expression_syntax_h

#include <string>
#include <vector>

namespace Morula::ExpressionSyntax
{
  /** The components of @p text, separated by ';', without outer blanks. */
  std::vector<std::string>
  components(const std::string &text);

  /** Whether @p name occurs in @p text as an identifier. */
  bool
  uses(const std::string &text, const std::string &name);

  /** A component, rewritten so that muParser reads it correctly. */
  struct Readable
  {
    std::string text;
    /** Where each of its characters, and its end, stands in the component,
     *  counted from 0. */
    std::vector<std::size_t> positions;
  };

  /**
   * Rewrites one component for muParser. It puts a blank behind each && and ||:
   * deal.II adds the operators & and | to muParser's own, which then reads the
   * || of X<1||Y<1 as | and |Y. It removes blanks between a function and its
   * parenthesis, since muParser allows none there. It writes normal(noise, a,
   * b) for normal(a, b).
   */
  Readable
  readable(const std::string &component);

  /**
   * Looks in one component for text that muParser would accept but misread.
   * Returns a full sentence with the position and the remedy; empty if there is
   * none.
   */
  std::string
  misreading(const std::string &component);
} // namespace Morula::ExpressionSyntax

#endif
