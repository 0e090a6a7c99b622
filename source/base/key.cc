// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/expression.h>
#include <morula/base/input_error.h>
#include <morula/base/key.h>

#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <sstream>
#include <type_traits>

namespace Morula
{
  AnyKey::AnyKey(const std::string &path,
                 const std::string &default_text,
                 const std::string &documentation)
    : path_(path)
    , default_text_(default_text)
    , documentation_(documentation)
  {}


  void
  AnyKey::place_in(const std::string &section)
  {
    path_ = section + "/" + path_;
  }


  void
  AnyKey::add_documentation(const std::string &text)
  {
    documentation_ += text;
  }


  std::string
  AnyKey::unit() const
  {
    // The unit is the last sentence of the documentation.
    const std::string word  = "Units: ";
    const auto        begin = documentation_.rfind(word);
    return begin == std::string::npos ?
             "" :
             boost::trim_right_copy_if(documentation_.substr(begin +
                                                             word.size()),
                                       boost::is_any_of("."));
  }


  bool
  AnyKey::is_default() const
  {
    return same_value(text(), default_text_);
  }


  void
  AnyKey::declare(ParameterHandler &prm)
  {
    std::vector<std::string> names;
    boost::split(names, path_, boost::is_any_of("/"));
    for (std::size_t i = 0; i + 1 < names.size(); ++i)
      prm.enter_subsection(names[i]);
    prm.declare_entry(names.back(), default_text_, *pattern(), documentation_);
    // deal.II calls an action at once, with the default value; that one must
    // not count as set.
    const auto is_declared = std::make_shared<bool>(false);
    prm.add_action(names.back(), [this, is_declared](const std::string &value) {
      if (*is_declared)
        assign(value);
    });
    *is_declared = true;
    for (std::size_t i = 0; i + 1 < names.size(); ++i)
      prm.leave_subsection();
  }


  void
  AnyKey::refuse(const std::string &allowed, const std::string &remedy) const
  {
    throw InputError(path_, shown(), allowed, remedy);
  }


  namespace
  {
    std::vector<std::string>
    words_of(const std::string &words)
    {
      std::vector<std::string> list;
      if (!words.empty())
        boost::split(list, words, boost::is_any_of("|"));
      return list;
    }

    // One set of functions for each type of value.

    std::unique_ptr<Patterns::PatternBase>
    pattern_of(const Limits<std::string> &limits)
    {
      if (limits.words.empty())
        return std::make_unique<Patterns::Anything>();
      return std::make_unique<Patterns::Selection>(limits.words);
    }

    std::unique_ptr<Patterns::PatternBase>
    pattern_of(const Limits<double> &limits)
    {
      return std::make_unique<Patterns::Double>(limits.smallest);
    }

    std::unique_ptr<Patterns::PatternBase>
    pattern_of(const Limits<unsigned int> &limits)
    {
      return std::make_unique<Patterns::Integer>(limits.smallest,
                                                 limits.largest);
    }

    std::unique_ptr<Patterns::PatternBase>
    pattern_of(const Limits<bool> &)
    {
      return std::make_unique<Patterns::Bool>();
    }

    std::unique_ptr<Patterns::PatternBase>
    pattern_of(const Limits<std::vector<double>> &limits)
    {
      return std::make_unique<Patterns::List>(Patterns::Double(),
                                              limits.fewest,
                                              limits.most);
    }

    std::unique_ptr<Patterns::PatternBase>
    pattern_of(const Limits<std::vector<std::string>> &limits)
    {
      return std::make_unique<Patterns::List>(Patterns::Selection(limits.words),
                                              1);
    }

    std::string
    phrase_of(const Limits<std::string> &limits)
    {
      return limits.words.empty() ?
               "" :
               "any one of " + boost::join(words_of(limits.words), ", ");
    }

    std::string
    phrase_of(const Limits<double> &limits)
    {
      return limits.smallest == Patterns::Double::min_double_value ?
               "a number" :
               "a number >= " + as_text(limits.smallest);
    }

    std::string
    phrase_of(const Limits<unsigned int> &limits)
    {
      return limits.largest == Patterns::Integer::max_int_value ?
               "an integer >= " + std::to_string(limits.smallest) :
               "an integer from " + std::to_string(limits.smallest) + " to " +
                 std::to_string(limits.largest);
    }

    std::string
    phrase_of(const Limits<bool> &)
    {
      return "a boolean value (true or false)";
    }

