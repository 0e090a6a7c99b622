// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_expression_key_h
#define morula_base_expression_key_h

#include <morula/base/expression.h>
#include <morula/base/key.h>

#include <optional>

namespace Morula
{
  /** When the expression of a key is evaluated. */
  enum class Evaluated
  {
    /** Once, for a founder or a boundary point at t = 0: without t. */
    founder,
    /** When something happens to a cell, at its founder's place: without t. */
    event,
    /** In every step, at its end: with t. */
    step
  };

  /** A key whose value is an Expression, which is parsed once. */
  class ExpressionKey : public AnyKey
  {
  public:
    /**
     * @param n_components 1, or 3 for a vector: in 2-D its third component may
     *        be missing
     */
    ExpressionKey(const std::string &path,
                  const std::string &default_text,
                  const std::string &documentation,
                  const Evaluated    evaluated,
                  const unsigned int n_components = 1);

    /** Refuses a plain number <= 0. @param unit e.g. "kPa", for the message */
    ExpressionKey &
    positive(const std::string &unit, const std::string &remedy);

    /** Refuses a plain number < 0. */
    ExpressionKey &
    not_negative(const std::string &unit, const std::string &remedy);

    /** Names the symbol that --explain uses. */
    ExpressionKey &
    symbol(const std::string &symbol);

    /** Takes other text; it is parsed when it is next needed. */
    ExpressionKey &
    operator=(const std::string &text);

    /** When it is evaluated. */
    Evaluated
    evaluated() const;

    /** Whether there is no text. */
    bool
    empty() const;

    /**
     * The expression for @p dim dimensions, parsed when first asked for.
     * Without text it is refused.
     * @throws InputError if it cannot be parsed
     */
    const Expression &
    expression(const unsigned int dim) const;

    /** The expression, or none without text. @throws InputError */
    std::optional<Expression>
    optional(const unsigned int dim) const;

    std::string
    text() const override;
    void
    assign(const std::string &text) override;
    std::unique_ptr<Patterns::PatternBase>
    pattern() const override;
    std::string
    allowed() const override;
    void
    check(const unsigned int dim) const override;

    /** Compares the text. */
    friend bool
    operator==(const ExpressionKey &key, const std::string &text)
    {
      return key.text_ == text;
    }

  private:
    enum class Sign
    {
      any,
      positive,
      not_negative
    };

    Evaluated    evaluated_;
    unsigned int n_components;
    std::string  text_;
    Sign         sign = Sign::any;
    std::string  unit_of_sign, remedy_of_sign;

    // The value, parsed: made of text_ alone.
    mutable std::optional<Expression> parsed;
    mutable unsigned int              parsed_for = 0; // dimensions
  };
} // namespace Morula

#endif
