// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/expression_parser.h>
#include <morula/base/name_list.h>

#include <deal.II/base/numbers.h>

#include <boost/algorithm/string.hpp>
#include <boost/math/special_functions/erf.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <regex>
#include <stdexcept>
#include <vector>

namespace Morula
{
  namespace
  {
    std::string
    at(const std::size_t position)
    {
      return "Character " + std::to_string(position + 1) + ": ";
    }

    /** Length of the comparison <, <=, >, >= that begins at @p i, or 0. */
    unsigned int
    comparison_length(const std::string &s, const std::size_t i)
    {
      if (s[i] != '<' && s[i] != '>')
        return 0;
      return i + 1 < s.size() && s[i + 1] == '=' ? 2 : 1;
    }

    /** Whether a name may have this character. */
    bool
    is_of_name(const char c)
    {
      return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
    }

    /** Whether the blank at @p i stands between a name and a parenthesis. */
    bool
    ends_name_of_call(const std::string &s, const std::size_t i)
    {
      const std::size_t before = s.find_last_not_of(' ', i);
      const std::size_t behind = s.find_first_not_of(' ', i);
      return before != std::string::npos && is_of_name(s[before]) &&
             behind != std::string::npos && s[behind] == '(';
    }

    /** Position of the second comparison of a chain such as 0 < X < 5. */
    std::size_t
    find_chain(const std::string &s)
    {
      // In a chain muParser would compare the truth of the first comparison
      // with the next number. A comparison is allowed once in each pair of
      // parentheses and between logical operators.
      std::vector<bool> compared(1, false); // one for each open parenthesis
      for (std::size_t i = 0; i < s.size(); ++i)
        if (const unsigned int length = comparison_length(s, i))
          {
            if (compared.back())
              return i;
            compared.back() = true;
            i += length - 1;
          }
        else if (s[i] == '(')
          compared.push_back(false);
        else if (s[i] == ')' && compared.size() > 1)
          compared.pop_back();
        // These operators begin a new comparison.
        else if (std::string("&|?:,=!").find(s[i]) != std::string::npos)
          compared.back() = false;
      return std::string::npos;
    }

    std::size_t
    find_outer_comma(const std::string &s)
    {
      // A decimal comma looks like this, too.
      int depth = 0;
      for (std::size_t i = 0; i < s.size(); ++i)
        if (s[i] == '(')
          ++depth;
        else if (s[i] == ')')
          --depth;
        else if (s[i] == ',' && depth <= 0)
          return i;
      return std::string::npos;
    }

    std::size_t
    find_assignment(const std::string &s)
    {
      // A single '=' that is part of none of <=, >=, == and !=.
      static const std::regex assignment("(^|[^<>!=])=($|[^=])");
      std::smatch             match;
      return std::regex_search(s, match, assignment) ?
               match.position(0) + match.length(1) :
               std::string::npos;
    }

    /** A component, rewritten so that muParser reads it correctly. */
    struct Readable
    {
      std::string text;
      /** Where each of its characters, and its end, stands in the component,
       *  counted from 0. */
      std::vector<std::size_t> positions;
    };

    /**
     * Rewrites one component for muParser. It puts a blank behind each && and
     * ||: deal.II adds the operators & and | to muParser's own, which then
     * reads the
     * || of X<1||Y<1 as | and |Y. It removes blanks between a function and its
     * parenthesis, since muParser allows none there.
     */
    Readable
    make_readable(const std::string &component)
    {
      // What is changed is noted by position, so that messages can name the
      // character in the user's text.
      Readable   result;
      const auto append = [&](const char c, const std::size_t i) {
        result.text += c;
        result.positions.push_back(i);
      };
      for (std::size_t i = 0; i < component.size(); ++i)
        {
          if (component[i] == ' ' && ends_name_of_call(component, i))
            continue;
          append(component[i], i);
          // && or || ends here.
          if (i > 0 && component[i] == component[i - 1] &&
              (component[i] == '&' || component[i] == '|'))
            append(' ', i + 1);
        }
      result.positions.push_back(component.size());
      return result;
    }
  } // namespace


  std::vector<std::string>
  ExpressionSyntax::components(const std::string &text)
  {
    std::vector<std::string> result;
    boost::split(result, text, boost::is_any_of(";"));
    for (std::string &component : result)
      boost::trim(component);
    return result;
  }


