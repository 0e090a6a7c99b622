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

  /** A component as muParser reads it well. */
  struct Readable
  {
    std::string text;
    /** Where each of its characters, and its end, stands in the component,
     *  counted from 0. */
    std::vector<std::size_t> positions;
  };

  /**
   * One component with a blank behind each && and ||: deal.II adds the
   * operators & and | to muParser's own, which then reads the || of X<1||Y<1 as
   * | and |Y. Without blanks between a function and its parenthesis, where
   * muParser allows none. And with normal(noise, a, b) for normal(a, b).
   */
  Readable
  readable(const std::string &component);

  /**
   * What muParser would accept in one component although it means something
   * else than it seems to: a full sentence with the position and the remedy;
   * empty if there is nothing of the kind.
   */
  std::string
  misunderstanding(const std::string &component);
} // namespace Morula::ExpressionSyntax

#endif
