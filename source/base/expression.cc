// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/expression.h>
#include <morula/base/expression_parser.h>
#include <morula/base/input_error.h>

#include <boost/algorithm/string.hpp>
#include <boost/lexical_cast/try_lexical_convert.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>

namespace Morula
{
  const char *
  name_of(const Variable variable)
  {
    // The order is that of the enumeration.
    constexpr std::array<const char *, n_variables> names = {
      {"X",        "Y",           "Z",
       "t",        "x",           "y",
       "z",        "generation",  "age",
       "type_age", "cycle_phase", "type",
       "volume",   "growth",      "J_e",
       "pressure", "tension",     "shear",
       "energy",   "depth",       "present_depth",
       "noise"}};
    return names[static_cast<unsigned int>(variable)];
  }



  const Vocabulary &
  place_and_time()
  {
    static const Vocabulary vocabulary{
      {Variable::X, Variable::Y, Variable::Z, Variable::t}};
    return vocabulary;
  }


  namespace
  {
    /** What every message about a text ends with. */
    std::string
    advice(const Vocabulary &vocabulary)
    {
      // Most keys have a place and the time alone, for which units can be said.
      const bool only_place =
        vocabulary.variables == place_and_time().variables &&
        vocabulary.constants.empty() && vocabulary.fields.empty();
      return " The variables are " +
             (only_place ? "X, Y, Z (um) and t (day)" : vocabulary.names()) +
             ", components are separated by ';'.";
    }

    /** What to do about variables that other keys have. */
    std::string
    remedy(const std::string &component, const Vocabulary &vocabulary)
    {
      std::string names;
      // A variable that exists, but not for this key, is the likely mistake.
      // Present coordinates are special: the initial ones do most of what users
      // want.
      for (unsigned int i = 0; i < n_variables; ++i)
        {
          const auto        variable = static_cast<Variable>(i);
          const std::string name     = name_of(variable);
          if (std::find(vocabulary.variables.begin(),
                        vocabulary.variables.end(),
                        variable) == vocabulary.variables.end() &&
              ExpressionSyntax::uses(component, name))
            {
              if (i >= static_cast<unsigned int>(Variable::x) &&
                  i <= static_cast<unsigned int>(Variable::z))
                return " Write " +
                       std::string(1,
                                   static_cast<char>(std::toupper(name[0]))) +
                       ", the initial position.";
              names += (names.empty() ? "" : ", ") + name;
            }
        }
      return names.empty() ? "" : " This key has no " + names + ".";
    }

    std::string
    component_name(const unsigned int component, const std::size_t n)
    {
      return n == 1 ? "" : "Component " + std::to_string(component + 1) + ", ";
    }

    template <int dim>
    Point<3>
    in_space(const Point<dim> &X)
    {
      Point<3> result;
      for (unsigned int d = 0; d < dim; ++d)
        result[d] = X[d];
      return result;
    }

    /** Sorts the variables and keeps each once. */
    void
    make_unique(std::vector<Variable> &variables)
    {
      std::sort(variables.begin(), variables.end());
      variables.erase(std::unique(variables.begin(), variables.end()),
                      variables.end());
    }

    /** "inf at (X, Y, Z) = (0, 1, 2) um, t = 3 day, J_e = 0.5." */
    std::string
    described(const double                 value,
              const std::vector<Variable> &used,
              const Vocabulary            &vocabulary,
              const VariableValues        &values)
    {
      std::ostringstream text;
      text << value << " at (X, Y, Z) = ("
           << Point<3>(values[0], values[1], values[2])
           << ") um, t = " << values[static_cast<unsigned int>(Variable::t)]
           << " day";
      for (const Variable variable : used)
        if (variable > Variable::t)
          text << ", " << vocabulary.name_of(variable) << " = "
               << values[static_cast<unsigned int>(variable)];
      text << '.';
      return text.str();
    }

    /** All components as plain numbers; empty if one is not. */
    std::vector<double>
    plain_numbers(const std::vector<std::string> &components)
    {
      std::vector<double> result(components.size());
      for (unsigned int c = 0; c < components.size(); ++c)
        if (!boost::conversion::try_lexical_convert(components[c], result[c]) ||
            !std::isfinite(result[c]))
          return {};
      return result;
    }

    void
    check_components(const std::string              &key,
                     const std::string              &text,
                     const std::vector<std::string> &components,
                     const unsigned int              n_max,
                     const unsigned int              n_min,
                     const std::string              &advice)
    {
      // The number of components is what the message says first, whatever the
      // fault.
      const std::string number =
        (n_min == n_max ?
           std::to_string(n_max) :
           std::to_string(n_min) + " to " + std::to_string(n_max)) +
        (n_max == 1 ? " expression" : " expressions separated by ';'");
      const auto refuse = [&](const std::string &what) {
        throw InputError(key, text, number, what + advice);
      };
      if (boost::trim_copy(text).empty())
        refuse("Write at least a number.");
      if (components.size() < n_min || components.size() > n_max)
        refuse("There are " + std::to_string(components.size()) + ".");
      // muParser would read some texts otherwise than they look; these are
      // refused with what to write instead.
      for (unsigned int c = 0; c < components.size(); ++c)
        {
          const std::string problem =
            components[c].empty() ?
              "there is nothing. Write 0 where nothing acts." :
              ExpressionSyntax::misreading(components[c]);
          if (!problem.empty())
            refuse(component_name(c, components.size()) + problem);
        }
    }
  } // namespace