  bool
  ExpressionSyntax::uses(const std::string &text, const std::string &name)
  {
    // A regular expression would be longer in the making than the search takes,
    // and a run asks some hundred times before its first step.
    for (auto i = text.find(name); i != std::string::npos;
         i      = text.find(name, i + 1))
      {
        const std::size_t end = i + name.size();
        if ((i == 0 || !is_of_name(text[i - 1])) &&
            (end == text.size() || !is_of_name(text[end])))
          return true;
      }
    return false;
  }


  std::string
  ExpressionSyntax::misreading(const std::string &component)
  {
    // Each is a text that muParser accepts with another meaning.
    if (const auto i = find_outer_comma(component); i != std::string::npos)
      return at(i) + "a comma outside parentheses. Write decimals with a "
                     "point and separate components by ';'.";
    if (const auto i = find_assignment(component); i != std::string::npos)
      return at(i) + "a single '='. Compare with '==', '<=' or '>='.";
    if (const auto i = find_chain(component); i != std::string::npos)
      return at(i) + "a chain of comparisons. Join them: 0 < X && X < 5.";
    if (uses(component, "rand") || uses(component, "rand_seed"))
      return "Random numbers would change with every evaluation. Use a function "
             "of X, Y, Z, t; 'Random seed' governs what is random.";
    return "";
  }


  namespace
  {
    /** What deal.II's FunctionParser takes for true: what rounds to another
     *  integer than 0. */
    bool
    is_true(const double value)
    {
      return std::abs(value) >= 0.5;
    }

    double
    rounded(const double value)
    {
      return std::trunc(value < 0. ? value - 0.5 : value + 0.5);
    }

    /** s^n / (half^n + s^n), 0 for s <= 0. */
    double
    // Written so, a large n makes no overflow of s^n, and s <= 0 is no special
    // case of pow().
    hill(const double s, const double half, const double n)
    {
      return s > 0. ? 1. / (1. + std::pow(half / s, n)) : 0.;
    }

    /** 0 up to a, 1 from b on, linear in between. */
    double
    ramp(const double s, const double a, const double b)
    {
      return std::clamp((s - a) / (b - a), 0., 1.);
    }

    /** The value of a normally distributed number whose distribution function
     *  is there the cell's own number, to which @p noise points. */
    double
    normal(void *const noise, const double mean, const double deviation)
    {
      // What is no number is refused where expressions are evaluated, so Boost
      // need not throw.
      using namespace boost::math::policies;
      using Silent =
        policy<domain_error<ignore_error>, overflow_error<ignore_error>>;
      return mean +
             deviation * std::sqrt(2.) *
               boost::math::erf_inv(2. * *static_cast<double *>(noise) - 1.,
                                    Silent());
    }

    /** Adds what deal.II's FunctionParser has besides muParser's own. */
    void
    add_functions(mu::Parser &parser)
    {
      // Scenes were written for deal.II's FunctionParser at first, so its names
      // must go on to work, with its meanings.
      parser.DefineConst("pi", dealii::numbers::PI);
      parser.DefineConst("Pi", dealii::numbers::PI);
      parser.DefineConst("true", 1.);
      parser.DefineConst("false", 0.);
      parser.DefineOprt(
        "|",
        +[](const double a, const double b) {
          return double(is_true(a) || is_true(b));
        },
        1);
      parser.DefineOprt(
        "&",
        +[](const double a, const double b) {
          return double(is_true(a) && is_true(b));
        },
        2);
      parser.DefineFun(
        // muParser's own "if" is the operator "? :".
        "if",
        +[](const double a, const double b, const double c) {
          return is_true(a) ? b : c;
        });
      const auto define = [&parser](const char *name, double (*f)(double)) {
        parser.DefineFun(name, f);
      };
      define("int", rounded);
      define("ceil", [](const double a) { return std::ceil(a); });
      define("floor", [](const double a) { return std::floor(a); });
      define("cot", [](const double a) { return 1. / std::tan(a); });
      define("csc", [](const double a) { return 1. / std::sin(a); });
      define("sec", [](const double a) { return 1. / std::cos(a); });
      define("log", [](const double a) { return std::log(a); });
      define("erfc", [](const double a) { return std::erfc(a); });
      parser.DefineFun(
        "pow", +[](const double a, const double b) { return std::pow(a, b); });
      parser.DefineFun("hill", hill);
      parser.DefineFun("ramp", ramp);
    }

