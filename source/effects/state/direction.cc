// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/state/direction.h>
#include <morula/effects/state/present_cell.h>

#include <boost/algorithm/string.hpp>

#include <sstream>

namespace Morula
{
  namespace
  {
    /** The words for the direction from Tissue/Center to the founder, for the
     *  outward normal of the surface near the founder at t = 0, and for that in
     *  which a field rises fastest. All other text is a vector. */
    const std::string radial = "radial", surface_normal = "surface normal",
                      gradient = "gradient of ";


    bool
    is_expression(const std::string &text)
    {
      return text != radial && text != surface_normal &&
             field_of_gradient(text).empty();
    }


    /** The text for the expression behind the key. Where the key holds a word
     *  there is no expression, but the base class wants one: it gets a constant
     *  vector, which is never evaluated. */
    std::string
    as_expression(const std::string &text)
    {
      return is_expression(text) ? text : "1; 1; 1";
    }


    [[noreturn]] void
    refuse_zero(const Expression &expression, const std::string &where)
    {
      throw InputError(expression.key(),
                       expression.text(),
                       "a vector that is not zero, 'radial', 'surface "
                       "normal' or 'gradient of' a field",
                       where + "Choose a direction that all cells have.");
    }
  } // namespace


  std::string
  field_of_gradient(const std::string &text)
  {
    // An empty result means that the text is no gradient, as no field has an
    // empty name.
    return boost::starts_with(text, gradient) ?
             boost::trim_copy(text.substr(gradient.size())) :
             "";
  }


  CellDirectionKey::CellDirectionKey(const KeyPath     &path,
                                     const std::string &default_text,
                                     const std::string &documentation)
    : ExpressionKey(path, default_text, documentation, Evaluated::step, 3)
  {
    assign(default_text);
  }


  CellDirectionKey &
  CellDirectionKey::operator=(const std::string &text)
  {
    assign(text);
    return *this;
  }


  void
  CellDirectionKey::assign(const std::string &text)
  {
    // The text as the user wrote it is kept beside the expression: --parameters
    // prints it, and kind() decides by it.
    written = text;
    ExpressionKey::assign(as_expression(text));
  }


  void
  CellDirectionKey::set_for_type(const unsigned int type,
                                 const std::string &path,
                                 const std::string &text)
  {
    // A type may have a word where the scene has an expression, or the reverse.
    // So both forms are kept for each type.
    of_types[type] = {path, text};
    ExpressionKey::set_for_type(type, path, as_expression(text));
  }


  void
  CellDirectionKey::check(const unsigned int dim) const
  {
    // First the words: a gradient has to be that of a field of the scene. Then
    // the expressions, by their own check. A vector that is constant is
    // evaluated here, since zero has no direction; one with variables is
    // checked at each cell when it is used.
    check_field(path(), written);
    for (const auto &[type, own] : of_types)
      check_field(own.first, own.second);
    ExpressionKey::check(dim);
    if (empty())
      return;
    const Expression &of_all       = expression(dim);
    const auto        check_vector = [&](const Expression &vector) {
      if (!vector.used().empty())
        return;
      bool is_zero = true;
      for (unsigned int d = 0; d < dim; ++d)
        is_zero = is_zero && vector.value(VariableValues(), d) == 0.;
      if (is_zero)
        refuse_zero(vector, "");
    };
    check_vector(of_all);
    for (const auto &[type, own] : of_all.types())
      check_vector(own);
  }


  template <int dim>
  DirectionOfCell<dim>::DirectionOfCell(const CellDirectionKey   &key,
                                        const EffectSetting<dim> &setting)
    : expression(setting.state.use(key))
    , key(key)
    , center(setting.center)
  {
    // The state is told what directions will read, for all types of cells. Then
    // it declares the columns for it, and nothing is stored that no expression
    // needs.
    for (const std::string &text : key.texts())
      if (text == surface_normal)
        setting.state.need_surface_normal();
      else if (const std::string field = field_of_gradient(text);
               !field.empty())
        fields[text] = setting.state.need_gradient(field);
  }


  template <int dim>
  Tensor<1, dim>
  DirectionOfCell<dim>::of(const PresentCell<dim> &cell, const double t) const
  {
    // All kinds give a direction in the body as it was at t = 0, which is where
    // growth and contraction take their axes. A direction that happens to be
    // undefined, at the centre or where a field is flat, becomes the x axis; a
    // vector that the user wrote as zero is a mistake and is refused.
    const std::string &text = key.text_of(cell.type());
    Tensor<1, dim>     direction;
    if (text == surface_normal)
      {
        direction = cell.surface_normal();
        return direction / direction.norm();
      }
    if (is_expression(text))
      {
        direction = cell.vector(expression, t);
        if (direction.norm() == 0.)
          {
            std::ostringstream place;
            place << "It is zero at the cell from ("
                  << cell.cell().founder_position() << ") um, t = " << t
                  << " day. ";
            refuse_zero(expression, place.str());
          }
      }
    else
      // The gradient is a covector of the present configuration. Pulled back it
      // is Fᵀ ∇c: the field rises along it in the body of t = 0.
      direction = text == radial ?
                    cell.cell().founder_position() - center :
                    cell.gradient(fields.at(text)) * cell.cell().F();
    if (direction.norm() == 0.)
      direction[0] = 1.;
    return direction / direction.norm();
  }


  template class DirectionOfCell<2>;
  template class DirectionOfCell<3>;
} // namespace Morula
