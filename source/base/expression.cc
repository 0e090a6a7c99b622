// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/expression.h>
#include <morula/base/expression_syntax.h>
#include <morula/base/input_error.h>

#include <deal.II/base/function_parser.h>
#include <deal.II/base/utilities.h>

#include <boost/algorithm/string.hpp>
#include <boost/io/ios_state.hpp>
#include <boost/lexical_cast/try_lexical_convert.hpp>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <sstream>

namespace Morula
{
  /**
   * A FunctionParser that takes the time as an argument: its own is a state of
   * the object, which threads would share.
   */
  class Expression::Parser : public FunctionParser<3>
  {
  public:
    explicit Parser(const std::vector<std::string> &components)
      : FunctionParser<3>(components.size())
    {
      initialize("X,Y,Z,t",
                 components,
                 {{"pi", numbers::PI}, {"Pi", numbers::PI}},
                 /*time_dependent=*/true);
    }

    double
    value_at(const Point<3>    &X,
             const double       t,
             const unsigned int component) const
    {
      return do_value(X, t, component);
    }
  };


  namespace
  {
    const std::string advice =
      " The variables are X, Y, Z (um) and t (day), components are separated "
      "by ';'.";

    std::string
    component_name(const unsigned int component, const std::size_t n)
    {
      return n == 1 ? "" : "Component " + std::to_string(component + 1) + ", ";
    }

    /**
     * The place in @p component and the reason from what deal.II writes about
     * muParser's error: "Message:  <...>", ..., "Position: <...>", counted from
     * 0 and at most one behind the end (deal.II appends a blank).
     */
    std::string
    diagnosis(const std::string &component, const std::string &report)
    {
      // What stands in <> behind a name, on its line. Regular expressions would
      // recurse once for each character of a long line.
      const auto behind = [&report](const std::string &name) -> std::string {
        const auto at    = report.find(name);
        const auto begin = report.find('<', at);
        if (at == std::string::npos || begin == std::string::npos)
          return "";
        const auto end = report.rfind('>', report.find('\n', begin));
        return end > begin && end != std::string::npos ?
                 report.substr(begin + 1, end - begin - 1) :
                 "";
      };
      std::string       text;
      std::size_t       position = 0;
      const std::string place    = behind("Position:");
      if (boost::conversion::try_lexical_convert(place, position))
        text = "character " +
               std::to_string(
                 1 + ExpressionSyntax::position_without_blanks(component,
                                                               position)) +
               ": ";
      std::string message = behind("Message:");
      message             = message.substr(0, message.find(" at position"));
      if (boost::ends_with(message, " found"))
        message.erase(message.size() - std::string(" found").size());
      text += message.empty() ? "it cannot be parsed" : message;
      return text + ".";
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
                     const unsigned int              n_min)
    {
      const std::string number =
        (n_min == n_max ?
           std::to_string(n_max) :
           std::to_string(n_min) + " to " + std::to_string(n_max)) +
        (n_max == 1 ? " expression" : " expressions separated by ';'");
      if (boost::trim_copy(text).empty())
        throw InputError(key,
                         text,
                         number,
                         "Write at least a number." + advice);
      if (components.size() < n_min || components.size() > n_max)
        throw InputError(key,
                         text,
                         number,
                         "There are " + std::to_string(components.size()) +
                           "." + advice);
      for (unsigned int c = 0; c < components.size(); ++c)
        {
          const std::string problem =
            components[c].empty() ?
              "there is nothing. Write 0 where nothing acts." :
              ExpressionSyntax::misunderstanding(components[c]);
          if (!problem.empty())
            throw InputError(key,
                             text,
                             number,
                             component_name(c, components.size()) + problem +
                               advice);
        }
    }
  } // namespace


  Expression::Expression(const std::string &key,
                         const std::string &text,
                         const unsigned int n_components,
                         const unsigned int min_components)
    : key_(key)
    , text_(text)
    , uses_Z(ExpressionSyntax::uses(text, "Z"))
  {
    const std::vector<std::string> components =
      ExpressionSyntax::components(text);
    check_components(key,
                     text,
                     components,
                     n_components,
                     std::min(min_components, n_components));

    constants = plain_numbers(components);
    if (!constants.empty())
      return;

    std::vector<std::string> readable;
    for (const std::string &component : components)
      readable.push_back(ExpressionSyntax::with_blanks(component));
    parser = std::make_shared<const Parser>(readable);
    for (unsigned int c = 0; c < components.size(); ++c)
      {
        // deal.II writes muParser's report to the standard error before it
        // throws, and only there is the position
        std::ostringstream report;
        try
          {
            const boost::io::ios_rdbuf_saver saver(std::cerr, report.rdbuf());
            Parser({readable[c]}).value_at(Point<3>(), 0., 0);
          }
        catch (const std::exception &)
          {
            throw InputError(key,
                             text,
                             "an expression that muParser understands",
                             component_name(c, components.size()) +
                               diagnosis(components[c], report.str()) + advice);
          }
      }
  }


  template <int dim>
  double
  Expression::value(const Point<dim>  &X,
                    const double       t,
                    const unsigned int component) const
  {
    if (!constants.empty())
      return constants[component];
    check_dimension(dim);
    const double value = parser->value_at(in_space(X), t, component);
    if (!std::isfinite(value))
      {
        std::ostringstream place;
        place << "It is " << value << " at (X, Y, Z) = (" << in_space(X)
              << ") um, t = " << t
              << " day. Change the expression so that it is finite there.";
        throw InputError(key_, text_, "a finite value", place.str());
      }
    return value;
  }


  template <int dim>
  Tensor<1, dim>
  Expression::vector(const Point<dim> &X, const double t) const
  {
    Tensor<1, dim> result;
    for (unsigned int d = 0; d < dim; ++d)
      result[d] = value(X, t, d);
    return result;
  }


  bool
  Expression::is_constant() const
  {
    return !constants.empty();
  }


  bool
  Expression::depends_on_time() const
  {
    return ExpressionSyntax::uses(text_, "t");
  }


  void
  Expression::check_dimension(const unsigned int dim) const
  {
    if (dim == 2 && uses_Z)
      throw InputError(
        key_,
        text_,
        "an expression without Z in 2-D",
        "The tissue lies in the plane of X and Y, and Z would be "
        "0 everywhere: write it with X and Y, or set Dimension "
        "= 3.");
  }


  const std::string &
  Expression::key() const
  {
    return key_;
  }


  const std::string &
  Expression::text() const
  {
    return text_;
  }


  template double
  Expression::value(const Point<2> &, const double, const unsigned int) const;
  template double
  Expression::value(const Point<3> &, const double, const unsigned int) const;
  template Tensor<1, 2>
  Expression::vector(const Point<2> &, const double) const;
  template Tensor<1, 3>
  Expression::vector(const Point<3> &, const double) const;
} // namespace Morula