    /** What a word that the parser does not know may have been meant to be. */
    std::string
    guess(const mu::Parser &parser, const std::string &token)
    {
      std::string word;
      for (const char c : token)
        if (std::isalnum(static_cast<unsigned char>(c)) || c == '_')
          word += c;
        else
          break;
      if (word.empty() || std::isdigit(static_cast<unsigned char>(word[0])))
        return "";
      std::vector<std::string> names;
      for (const auto &[name, function] : parser.GetFunDef())
        names.push_back(name);
      for (const auto &[name, value] : parser.GetConst())
        names.push_back(name);
      for (const auto &[name, place] : parser.GetVar())
        names.push_back(name);
      if (parser.GetFunDef().count(word) > 0)
        return " Write what it is a function of in parentheses, as in " + word +
               "(X).";
      // Of equally similar ones the shortest: sin, not sign, for sinn.
      std::stable_sort(names.begin(),
                       names.end(),
                       [](const std::string &a, const std::string &b) {
                         return a.size() < b.size();
                       });
      if (const std::string best = most_similar(word, names); !best.empty())
        return " Did you mean '" + best + "'?";
      return " If it is a field or a number of cells, Fields/Names or Cell "
             "numbers/Names must have it; functions are those of muParser, "
             "with ramp, hill and if; numbers have no unit.";
    }
  } // namespace


  bool
  is_free_name(const std::string &name)
  {
    // A name is free if it is no variable of any key, no function and no
    // constant: else an expression could not tell them apart.
    for (unsigned int i = 0; i < n_variables; ++i)
      if (name == name_of(static_cast<Variable>(i)))
        return false;
    mu::Parser parser;
    add_functions(parser);
    return name != "normal" && parser.GetFunDef().count(name) == 0 &&
           parser.GetConst().count(name) == 0;
  }


  ExpressionParser::ExpressionParser(const std::string &text,
                                     const Vocabulary  &vocabulary)
  {
    // Variables are places in an array that this object owns; value() fills in
    // those that the text uses. The text is made readable for muParser first,
    // and evaluated once, since that is what finds unknown names and wrong
    // numbers of arguments. A fault is reported by its place in the text as the
    // user wrote it.
    add_functions(parser);
    const std::vector<Variable> variables = vocabulary.all_variables();
    for (const Variable variable : variables)
      {
        // muParser reads the value from here.
        double *const place = &places[static_cast<unsigned int>(variable)];
        parser.DefineVar(vocabulary.name_of(variable), place);
        // normal(mean, deviation) takes the cell's own number.
        if (variable == Variable::noise)
          {
            parser.DefineFunUserData("normal", normal, place, false);
            if (ExpressionSyntax::uses(text, "normal"))
              used_.push_back(variable);
          }
      }
    for (const auto &[name, value] : vocabulary.constants)
      parser.DefineConst(name, value);
    const Readable readable = make_readable(text);
    try
      {
        parser.SetExpr(readable.text);
        parser.Eval(); // GetUsedVar() takes unknown functions for variables
        for (const auto &[name, place] : parser.GetUsedVar())
          {
            const auto variable =
              std::find_if(variables.begin(),
                           variables.end(),
                           [&, &name = name](const Variable v) {
                             return name == vocabulary.name_of(v);
                           });
            if (variable != variables.end())
              used_.push_back(*variable);
          }
      }
    catch (const mu::Parser::exception_type &error)
      {
        // muParser's message names a place in its own text, which is replaced
        // by that in the user's.
        std::string message = error.GetMsg();
        message             = message.substr(0, message.find(" at position"));
        if (boost::ends_with(message, " found"))
          message.erase(message.size() - std::string(" found").size());
        const std::size_t place =
          std::min<std::size_t>(error.GetPos(), readable.text.size());
        throw std::invalid_argument(
          "character " + std::to_string(1 + readable.positions[place]) + ": " +
          message + "." + guess(parser, error.GetToken()));
      }
    std::sort(used_.begin(), used_.end());
    used_.erase(std::unique(used_.begin(), used_.end()), used_.end());
  }


  // 9 * 0.05 is a little more than 0.45, and 3 * 0.1 a little more than 0.3.
  double
  decimal(const double t)
  {
    constexpr double places = 1e10; // a power of ten that a double holds
    // Of products and sums of a step's length, not of times in between.
    constexpr double rounding = 16. * std::numeric_limits<double>::epsilon();
    if (!(std::abs(t) < 1e5))
      return t;
    const double nearest = std::round(places * t) / places;
    return std::abs(nearest - t) <= rounding * std::abs(t) ? nearest : t;
  }

  double
  ExpressionParser::value(const VariableValues &values) const
  {
    // Only what the text uses is copied, as this is called for every cell.
    for (const Variable variable : used_)
      {
        const auto i = static_cast<unsigned int>(variable);
        places[i]    = variable == Variable::t ? decimal(values[i]) : values[i];
      }
    return parser.Eval();
  }
} // namespace Morula