    std::string
    phrase_of(const Limits<std::vector<double>> &limits)
    {
      const std::string n = limits.most == Patterns::List::max_int_value ?
                              "" :
                              " of " + std::to_string(limits.fewest) + " to " +
                                std::to_string(limits.most) + " elements";
      return "a list" + n + " separated by commas, each a number";
    }

    std::string
    phrase_of(const Limits<std::vector<std::string>> &limits)
    {
      return "a list separated by commas, each any one of " +
             boost::join(words_of(limits.words), ", ");
    }

    template <typename T>
    std::string
    to_text(const T &value)
    {
      if constexpr (std::is_same<T, std::string>::value)
        return value;
      else
        return Patterns::Tools::to_string(value);
    }
  } // namespace


  template <typename T>
  Key<T>::Key(const std::string &path,
              const T           &default_value,
              const std::string &documentation,
              const Limits<T>   &limits)
    : AnyKey(path, to_text(default_value), documentation)
    , value_(default_value)
    , assigned(default_value)
    , text_(default_text())
    , limits(limits)
  {}


  template <typename T>
  Key<T> &
  Key<T>::require(const std::function<bool(const T &)> &rule,
                  const std::string                    &allowed,
                  const std::string                    &remedy)
  {
    rules.push_back({rule, allowed, remedy});
    return *this;
  }


  template <typename T>
  Key<T> &
  Key<T>::with(const std::string &method, const std::string &text)
  {
    with_method[method] = text;
    return *this;
  }


  template <typename T>
  Key<T> &
  Key<T>::formerly(const std::string &path)
  {
    former_paths_.push_back(path);
    return *this;
  }


  template <typename T>
  Key<T> &
  Key<T>::of_file()
  {
    names_file_ = true;
    return *this;
  }


  template <typename T>
  void
  Key<T>::add_word(const std::string &word)
  {
    if constexpr (std::is_same<T, std::string>::value)
      limits.words += (limits.words.empty() ? "" : "|") + word;
    else
      AssertThrow(false, ExcInternalError());
  }


  template <typename T>
  std::string
  Key<T>::text() const
  {
    // The text stays as the user wrote it, unless a program has set another
    // value since.
    return value_ == assigned ? text_ : to_text(value_);
  }


  template <typename T>
  void
  Key<T>::assign(const std::string &text)
  {
    // deal.II's pattern converts the text; assigned tells later changes by a
    // program from this one.
    value_   = Patterns::Tools::Convert<T>::to_value(text, *pattern());
    assigned = value_;
    text_    = text;
  }


  template <typename T>
  std::unique_ptr<Patterns::PatternBase>
  Key<T>::pattern() const
  {
    return pattern_of(limits);
  }


  template <typename T>
  std::string
  Key<T>::allowed() const
  {
    return phrase_of(limits);
  }


  template <typename T>
  std::vector<std::string>
  Key<T>::choices() const
  {
    if constexpr (std::is_same<T, std::string>::value ||
                  std::is_same<T, std::vector<std::string>>::value)
      return words_of(limits.words);
    else if constexpr (std::is_same<T, bool>::value)
      return {"true", "false"};
    else
      return {};
  }


  template <typename T>
  bool
  Key<T>::is_of_numbers() const
  {
    return std::is_same<T, double>::value ||
           std::is_same<T, std::vector<double>>::value;
  }


  template <typename T>
  void
  Key<T>::check(const unsigned int) const
  {
    for (const Rule &rule : rules)
      if (!rule.holds(value_))
        refuse(rule.allowed, rule.remedy);
  }


  template <typename T>
  std::string
  Key<T>::shown() const
  {
    return to_text(value_);
  }


  template class Key<double>;
  template class Key<unsigned int>;
  template class Key<bool>;
  template class Key<std::string>;
  template class Key<std::vector<double>>;
  template class Key<std::vector<std::string>>;


  std::vector<const AnyKey *>
  Keys::list() const
  {
    // list() has no const form, since keys are also listed to be set.
    const KeyList keys = const_cast<Keys *>(this)->list();
    return {keys.begin(), keys.end()};
  }


  void
  Keys::declare(ParameterHandler &prm)
  {
    for (AnyKey *key : list())
      key->declare(prm);
  }


  void
  Keys::check_each(const unsigned int dim) const
  {
    for (const AnyKey *key : list())
      key->check(dim);
  }


  bool
  same_value(const std::string &a, const std::string &b)
  {
    // "1.0" and "1" are the same value, and so are "2*3" and "6". Texts that
    // are no constants are compared without blanks.
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


  std::string
  as_text(const double value)
  {
    std::ostringstream out;
    out << value;
    return out.str();
  }
} // namespace Morula
