// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/effect.h>

// This file has the defaults of an effect and of its keys. An effect that says
// nothing else acts always, keeps nothing, checks nothing and warns of nothing,
// so a new effect overrides only what concerns it.
namespace Morula
{
  bool
  EffectKeys::is_on() const
  {
    // Effects that a scene chooses by name are never asked; others have a
    // switch.
    return true;
  }


  const AnyKey *
  EffectKeys::switch_key() const
  {
    return nullptr;
  }


  const AnyKey *
  EffectKeys::names_key() const
  {
    return nullptr;
  }


  void
  EffectKeys::declare_sections(const std::string &)
  {}


  void
  EffectKeys::declare_types(const std::vector<std::string> &)
  {}


  std::string
  EffectKeys::how_to_switch_on() const
  {
    return switch_key() == nullptr ?
             "" :
             "Say where it acts by " + switch_key()->path();
  }


  bool
  EffectKeys::divides_cells() const
  {
    return false;
  }


  void
  EffectKeys::check_with(const MaterialParameters &) const
  {}


  std::string
  EffectKeys::topic() const
  {
    return "";
  }


  std::string
  EffectKeys::details() const
  {
    // The list begins with a comma since the name of the effect stands before
    // it.
    std::string text;
    for (const AnyKey *key : list())
      text += ", " + key->short_name() + " = " + key->text();
    return text;
  }


  template <int dim>
  void
  Effect<dim>::declare(Tables<dim> &) const
  {}


  template <int dim>
  void
  Effect<dim>::begin(const CellView<dim, double> &) const
  {}


  template <int dim>
  void
  Effect<dim>::advance(const PresentCell<dim> &,
                       const CellView<dim, double> &,
                       const double,
                       const double) const
  {}


  template <int dim>
  void
  Effect<dim>::check_cell(const PresentCell<dim> &, const double) const
  {}


  template <int dim>
  void
  Effect<dim>::check(const Preview<dim> &) const
  {}


  template <int dim>
  void
  Effect<dim>::review(const Preview<dim> &, Review &) const
  {}


  template class Effect<2>;
  template class Effect<3>;
} // namespace Morula
