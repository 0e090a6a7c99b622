// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/expression_key.h>
#include <morula/base/input_error.h>
#include <morula/base/instantiate.h>

#include <boost/algorithm/string.hpp>
#include <boost/lexical_cast/try_lexical_convert.hpp>

#include <cmath>
#include <vector>


namespace Morula
{
  namespace
  {
    /** A list of plain numbers as components of an expression; any other text
     *  as it is. */
    std::string
    with_semicolons(const std::string &text)
    {
      // A list of plain numbers separated by commas is what this key had before
      // it could be an expression.
      std::vector<std::string> words;
      boost::split(words, text, boost::is_any_of(","));
      for (std::string &word : words)
        {
          boost::trim(word);
          double number;
          if (!boost::conversion::try_lexical_convert(word, number))
            return text;
        }
      return boost::join(words, "; ");
    }
  } // namespace


  const std::vector<Variable> &
  variables_of(const Evaluated evaluated)
  {
    // The lists are made once. `property` leaves out what depends on the
    // stress: a property on which the stress depends could not follow from it.
    using V = Variable;
    static const std::vector<Variable> founder{V::X, V::Y, V::Z};
    static const std::vector<Variable> property{V::X,
                                                V::Y,
                                                V::Z,
                                                V::t,
                                                V::generation,
                                                V::age,
                                                V::type_age,
                                                V::cycle_phase,
                                                V::type,
                                                V::growth,
                                                V::depth,
                                                V::noise};
    static const std::vector<Variable> all = [] {
      std::vector<Variable> list;
      for (unsigned int i = 0; i < n_variables; ++i)
        list.push_back(static_cast<Variable>(i));
      return list;
    }();
    switch (evaluated)
      {
        case Evaluated::founder:
          return founder;
        case Evaluated::place:
          return place_and_time().variables;
        case Evaluated::property:
          return property;
        default:
          return all;
      }
  }


  const char *
  description_of(const Evaluated evaluated)
  {
    switch (evaluated)
      {
        case Evaluated::founder:
          return "once, at t = 0";
        case Evaluated::event:
          return "when it happens";
        default:
          return "at each step";
      }
  }


  ExpressionKey::ExpressionKey(const KeyPath     &path,
                               const std::string &default_text,
                               const std::string &documentation,
                               const Evaluated    evaluated,
                               const unsigned int n_components)
    : AnyKey(path, default_text, documentation)
    , evaluated_(evaluated)
    , n_components(n_components)
    , text_(default_text)
  {}


  ExpressionKey::ExpressionKey(const KeyPath      &path,
                               const std::string  &default_text,
                               const std::string  &documentation,
                               const Evaluated     evaluated,
                               const Rule<double> &rule)
    : ExpressionKey(path, default_text, documentation, evaluated)
  {
    this->rule = rule;
  }



  ExpressionKey
  ExpressionKey::in_section_of_type(const std::string &section) const
  {
    ExpressionKey key(section + "/" + path(),
                      "",
                      "For cells of this type; empty: the value of the "
                      "general key.",
                      evaluated_,
                      n_components);
    key.rule = rule;
    return key;
  }


  const Expression &
  ExpressionKey::expression(const unsigned int dim) const
  {
    // An expression is parsed when it is first asked for, and kept until
    // something changes. A vector depends on the dimension, a number does not.
    // The types' own texts are parsed in the same way, with their own paths for
    // messages, and belong to the expression of all.
    if (!parsed || (n_components > 1 && parsed_for != dim))
      {
        // Founders have no t, but are parsed with it, since check() has better
        // words for it.
        const Vocabulary vocabulary =
          evaluated_ == Evaluated::founder ?
            place_and_time() :
            Vocabulary{variables_of(evaluated_),
                       is_of_cells() ? types : std::map<std::string, double>(),
                       fields};
        const auto parse = [&](const std::string &path,
                               const std::string &text) {
          Expression expression(path,
                                commas ? with_semicolons(text) : text,
                                n_components,
                                n_components == 1 ? 1 : dim,
                                vocabulary);
          if (rule)
            expression.set_rule(*rule);
          return expression;
        };
        std::map<unsigned int, Expression> expressions;
        for (const auto &[type, path_and_text] : of_types)
          expressions.emplace(type,
                              parse(path_and_text.first, path_and_text.second));
        parsed     = parse(path(), text_).with_types(expressions);
        parsed_for = dim;
      }
    return *parsed;
  }


  void
  ExpressionKey::check_expression(const Expression  &value,
                                  const unsigned int dim) const
  {
    // Each type's expression is checked with its own path.
    for (const auto &[type, own] : value.types())
      check_expression(own, dim);
    value.check_dimension(dim);
    if (evaluated_ == Evaluated::founder && value.depends_on_time())
      throw InputError(value.key(),
                       value.text(),
                       "an expression of X, Y, Z",
                       "It is evaluated once, at t = 0: remove t.");
    // A constant can be judged now. Other values are judged wherever they are
    // evaluated.
    const std::optional<double> number = value.number();
    if (rule && number && !rule->holds(*number))
      throw InputError(value.key(), value.text(), rule->allowed, rule->remedy);
  }


  template <int dim>
  Tensor<1, dim>
  unit_vector(const std::string &key, const std::string &text)
  {
    std::vector<std::string> words;
    // Both separators are accepted, as lists of numbers have the one and
    // expressions the other.
    boost::split(words, text, boost::is_any_of(",;"));
    bool           valid = words.size() >= dim && words.size() <= 3;
    Tensor<1, dim> direction;
    for (unsigned int d = 0; valid && d < words.size(); ++d)
      {
        boost::trim(words[d]);
        double component;
        valid = boost::conversion::try_lexical_convert(words[d], component) &&
                std::isfinite(component);
        // In 2-D a third component may be there, and does not count.
        if (valid && d < dim)
          direction[d] = component;
      }
    if (!valid || direction.norm() == 0.)
      throw InputError(key,
                       text,
                       "a direction of " + std::to_string(dim) +
                         " numbers that are not all zero, separated by commas",
                       "Write for example 0, 1, 0; its length does not "
                       "matter.");
    return direction / direction.norm();
  }


  void
  DirectionKey::check(const unsigned int dim) const
  {
    if (value().empty())
      return;
    if (dim == 2)
      unit_vector<2>(path(), value());
    else
      unit_vector<3>(path(), value());
  }


  MORULA_INSTANTIATE(unit_vector);
} // namespace Morula
