// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_expression_h
#define morula_base_expression_h

#include <morula/base/key.h>

#include <deal.II/base/numbers.h>
#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** The variables of expressions. The names in scenes are those of the
   *  enumerators; doc/glossary.md lists their units. */
  enum class Variable : unsigned int
  {
    /** Initial position of a founder or boundary point, µm. */
    X,
    Y,
    Z,
    /** Time, day. */
    t,
    /** Present position of a cell, µm. */
    x,
    y,
    z,
    /** Number of divisions since the founder. */
    generation,
    /** Time since birth, day. */
    age,
    /** Time since the cell took its type, day. */
    type_age,
    /** The phase of the cell's cycle, as in the column `phase` of
     *  cells-NNNN.csv. */
    cycle_phase,
    /** Number of the cell's type, from 0. */
    type,
    /** V, µm^dim. */
    volume,
    /** det F_g. */
    growth,
    /** det F_e. */
    J_e,
    /** -tr σ / 3, kPa. */
    pressure,
    /** The largest principal stress, kPa. */
    tension,
    /** The von Mises stress, kPa. */
    shear,
    /** Ψ, kPa. */
    energy,
    /** Distance of the founder from the surface at t = 0, µm. */
    depth,
    /** Distance of the cell from the surface at the beginning of the step, µm.
     */
    present_depth,
    /** Uniform in (0, 1), the cell's own for its life. */
    noise
  };

  /** Number of variables. */
  constexpr unsigned int n_variables =
    static_cast<unsigned int>(Variable::noise) + 1;

  /** Largest number of fields in a scene. */
  constexpr unsigned int most_fields = 32;

  /** The variable that is the value of field number @p k of the scene at the
   *  cell. Its name is that of the field: Vocabulary::name_of(). */
  constexpr Variable
  field_variable(const unsigned int k)
  {
    return static_cast<Variable>(n_variables + k);
  }

  /** Whether the variable is the value of a field. */
  constexpr bool
  is_field(const Variable variable)
  {
    return static_cast<unsigned int>(variable) >= n_variables;
  }

  /** Number of the field whose value the variable is. */
  constexpr unsigned int
  field_number(const Variable variable)
  {
    return static_cast<unsigned int>(variable) - n_variables;
  }

  /** Whether a variable changes as the tissue does: not ages, which change with
   *  time alone, nor what changes in events only. */
  bool
  follows_state(const Variable variable);

  /** A value for each variable. An expression reads only those that it uses. */
  using VariableValues = std::array<double, n_variables + most_fields>;

  /** Name in scenes of a variable that is no field. */
  const char *
  name_of(const Variable variable);

  /** The variables and named numbers that an expression may use. */
  struct Vocabulary
  {
    std::vector<Variable> variables;
    /** Named numbers, e.g. the types of cells. */
    std::map<std::string, double> constants = {};
    /** Names of the fields, and of what else of a scene's own is a variable;
     *  by number. Empty: one that the expression may not use. */
    std::vector<std::string> fields = {};

    /** Name of a variable. */
    std::string
    name_of(const Variable variable) const
    {
      return is_field(variable) ? fields[field_number(variable)] :
                                  Morula::name_of(variable);
    }

    /** All variables, the fields last. */
    std::vector<Variable>
    all_variables() const
    {
      // Fields are variables with numbers behind all others.
      std::vector<Variable> all = variables;
      for (unsigned int k = 0; k < fields.size(); ++k)
        if (!fields[k].empty())
          all.push_back(field_variable(k));
      return all;
    }

    /** The names, separated by blanks. */
    std::string
    names() const
    {
      std::string text;
      for (const Variable variable : all_variables())
        text += (text.empty() ? "" : ", ") + name_of(variable);
      for (const auto &[name, value] : constants)
        text += ", " + name;
      return text;
    }
  };

  /** X, Y, Z and t: the variables that every place has at every time. */
  const Vocabulary &
  place_and_time();


  class ExpressionParser;

  /**
   * A user's muParser expression, with one or more components separated by ';'.
   * Its variables are those of its vocabulary: X, Y, Z (a founder's or a
   * boundary point's initial position, µm) and t (day), and more if it is
   * evaluated for a present cell. In 2-D there is no Z and no z. Functions and
   * operators are those of deal.II's FunctionParser; `pi` is defined. So are
   * hill(s, half, n), ramp(s, a, b) and, if the vocabulary has `noise`,
   * normal(mean, deviation). Plain numbers are recognised and cost little to
   * evaluate. Copies share the parser; evaluation is not thread-safe.
   *
   * It refuses text that muParser would silently misread: a comma outside
   * parentheses, an assignment, a chain such as 0 < X < 5. It also refuses
   * rand(), whose value would depend on the order of evaluation.
   */
  class Expression
  {
  public:
    /**
     * @param key full path of the key, for error messages
     * @param n_components largest number of components
     * @param min_components smallest number of components; if not given, there
     *        must be exactly @p n_components. For a vector pass 3 and dim: in
     *        2-D a third component is allowed and ignored
     * @throws InputError if the text is not a valid expression or has another
     *         number of components
     */
    Expression(
      const std::string &key,
      const std::string &text,
      const unsigned int n_components   = 1,
      const unsigned int min_components = numbers::invalid_unsigned_int,
      const Vocabulary  &vocabulary     = place_and_time());

    /** This expression, with another one for each type of cells in @p of_types,
     *  by the type's number. */
    Expression
    with_types(const std::map<unsigned int, Expression> &of_types) const;

    /**
     * The value of one component at the initial position @p X (µm) and time
     * @p t (day). The expression must use no other variables.
     * @throws InputError if the value is not finite, or if Z occurs in 2-D
     */
    template <int dim>
    double
    value(const Point<dim>  &X,
          const double       t,
          const unsigned int component = 0) const;

    /**
     * The first dim components as a vector.
     * @throws InputError if one of them is not finite
     */
    template <int dim>
    Tensor<1, dim>
    vector(const Point<dim> &X, const double t) const
    {
      Tensor<1, dim> result;
      for (unsigned int d = 0; d < dim; ++d)
        result[d] = value(X, t, d);
      return result;
    }

    /** Sets the rule that values for cells must obey. */
    void
    set_rule(const Rule<double> &new_rule)
    {
      rule = std::make_shared<const Rule<double>>(new_rule);
    }

    /** The value of one component with these values of the variables in used().
     *  @throws InputError if it is not finite, or not what the rule says */
    double
    value(const VariableValues &values, const unsigned int component = 0) const;

    /** The variables in the text and in the texts of types. */
    const std::vector<Variable> &
    used() const
    {
      return used_;
    }

    /** Whether the variable is in used(). */
    bool
    uses(const Variable variable) const
    {
      return std::binary_search(used_.begin(), used_.end(), variable);
    }

    /** Whether it uses other variables than X, Y, Z and t. */
    bool
    depends_on_state() const
    {
      // used_ is sorted, and the state's variables follow X, Y, Z and t.
      return !used_.empty() && used_.back() > Variable::t;
    }

    /** Whether it uses a variable that changes as the tissue does. */
    bool
    follows_state() const;

    /** Whether no component has a variable, as 1 and 2*pi have none, and all
     *  types have the same. */
    bool
    is_constant() const
    {
      return !constants.empty() && of_types.empty();
    }

    /** Whether each of the first @p n_components is this number, without any
     *  variable, for all types of cells. */
    bool
    is_always(const double number, const unsigned int n_components = 1) const;

    /** The first component, if this text has no variables. Those of types do
     *  not count. */
    std::optional<double>
    number() const
    {
      return constants.empty() ? std::optional<double>() : constants[0];
    }

    /** The expressions of types that have one of their own. */
    const std::map<unsigned int, Expression> &
    types() const
    {
      return of_types;
    }

    /** Whether t occurs in the text. */
    bool
    depends_on_time() const
    {
      return uses(Variable::t);
    }

    /**
     * Refuses Z and z in two dimensions: they would be 0 at all cells, and Z >
     * 40 would silently hold nowhere.
     * @throws InputError
     */
    void
    check_dimension(const unsigned int dim) const;

    /** Full path of the key. */
    const std::string &
    key() const
    {
      return key_;
    }

    /** What the user wrote. */
    const std::string &
    text() const
    {
      return text_;
    }

  private:
    /** Makes constants of what has no variables: cells need not ask a parser
     *  for the same number. */
    void
    evaluate_once();

    /** The value, without a check of the rule. @throws InputError */
    double
    evaluate(const VariableValues &values, const unsigned int component) const;

    std::shared_ptr<const Vocabulary>   vocabulary_;
    std::string                         key_;
    std::string                         text_;
    std::vector<double>                 constants; // empty: ask the parsers
    std::vector<Variable>               used_;
    std::map<unsigned int, Expression>  of_types;
    std::shared_ptr<const Rule<double>> rule;
    /** One for each component. */
    std::vector<std::shared_ptr<const ExpressionParser>> parsers;
  };
} // namespace Morula

#endif
