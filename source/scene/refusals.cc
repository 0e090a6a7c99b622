// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/scene/refusals.h>

#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <sstream>

namespace Morula::Refusals
{
  std::string
  as_text(const double value)
  {
    std::ostringstream out;
    out << value;
    return out.str();
  }


  void
  refuse_unless(const bool         valid,
                const std::string &key,
                const double       value,
                const std::string &allowed,
                const std::string &remedy)
  {
    if (!valid)
      throw InputError(key, as_text(value), allowed, remedy);
  }


  void
  refuse_constant_unless(const Sign         sign,
                         const std::string &unit,
                         const Expression  &expression,
                         const std::string &remedy)
  {
    if (!expression.is_constant())
      return;
    const bool   zero_is_allowed = sign == Sign::not_negative;
    const double value           = expression.value(Point<3>(), 0.);
    if (value < 0. || (value == 0. && !zero_is_allowed))
      throw InputError(expression.key(),
                       expression.text(),
                       (zero_is_allowed ? "a value >= 0 " : "a value > 0 ") +
                         unit,
                       remedy);
  }


  Expression
  in_space_only(const std::string &key,
                const std::string &text,
                const unsigned int dim)
  {
    const Expression expression(key, text);
    expression.check_dimension(dim);
    if (expression.depends_on_time())
      throw InputError(key,
                       text,
                       "an expression of X, Y, Z",
                       "It is evaluated once, at t = 0: remove t.");
    return expression;
  }


  bool
  same_value(const std::string &a, const std::string &b)
  {
    const auto constant_components = [](const std::string &text) {
      std::vector<double> values;
      try
        {
          const auto       n = 1 + std::count(text.begin(), text.end(), ';');
          const Expression expression("", text, n);
          for (unsigned int c = 0; expression.is_constant() && c < n; ++c)
            values.push_back(expression.value(Point<3>(), 0., c));
        }
      catch (const InputError &)
        {
          values.clear();
        }
      return values;
    };
    const std::vector<double> x = constant_components(a);
    const std::vector<double> y = constant_components(b);
    if (!x.empty() && !y.empty())
      return std::equal(x.begin(),
                        x.begin() + std::min(x.size(), y.size()),
                        y.begin());
    return boost::erase_all_copy(a, " ") == boost::erase_all_copy(b, " ");
  }


  void
  refuse_forgotten(const Scene       &scene,
                   const std::string &switch_key,
                   const std::string &key,
                   const std::string &value,
                   const bool         is_needed,
                   const std::string &remedy)
  {
    if (!is_needed && scene.as_written.count(switch_key) == 0)
      throw InputError(key,
                       value,
                       "its default, as " + switch_key + " is not set",
                       remedy + ", or remove this key.");
  }
} // namespace Morula::Refusals
