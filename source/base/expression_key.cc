// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/expression_key.h>

namespace Morula
{
  ExpressionKey::ExpressionKey(const std::string &path,
                               const std::string &default_text,
                               const std::string &documentation,
                               const Evaluated    evaluated,
                               const unsigned int n_components)
    : AnyKey(path, default_text, documentation)
    , evaluated_(evaluated)
    , n_components(n_components)
    , text_(default_text)
  {}


  ExpressionKey &
  ExpressionKey::positive(const std::string &unit, const std::string &remedy)
  {
    sign           = Sign::positive;
    unit_of_sign   = unit;
    remedy_of_sign = remedy;
    return *this;
  }


  ExpressionKey &
  ExpressionKey::not_negative(const std::string &unit,
                              const std::string &remedy)
  {
    positive(unit, remedy);
    sign = Sign::not_negative;
    return *this;
  }


  ExpressionKey &
  ExpressionKey::symbol(const std::string &symbol)
  {
    symbol_ = symbol;
    return *this;
  }


  ExpressionKey &
  ExpressionKey::operator=(const std::string &text)
  {
    text_ = text;
    parsed.reset();
    return *this;
  }


  Evaluated
  ExpressionKey::evaluated() const
  {
    return evaluated_;
  }


  bool
  ExpressionKey::empty() const
  {
    return text_.empty();
  }


  const Expression &
  ExpressionKey::expression(const unsigned int dim) const
  {
    if (!parsed || (n_components > 1 && parsed_for != dim))
      {
        parsed.emplace(path(),
                       text_,
                       n_components,
                       n_components == 1 ? 1 : dim);
        parsed_for = dim;
      }
    return *parsed;
  }


  std::optional<Expression>
  ExpressionKey::optional(const unsigned int dim) const
  {
    return empty() ? std::optional<Expression>() : expression(dim);
  }


  std::string
  ExpressionKey::text() const
  {
    return text_;
  }


  void
  ExpressionKey::assign(const std::string &text)
  {
    *this = text;
  }


  std::unique_ptr<Patterns::PatternBase>
  ExpressionKey::pattern() const
  {
    return std::make_unique<Patterns::Anything>();
  }


  std::string
  ExpressionKey::allowed() const
  {
    return "";
  }


  void
  ExpressionKey::check(const unsigned int dim) const
  {
    if (empty() && default_text().empty())
      return;
    const Expression &value = expression(dim);
    value.check_dimension(dim);
    if (evaluated_ != Evaluated::step && value.depends_on_time())
      refuse("an expression of X, Y, Z",
             "It is evaluated once, at t = 0: remove t.");
    if (sign == Sign::any || !value.is_constant())
      return;
    const double number = value.value(Point<3>(), 0.);
    if (number < 0. || (number == 0. && sign == Sign::positive))
      refuse((sign == Sign::positive ? "a value > 0 " : "a value >= 0 ") +
               unit_of_sign,
             remedy_of_sign);
  }
} // namespace Morula
