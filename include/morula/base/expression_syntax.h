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

  /**
   * One component with a blank behind each && and ||. deal.II adds the
   * operators & and | to muParser's own, which then reads the || of X<1||Y<1 as
   * | and |Y.
   */
  std::string
  with_blanks(const std::string &component);

  /** Where a character of with_blanks() stands in the component itself, both
   *  counted from 0. */
  std::size_t
  position_without_blanks(const std::string &component,
                          const std::size_t  position);

  /**
   * What muParser would accept in one component although it means something
   * else than it seems to: a full sentence with the position and the remedy;
   * empty if there is nothing of the kind.
   */
  std::string
  misunderstanding(const std::string &component);
} // namespace Morula::ExpressionSyntax

#endif
