// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_expression_parser_h
#define morula_base_expression_parser_h

#include <morula/base/expression.h>

#include <muParser.h>

#include <optional>
#include <string>
#include <vector>

namespace Morula
{
  /** The text of an expression, before muParser reads it. */
  namespace ExpressionSyntax
  {
    /** The components of @p text, separated by ';', without outer blanks. */
    std::vector<std::string>
    components(const std::string &text);

    /** Whether @p name occurs in @p text as an identifier. */
    bool
    uses(const std::string &text, const std::string &name);

    /**
     * Looks in one component for text that muParser would accept but misread.
     * Returns a full sentence with the position and the remedy; empty if there
     * is none.
     */
    std::string
    misreading(const std::string &component);
  } // namespace ExpressionSyntax

  /** Whether no expression has a variable, function or constant of this name.
   */
  bool
  is_free_name(const std::string &name);

  /**
   * One component of an expression, as muParser evaluates it, with deal.II's
   * functions and operators and hill(), ramp() and normal(). Not thread-safe.
   */
  class ExpressionParser
  {
  public:
    /** @throws std::invalid_argument if muParser does not understand the text:
     *  a full sentence, with the place in the text */
    ExpressionParser(const std::string &text, const Vocabulary &vocabulary);
    ExpressionParser(const ExpressionParser &) = delete;
    ExpressionParser &
    operator=(const ExpressionParser &) = delete;

    /** The variables in the text. */
    const std::vector<Variable> &
    used() const
    {
      return used_;
    }

    /** The value, which may be infinite or NaN. */
    double
    value(const VariableValues &values) const;

  private:
    // muParser reads the variables at these places.
    mutable VariableValues places{};
    mu::Parser             parser;
    std::vector<Variable>  used_;
  };

  /** The decimal number of ten places that @p t (day) is but for rounding, or
   *  @p t itself: expressions see the time that users write, so that t >= 0.45
   *  holds at the end of the ninth step of 0.05. */
  double
  decimal(const double t);
} // namespace Morula

#endif
