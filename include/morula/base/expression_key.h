// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_expression_key_h
#define morula_base_expression_key_h

#include <morula/base/expression.h>
#include <morula/base/key.h>

#include <deal.II/base/patterns.h>
#include <deal.II/base/tensor.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace Morula
{
  /** When the expression of a key is evaluated. That decides which variables it
   *  may use. */
  enum class Evaluated
  {
    /** Once, for a founder or a boundary point at t = 0: X, Y, Z. */
    founder,
    /** In every step, at its end, for a place on the surface or in the body: X,
     *  Y, Z, t. */
    place,
    /** When something happens to a cell: all variables, with their values then.
     */
    event,
    /** In every step: all variables, with their values at its beginning. */
    step,
    /** In every step, for a property on which the stress depends: no variables
     *  that depend on the deformation. */
    property
  };

  /** The variables that an expression may use. */
  const std::vector<Variable> &
  variables_of(const Evaluated evaluated);

  /** "at each step", ... */
  const char *
  description_of(const Evaluated evaluated);

  /** A key whose value is an Expression, which is parsed once. */
  class ExpressionKey : public AnyKey
  {
  public:
    /**
     * @param n_components 1, or 3 for a vector: in 2-D its third component may
     *        be missing
     */
    ExpressionKey(const KeyPath     &path,
                  const std::string &default_text,
                  const std::string &documentation,
                  const Evaluated    evaluated,
                  const unsigned int n_components = 1);

    /** @param rule for all its values: plain numbers are refused at once,
     * others when they occur */
    ExpressionKey(const KeyPath      &path,
                  const std::string  &default_text,
                  const std::string  &documentation,
                  const Evaluated     evaluated,
                  const Rule<double> &rule);

    /** Also accepts plain numbers separated by commas: the key was a list
     *  before it became an expression. */
    void
    admit_commas()
    {
      commas = true;
    }

    /** Takes other text; it is parsed when it is next needed. */
    ExpressionKey &
    operator=(const std::string &text)
    {
      text_ = text;
      parsed.reset();
      return *this;
    }

    /** Takes a number. */
    ExpressionKey &
    operator=(const double number)
    {
      return *this = Patterns::Tools::to_string(number);
    }

    /** The largest of the plain numbers that it has for the types of cells;
     *  none if there are only expressions. */
    std::optional<double>
    largest_number(const unsigned int dim) const
    {
      const Expression     &of_all  = expression(dim);
      std::optional<double> largest = of_all.number();
      for (const auto &[type, own] : of_all.types())
        largest = std::max(largest, own.number());
      return largest;
    }

    /** When it is evaluated. */
    Evaluated
    evaluated() const
    {
      return evaluated_;
    }

    /** 1, or 3 for a vector. */
    unsigned int
    components() const
    {
      return n_components;
    }

    /** Whether it is evaluated for cells during the run. Then it may use their
     *  types, and may differ between types. */
    bool
    is_of_cells() const
    {
      return evaluated_ != Evaluated::founder && evaluated_ != Evaluated::place;
    }

    /** Sets names that the text may use: the types of cells, with their
     *  numbers. */
    void
    set_types(const std::map<std::string, double> &names)
    {
      types = names;
      parsed.reset();
    }

    /** Sets the names of the variables of the scene's own, by number: first
     *  those of the @p n_fields fields, which a property may not use. */
    void
    set_fields(const std::vector<std::string> &names,
               const unsigned int              n_fields)
    {
      // They exist only where cells are asked. Fields follow from the
      // deformation, on which a property has an influence; what cells have
      // besides is known before it.
      if (is_of_cells())
        fields = names;
      if (evaluated_ == Evaluated::property)
        std::fill_n(fields.begin(), n_fields, "");
      this->n_fields = n_fields;
      parsed.reset();
    }

    /** The names of fields that the text may use. */
    std::vector<std::string>
    field_names() const
    {
      return {fields.begin(),
              fields.begin() + std::min<std::size_t>(n_fields, fields.size())};
    }

    /** As this key, in the section of a type of cells. It is empty if the type
     *  has no value of its own. */
    ExpressionKey
    in_section_of_type(const std::string &section) const;

    /** Sets another text for the cells of a type, which is given by its number.
     *  @param path of the key that says so */
    virtual void
    set_for_type(const unsigned int type,
                 const std::string &path,
                 const std::string &text)
    {
      of_types[type] = {path, text};
      parsed.reset();
    }

    /** Whether there is no text. */
    bool
    empty() const
    {
      return text_.empty();
    }

    /**
     * The expression for @p dim dimensions, parsed when first asked for.
     * Without text it is refused.
     * @throws InputError if it cannot be parsed
     */
    const Expression &
    expression(const unsigned int dim) const;

    /** The expression, or none without text. @throws InputError */
    std::optional<Expression>
    optional(const unsigned int dim) const
    {
      return empty() ? std::optional<Expression>() : expression(dim);
    }

    std::string
    text() const override
    {
      return text_;
    }
    void
    assign(const std::string &text) override
    {
      *this = text;
    }
    std::unique_ptr<Patterns::PatternBase>
    pattern() const override
    {
      return std::make_unique<Patterns::Anything>();
    }
    std::string
    allowed() const override
    {
      return "";
    }
    void
    check(const unsigned int dim) const override
    {
      // An empty key that may be empty has no expression.
      if (empty() && default_text().empty())
        return;
      check_expression(expression(dim), dim);
    }

    /** Whether some type of cells has another value. */
    bool
    differs_by_type() const
    {
      return !of_types.empty();
    }

    bool
    is_changed() const override
    {
      return !is_default() || differs_by_type();
    }

    /** Compares the text. */
    friend bool
    operator==(const ExpressionKey &key, const std::string &text)
    {
      return key.text_ == text;
    }

  private:
    /** Refuses what the value alone shows to be wrong. */
    void
    check_expression(const Expression &value, const unsigned int dim) const;

    Evaluated                     evaluated_;
    unsigned int                  n_components;
    std::string                   text_;
    std::map<std::string, double> types;
    std::vector<std::string>      fields;
    unsigned int                  n_fields = 0;
    /** Path and text, by the type's number. */
    std::map<unsigned int, std::pair<std::string, std::string>> of_types;
    std::optional<Rule<double>>                                 rule;
    bool                                                        commas = false;

    // The value, parsed: made of text_ alone.
    mutable std::optional<Expression> parsed;
    mutable unsigned int              parsed_for = 0; // dimensions
  };


  /**
   * The unit vector along the direction that a key gives as text: two or three
   * numbers separated by ',' or ';'. In 2-D the first two count.
   * @param key full path of the key, for error messages
   * @throws InputError if the text is no vector or the vector is zero
   */
  template <int dim>
  Tensor<1, dim>
  unit_vector(const std::string &key, const std::string &text);

  /** A key that gives a direction, or none if it is empty. */
  class DirectionKey : public Key<std::string>
  {
  public:
    using Key<std::string>::Key;
    using Key<std::string>::operator=;

    /** Refuses what unit_vector() does. @throws InputError */
    void
    check(const unsigned int dim) const override;
  };
} // namespace Morula

#endif