  Expression::Expression(const std::string &key,
                         const std::string &text,
                         const unsigned int n_components,
                         const unsigned int min_components,
                         const Vocabulary  &vocabulary)
    : vocabulary_(std::make_shared<const Vocabulary>(vocabulary))
    , key_(key)
    , text_(text)
  {
    // The text is taken apart at its semicolons first. Plain numbers need no
    // parser, which is most of all keys: a run has some hundred of them. Other
    // components are parsed once, here, where a fault can be told with its
    // place; and an expression that uses no variables is evaluated once and for
    // all.
    const std::vector<std::string> components =
      ExpressionSyntax::components(text);
    check_components(key,
                     text,
                     components,
                     n_components,
                     std::min(min_components, n_components),
                     advice(vocabulary));

    constants = plain_numbers(components);
    if (!constants.empty())
      return;

    for (unsigned int c = 0; c < components.size(); ++c)
      try
        {
          parsers.push_back(
            std::make_shared<const ExpressionParser>(components[c],
                                                     vocabulary));
          for (const Variable variable : parsers.back()->used())
            used_.push_back(variable);
        }
      catch (const std::invalid_argument &error)
        {
          throw InputError(key,
                           text,
                           "an expression that muParser understands",
                           component_name(c, components.size()) + error.what() +
                             remedy(components[c], vocabulary) +
                             advice(vocabulary));
        }
    make_unique(used_);
    if (used_.empty())
      evaluate_once();
  }


  void
  Expression::evaluate_once()
  {
    std::vector<double> numbers;
    for (const auto &parser : parsers)
      numbers.push_back(parser->value(VariableValues()));
    // A value that is not finite is refused where it is asked for.
    if (std::all_of(numbers.begin(), numbers.end(), [](const double c) {
          return std::isfinite(c);
        }))
      constants = std::move(numbers);
  }


  Expression
  Expression::with_types(
    const std::map<unsigned int, Expression> &of_types) const
  {
    Expression result = *this;
    if (of_types.empty())
      return result;
    result.of_types = of_types;
    // The variables of all types count: who asks whether the expression depends
    // on something means any cell.
    for (const auto &[type, expression] : of_types)
      result.used_.insert(result.used_.end(),
                          expression.used_.begin(),
                          expression.used_.end());
    result.used_.push_back(Variable::type);
    make_unique(result.used_);
    return result;
  }


  template <int dim>
  double
  Expression::value(const Point<dim>  &X,
                    const double       t,
                    const unsigned int component) const
  {
    // Constants are looked up, without a parser.
    if (is_constant())
      return constants[component];
    check_dimension(dim);
    Assert(!depends_on_state(), ExcMessage(key_ + " needs a present cell."));
    VariableValues values;
    const Point<3> place = in_space(X);
    for (unsigned int d = 0; d < 3; ++d)
      values[d] = place[d];
    values[static_cast<unsigned int>(Variable::t)] = t;
    return value(values, component);
  }


  double
  Expression::value(const VariableValues &values,
                    const unsigned int    component) const
  {
    // A type with an expression of its own has its own rule as well.
    if (!of_types.empty())
      {
        const auto own = of_types.find(static_cast<unsigned int>(
          values[static_cast<unsigned int>(Variable::type)]));
        if (own != of_types.end())
          return own->second.value(values, component);
      }
    const double value = evaluate(values, component);
    // The message has all variables that the expression uses, as users cannot
    // know where it was evaluated.
    if (rule && !rule->holds(value))
      throw InputError(key_,
                       text_,
                       rule->allowed,
                       "It is " +
                         described(value, used_, *vocabulary_, values) + ' ' +
                         rule->remedy);
    return value;
  }


  double
  Expression::evaluate(const VariableValues &values,
                       const unsigned int    component) const
  {
    if (!constants.empty())
      return constants[component];
    // muParser returns infinities and NaN without a word. They would spread
    // through the tissue, so they end the run here.
    const double value = parsers[component]->value(values);
    if (!std::isfinite(value))
      throw InputError(key_,
                       text_,
                       "a finite value",
                       "It is " +
                         described(value, used_, *vocabulary_, values) +
                         " Change the expression so that it is finite there.");
    return value;
  }


  bool
  follows_state(const Variable variable)
  {
    // These change by themselves, or never, or at events only. Everything else
    // follows from the state of the cell.
    switch (variable)
      {
        case Variable::X:
        case Variable::Y:
        case Variable::Z:
        case Variable::t:
        case Variable::generation:
        case Variable::age:
        case Variable::type_age:
        case Variable::type:
        case Variable::depth:
        case Variable::noise:
          return false;
        default:
          return true;
      }
  }


  bool
  Expression::follows_state() const
  {
    return std::any_of(used_.begin(), used_.end(), [](const Variable variable) {
      return Morula::follows_state(variable);
    });
  }


  bool
  Expression::is_always(const double       number,
                        const unsigned int n_components) const
  {
    // All types must have the number, too.
    if (constants.size() < n_components ||
        std::any_of(constants.begin(),
                    constants.begin() + n_components,
                    [=](const double c) { return c != number; }))
      return false;
    return std::all_of(of_types.begin(), of_types.end(), [=](const auto &own) {
      return own.second.is_always(number, n_components);
    });
  }


  void
  Expression::check_dimension(const unsigned int dim) const
  {
    if (dim == 2 && (uses(Variable::Z) || uses(Variable::z)))
      throw InputError(
        key_,
        text_,
        "an expression without Z in 2-D",
        "The tissue lies in the plane of X and Y, and Z would be "
        "0 everywhere: write it with X and Y, or set Dimension "
        "= 3.");
  }


  template double
  Expression::value(const Point<2> &, const double, const unsigned int) const;
  template double
  Expression::value(const Point<3> &, const double, const unsigned int) const;
} // namespace Morula
