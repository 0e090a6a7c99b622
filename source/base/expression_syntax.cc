// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/expression_syntax.h>

#include <boost/algorithm/string.hpp>

#include <cctype>
#include <regex>
#include <vector>

namespace Morula::ExpressionSyntax
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

    /** Whether && or || ends at @p i. */
    bool
    ends_logical(const std::string &s, const std::size_t i)
    {
      return i > 0 && s[i] == s[i - 1] && (s[i] == '&' || s[i] == '|');
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

    /** Whether an operator that begins a new comparison stands at @p i. */
    bool
    separates_comparisons(const std::string &s, const std::size_t i)
    {
      return std::string("&|?:,=!").find(s[i]) != std::string::npos;
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
        else if (separates_comparisons(s, i))
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
  } // namespace


  std::vector<std::string>
  components(const std::string &text)
  {
    std::vector<std::string> result;
    boost::split(result, text, boost::is_any_of(";"));
    for (std::string &component : result)
      boost::trim(component);
    return result;
  }


  bool
  uses(const std::string &text, const std::string &name)
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


  Readable
  readable(const std::string &component)
  {
    // muParser wants no blank between a function's name and its parenthesis,
    // and reads the || of X<1||Y<1 as | and |Y, so it gets a blank behind.
    // normal() gets the cell's own number as its first argument. What is
    // changed is noted by position, so that messages can name the character in
    // the user's text.
    static const std::regex normal("normal *\\(");
    Readable                result;
    const auto append = [&](const std::string &text, const std::size_t i) {
      result.text += text;
      result.positions.resize(result.text.size(), i);
    };
    for (std::size_t i = 0; i < component.size(); ++i)
      {
        const bool begins_name =
          // A call is looked for only where a name begins, so that
          // abnormal(...) is none.
          is_of_name(component[i]) && (i == 0 || !is_of_name(component[i - 1]));
        std::smatch call;
        if (begins_name &&
            std::regex_search(component.begin() + i,
                              component.end(),
                              call,
                              normal,
                              std::regex_constants::match_continuous))
          {
            append("normal(noise, ", i);
            i += call.length() - 1;
            continue;
          }
        if (component[i] == ' ' && ends_name_of_call(component, i))
          continue;
        append({component[i]}, i);
        if (ends_logical(component, i))
          append(" ", i + 1);
      }
    result.positions.push_back(component.size());
    return result;
  }


  std::string
  misreading(const std::string &component)
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
} // namespace Morula::ExpressionSyntax
