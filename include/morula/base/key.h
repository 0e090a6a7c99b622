// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_key_h
#define morula_base_key_h

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/patterns.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <ostream>
#include <string>
#include <type_traits>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** A condition on the values of a key. */
  template <typename T>
  struct Rule
  {
    std::function<bool(const T &)> holds;
    /** A noun phrase. */
    std::string allowed;
    /** A full sentence. */
    std::string remedy;
  };

  /** Refuses values <= 0. @param unit e.g. "kPa", for the message */
  inline Rule<double>
  positive(const std::string &unit, const std::string &remedy)
  {
    return {[](const double value) { return value > 0.; },
            "a value > 0 " + unit,
            remedy};
  }

  /** Refuses values < 0. */
  inline Rule<double>
  not_negative(const std::string &unit, const std::string &remedy)
  {
    return {[](const double value) { return value >= 0.; },
            "a value >= 0 " + unit,
            remedy};
  }


  class AnyKey;
  struct Keys;

  /** Keys in the order of their declaration. */
  using KeyList = std::vector<AnyKey *>;

  /** The path of a key, and the section or effect of which it is a member:
   *  {this, "Path"} registers it there. */
  struct KeyPath
  {
    /** Of a key by itself. */
    KeyPath(const std::string &path)
      : path(path)
    {}

    KeyPath(const char *const path)
      : path(path)
    {}

    /** @param path full, or relative to the section that place_in() names */
    KeyPath(Keys *const keys, const std::string &path)
      : keys(keys)
      , path(path)
    {}

    Keys       *keys = nullptr;
    std::string path;
  };

  /**
   * One key of a .prm file, with all that is known about it. Copies are
   * independent of each other. The typed keys below add the value.
   */
  class AnyKey
  {
  public:
    virtual ~AnyKey() = default;

    /** Full path, separated by '/'. Spelt in no other place of the code. */
    const std::string &
    path() const
    {
      return path_;
    }

    /** Puts the key into a section: "A" becomes "Section/A". */
    void
    place_in(const std::string &section)
    {
      path_ = section + "/" + path_;
    }

    /** The default as text. */
    const std::string &
    default_text() const
    {
      return default_text_;
    }

    /** What --parameters prints; a unit stands at its end: "Units: um." */
    const std::string &
    documentation() const
    {
      return documentation_;
    }

    /** What follows "Units: " in the documentation, or empty. */
    std::string
    unit() const;

    /** The texts that the key gets from values of `Method`, by these values. */
    const std::map<std::string, std::string> &
    texts_by_method() const
    {
      return with_method;
    }

    /** Takes the default of @p method, and the value unless @p is_set. */
    void
    take_default_of(const std::string &method, const bool is_set = false)
    {
      const auto text = with_method.find(method);
      if (text != with_method.end())
        default_text_ = text->second;
      if (text != with_method.end() && !is_set)
        assign(default_text_);
    }

    /** Adds a sentence about what a program adds to the key. */
    void
    add_documentation(const std::string &text)
    {
      documentation_ += text;
    }

    /** Full paths that the key had before. */
    const std::vector<std::string> &
    former_paths() const
    {
      return former_paths_;
    }

    /** The value as text: as the scene wrote it, unless a program has changed
     *  the value since. */
    virtual std::string
    text() const = 0;

    /** Takes the value from text that matches the pattern. */
    virtual void
    assign(const std::string &text) = 0;

    /** The pattern that deal.II lets through. */
    virtual std::unique_ptr<Patterns::PatternBase>
    pattern() const = 0;

    /** What is allowed, as a noun phrase; empty for any text. */
    virtual std::string
    allowed() const = 0;

    /** The words from which the value, or each entry of a list, is chosen. */
    virtual std::vector<std::string>
    choices() const
    {
      return {};
    }

    /** Whether the value consists of real numbers. */
    virtual bool
    is_of_numbers() const
    {
      return false;
    }

    /** Says that the key does nothing unless one of the keys with these full
     *  paths has another value than its default, or that behind a "=". Several
     *  calls: each must be fulfilled. */
    void
    needs(const std::vector<std::string> &paths)
    {
      needed_.push_back(paths);
    }

    /** What needs() was told. */
    const std::vector<std::vector<std::string>> &
    needed() const
    {
      return needed_;
    }

    /** Whether the value names a file, or may do so. */
    bool
    names_file() const
    {
      return names_file_;
    }

    /**
     * Refuses a value that is wrong by itself, in @p dim dimensions.
     * @throws InputError
     */
    virtual void
    check(const unsigned int) const
    {}

    /** Whether the value is the default, in whatever way it is written. */
    bool
    is_default() const;

    /** Whether cells of some type have another value than the default. */
    virtual bool
    is_changed() const
    {
      return !is_default();
    }

    /** Declares the key in deal.II's handler, with the value that it has. */
    void
    declare(ParameterHandler &prm) const;

    /** @throws InputError with the path and the value */
    [[noreturn]] void
    refuse(const std::string &allowed, const std::string &remedy) const;

    /** The value as a message shows it: a number with six digits. */
    virtual std::string
    shown() const
    {
      return text();
    }

  protected:
    AnyKey(const KeyPath     &path,
           const std::string &default_text,
           const std::string &documentation);
    AnyKey(const AnyKey &) = default;
    AnyKey &
    operator=(const AnyKey &) = default;

    std::map<std::string, std::string> with_method;
    std::vector<std::string>           former_paths_;
    bool                               names_file_ = false;

  private:
    std::string                           path_;
    std::string                           default_text_;
    std::string                           documentation_;
    std::vector<std::vector<std::string>> needed_;
  };

  /** What deal.II's pattern of a key admits, by the type of its value. */
  struct Limits
  {
    Limits(const std::string &words = "")
      : words(words)
    {}

    Limits(const double smallest, const double largest = unlimited)
      : smallest(smallest)
      , largest(largest)
    {}

    static constexpr double unlimited = std::numeric_limits<double>::max();

    /** The limits as integers, of which none is negative. */
    int
    fewest() const
    {
      return std::max(smallest, 0.);
    }
    int
    most() const
    {
      return std::min<double>(largest, std::numeric_limits<int>::max());
    }

    /** Of text, or of each entry of a list: "first|second"; empty: any. */
    std::string words;
    /** Of a number, or of the length of a list of numbers. */
    double smallest = -unlimited, largest = unlimited;
  };

  /**
   * A key with a value of type T: double, unsigned int, bool, std::string, or a
   * vector of doubles or strings. It may be used like its value.
   */
  template <typename T>
  class Key : public AnyKey
  {
  public:
    /** @param rule that check() enforces */
    Key(const KeyPath     &path,
        const T           &default_value,
        const std::string &documentation,
        const Limits      &limits = {},
        const Rule<T>     &rule   = {});

    const T &
    value() const
    {
      return value_;
    }

    operator const T &() const
    {
      return value_;
    }

    Key &
    operator=(const T &value)
    {
      value_ = value;
      return *this;
    }

    template <typename Other>
    Key &
    operator+=(const Other &other)
    {
      value_ += other;
      return *this;
    }

    template <typename Other>
    Key &
    operator/=(const Other &other)
    {
      value_ /= other;
      return *this;
    }

    const T *
    operator->() const
    {
      return &value_;
    }

    /** Adds a rule that check() enforces. */
    Key &
    require(const std::function<bool(const T &)> &rule,
            const std::string                    &allowed,
            const std::string                    &remedy)
    {
      rules.push_back({rule, allowed, remedy});
      return *this;
    }

    /** Sets the text that the key gets from a value of `Method`. */
    Key &
    with(const std::string &method, const std::string &text)
    {
      with_method[method] = text;
      return *this;
    }

    /** Names a path that the key had before. */
    Key &
    formerly(const std::string &path)
    {
      former_paths_.push_back(path);
      return *this;
    }

    /** Says that the value names a file, or may do so. */
    Key &
    of_file()
    {
      names_file_ = true;
      return *this;
    }

    /** Admits one more word. */
    void
    add_word(const std::string &word);

    std::string
    text() const override;
    void
    assign(const std::string &text) override;
    std::unique_ptr<Patterns::PatternBase>
    pattern() const override;
    std::string
    allowed() const override;
    std::vector<std::string>
    choices() const override;
    bool
    is_of_numbers() const override
    {
      return std::is_same<T, double>::value ||
             std::is_same<T, std::vector<double>>::value;
    }
    void
    check(const unsigned int dim) const override;

    /** Prints the text. */
    friend std::ostream &
    operator<<(std::ostream &out, const Key &key)
    {
      return out << key.text();
    }

    std::string
    shown() const override;

  private:
    T                    value_;
    T                    assigned; // the value of text_
    std::string          text_;
    Limits               limits;
    std::vector<Rule<T>> rules;
  };

  // Numbers compare by the conversion to T; text needs operators.

  /** Compares the values. */
  inline bool
  operator==(const Key<std::string> &key, const std::string &value)
  {
    return key.value() == value;
  }
  inline bool
  operator!=(const Key<std::string> &key, const std::string &value)
  {
    return key.value() != value;
  }

  /** Joins text with that of a key. */
  inline std::string
  operator+(const std::string &text, const Key<std::string> &key)
  {
    return text + key.value();
  }
  inline std::string
  operator+(const Key<std::string> &key, const std::string &text)
  {
    return key.value() + text;
  }

  /** Some keys that belong together: a section of the scene, or an effect. */
  struct Keys
  {
    virtual ~Keys() = default;

    /** The keys in their order: the members that were made with this. */
    virtual KeyList
    list();

    /** The keys in their order. */
    std::vector<const AnyKey *>
    list() const;

    /** Refuses values that are wrong by themselves. @throws InputError */
    void
    check_each(const unsigned int dim) const;

  protected:
    Keys()             = default;
    Keys(const Keys &) = default;
    Keys &
    operator=(const Keys &) = default;

  private:
    friend class AnyKey;

    /** Where the keys stand in this object: offsets, in bytes, which hold for
     *  copies as well. */
    std::vector<std::ptrdiff_t> offsets;
  };

  /** Whether two values are equal, as text without blanks or as numbers. */
  bool
  same_value(const std::string &a, const std::string &b);

  /** A number as a message shows it. */
  std::string
  as_text(const double value);
} // namespace Morula

#endif
