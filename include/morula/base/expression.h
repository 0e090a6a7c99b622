// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_expression_h
#define morula_base_expression_h

#include <deal.II/base/numbers.h>
#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <memory>
#include <string>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /**
   * A user's muParser expression in X, Y, Z (a cell's or a boundary point's
   * initial position, µm) and t (day), with one or more components separated
   * by ';'. In 2-D there is no Z. Functions and operators are those of
   * deal.II's FunctionParser; `pi` is defined. Plain numbers are recognised and
   * cost little to evaluate. Copies share the parser; evaluation is
   * thread-safe.
   *
   * What muParser would take silently for something else is refused: a comma
   * outside parentheses, an assignment, a chain such as 0 < X < 5. So is
   * rand(), whose value would depend on the order of evaluation.
   */
  class Expression
  {
  public:
    /**
     * @param key full path of the key, for error messages
     * @param n_components largest number of components
     * @param min_components smallest number of components; if not given, there
     *        must be exactly @p n_components. A vector in dim dimensions is
     *        (3, dim): in 2-D a third component may stand there and is ignored
     * @throws InputError if the text is not a valid expression or has another
     *         number of components
     */
    Expression(
      const std::string &key,
      const std::string &text,
      const unsigned int n_components   = 1,
      const unsigned int min_components = numbers::invalid_unsigned_int);

    /**
     * The value of one component at the initial position @p X and time @p t.
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
    vector(const Point<dim> &X, const double t) const;

    /** Whether all components are plain numbers. */
    bool
    is_constant() const;

    /** Whether t occurs in the text. */
    bool
    depends_on_time() const;

    /**
     * Refuses Z in two dimensions: it would be 0 at all cells, and Z > 40 would
     * hold nowhere without a word.
     * @throws InputError
     */
    void
    check_dimension(const unsigned int dim) const;

    /** Full path of the key. */
    const std::string &
    key() const;

    /** What the user wrote. */
    const std::string &
    text() const;

  private:
    class Parser;

    std::string                   key_;
    std::string                   text_;
    std::vector<double>           constants; // empty: ask the parser
    bool                          uses_Z;
    std::shared_ptr<const Parser> parser;
  };
} // namespace Morula

#endif
