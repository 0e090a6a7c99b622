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
  AnyKey::AnyKey(const KeyPath     &path,
                 const std::string &default_text,
                 const std::string &documentation)
    : path_(path.path)
    , default_text_(default_text)
    , documentation_(documentation)
  {
    if (path.keys != nullptr)
      path.keys->offsets.push_back(reinterpret_cast<char *>(this) -
                                   reinterpret_cast<char *>(path.keys));
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
  AnyKey::declare(ParameterHandler &prm) const
  {
    std::vector<std::string> names;
    boost::split(names, path_, boost::is_any_of("/"));
    for (std::size_t i = 0; i + 1 < names.size(); ++i)
      prm.enter_subsection(names[i]);
    prm.declare_entry(names.back(), text(), *pattern(), documentation_);
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
  Key<T>::Key(const KeyPath     &path,
              const T           &default_value,
              const std::string &documentation,
              const Limits      &limits,
              const Rule<T>     &rule)
    : AnyKey(path, to_text(default_value), documentation)
    , value_(default_value)
    , assigned(default_value)
    , text_(default_text())
    , limits(limits)
  {
    if (rule.holds)
      rules.push_back(rule);
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
    using namespace Patterns;
    if constexpr (std::is_same<T, double>::value)
      return std::make_unique<Double>(limits.smallest, limits.largest);
    else if constexpr (std::is_same<T, unsigned int>::value)
      return std::make_unique<Integer>(limits.fewest(), limits.most());
    else if constexpr (std::is_same<T, bool>::value)
      return std::make_unique<Bool>();
    else if constexpr (std::is_same<T, std::vector<double>>::value)
      return std::make_unique<List>(Double(), limits.fewest(), limits.most());
    else if constexpr (std::is_same<T, std::vector<std::string>>::value)
      return std::make_unique<List>(Selection(limits.words), 1);
    else if (limits.words.empty())
      return std::make_unique<Anything>();
    else
      return std::make_unique<Selection>(limits.words);
  }


  template <typename T>
  std::string
  Key<T>::allowed() const
  {
    const std::string words = boost::join(words_of(limits.words), ", ");
    const std::string bounds =
      std::to_string(limits.fewest()) + " to " + std::to_string(limits.most());
    if constexpr (std::is_same<T, double>::value)
      return limits.smallest == -Limits::unlimited ?
               "a number" :
               "a number >= " + as_text(limits.smallest);
    else if constexpr (std::is_same<T, unsigned int>::value)
      return limits.largest == Limits::unlimited ?
               "an integer >= " + std::to_string(limits.fewest()) :
               "an integer from " + bounds;
    else if constexpr (std::is_same<T, bool>::value)
      return "a boolean value (true or false)";
    else if constexpr (std::is_same<T, std::vector<double>>::value)
      return "a list" +
             (limits.largest == Limits::unlimited ?
                "" :
                " of " + bounds + " elements") +
             " separated by commas, each a number";
    else if constexpr (std::is_same<T, std::vector<std::string>>::value)
      return "a list separated by commas, each any one of " + words;
    else
      return words.empty() ? "" : "any one of " + words;
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
  void
  Key<T>::check(const unsigned int) const
  {
    for (const Rule<T> &rule : rules)
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


  KeyList
  Keys::list()
  {
    KeyList keys;
    for (const std::ptrdiff_t offset : offsets)
      keys.push_back(
        reinterpret_cast<AnyKey *>(reinterpret_cast<char *>(this) + offset));
    return keys;
  }


  std::vector<const AnyKey *>
  Keys::list() const
  {
    // list() has no const form, since keys are also listed to be set.
    const KeyList keys = const_cast<Keys *>(this)->list();
    return {keys.begin(), keys.end()};
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
