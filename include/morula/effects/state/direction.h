// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_state_direction_h
#define morula_effects_state_direction_h

#include <morula/base/expression_key.h>
#include <morula/base/input_error.h>
#include <morula/effects/effect.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** The field of "gradient of NAME"; empty for any other text. */
  std::string
  field_of_gradient(const std::string &text);

  /** A key of cells that gives a direction in the body as it was at t = 0: an
   *  expression with the components of a vector of any length, `radial`,
   *  `surface normal` or `gradient of` a field. */
  class CellDirectionKey : public ExpressionKey
  {
  public:
    CellDirectionKey(const KeyPath     &path,
                     const std::string &default_text,
                     const std::string &documentation);

    CellDirectionKey &
    operator=(const std::string &text);

    /** The text that gives the direction of cells of a type. */
    const std::string &
    text_of(const unsigned int type) const
    {
      const auto own = of_types.find(type);
      return own == of_types.end() ? written : own->second.second;
    }

    /** The texts that give the directions of all types of cells. */
    std::vector<std::string>
    texts() const
    {
      std::vector<std::string> list{written};
      for (const auto &[type, own] : of_types)
        list.push_back(own.second);
      return list;
    }

    std::string
    text() const override
    {
      return written;
    }
    void
    assign(const std::string &text) override;
    void
    set_for_type(const unsigned int type,
                 const std::string &path,
                 const std::string &text) override;

    /** Also refuses a vector of zeros. @throws InputError */
    void
    check(const unsigned int dim) const override;

  private:
    /** @throws InputError for the gradient of a field that does not exist */
    void
    check_field(const std::string &path, const std::string &text) const
    {
      // The names of fields are known only after the whole file is read, so
      // this cannot be checked when the key is assigned.
      const std::string name = field_of_gradient(text);
      const auto        all  = field_names();
      if (!name.empty() && std::find(all.begin(), all.end(), name) == all.end())
        throw InputError(path,
                         text,
                         "the gradient of a field of the scene",
                         "There is no field '" + name +
                           "': name it in Fields/Names.");
    }

    std::string written;
    /** Paths and texts of types' own directions. */
    std::map<unsigned int, std::pair<std::string, std::string>> of_types;
  };

  /** The direction that such a key gives to each cell. */
  template <int dim>
  class DirectionOfCell
  {
  public:
    /** Asks the setting for the columns that are needed. @throws InputError for
     *  an expression that cannot be parsed */
    DirectionOfCell(const CellDirectionKey   &key,
                    const EffectSetting<dim> &setting);

    /**
     * Unit vector in the body as it was at t = 0, at time @p t (day). A founder
     * in the very centre has no radial direction, and a cell in a uniform field
     * has no gradient; both get the first axis.
     * @throws InputError if the expression's vector is zero
     */
    Tensor<1, dim>
    of(const PresentCell<dim> &cell, const double t) const;

    /** Whether it changes as the tissue does. */
    bool
    follows_state() const
    {
      // A radial direction and the normal are fixed at t = 0; a gradient turns
      // as the field changes.
      return !fields.empty() || expression.follows_state();
    }

  private:
    Expression       expression;
    CellDirectionKey key;
    Point<dim>       center;
    /** Numbers of the fields of gradients, by the key's texts. */
    std::map<std::string, unsigned int> fields;
  };
} // namespace Morula

#endif
